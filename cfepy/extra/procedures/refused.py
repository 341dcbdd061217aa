"""Functions of `openc3.script` that this add-on does not have: each refuses its call and says why."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NoReturn

from cfepy.extra.procedures.procedure_errors import RefusedError

_REASONS = {
    "it belongs to the storage of a COSMOS server": (
        "get_target_file put_target_file delete_target_file download_file script_list script_create script_delete "
        "script_body open_file_dialog open_files_dialog save_setting load_config save_config list_configs"
    ),
    "it belongs to interfaces of a COSMOS server": (
        "connect_interface disconnect_interface interface_cmd interface_protocol_cmd get_interface "
        "get_interface_names start_raw_logging_interface stop_raw_logging_interface connect_router disconnect_router "
        "get_all_interface_info map_target_to_interface unmap_target_from_interface inject_tlm"
    ),
    "it belongs to screens and other tools of COSMOS": (
        "display_screen clear_screen clear_all_screens delete_screen local_screen get_screen_list "
        "get_screen_definition create_screen autonomic_group_list metadata_all metadata_get metadata_set "
        "metadata_update metadata_input table_create_binary table_create_report plugin_list plugin_get"
    ),
    "scripts of a COSMOS server run beside each other; use load_utility": (
        "script_run script_lock script_unlock script_syntax_check running_script_list running_script_get "
        "running_script_stop running_script_pause running_script_retry running_script_delete"
    ),
    "it belongs to timelines and triggers of COSMOS": (
        "list_timelines create_timeline get_timeline delete_timeline create_timeline_activity get_timeline_activity "
        "get_timeline_activities delete_timeline_activity"
    ),
}
REFUSED = {name: reason for reason, names in _REASONS.items() for name in names.split()}
"""Names of functions and the reason why each is refused."""


def refusing(name: str) -> Callable[..., NoReturn]:
    """Return a function that refuses its call."""

    def refuse(*given: Any, **options: Any) -> NoReturn:
        raise RefusedError(f"{name} is not supported: {REFUSED[name]}")

    return refuse

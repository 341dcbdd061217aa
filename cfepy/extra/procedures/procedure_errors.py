"""The exceptions of procedures: a failed check, a skipped or stopped script, and a function beyond this add-on."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import TracebackType
from typing import Any, NoReturn


class CheckError(RuntimeError):
    """A check of a procedure failed."""


class SkipScript(Exception):
    """The procedure skips the rest of a test."""


class StopScript(Exception):
    """The procedure ends."""


class UnsupportedError(Exception):
    """A procedure uses a function of COSMOS that this add-on does not have."""


def place_in(trace: TracebackType | None, files: set[str]) -> str:
    """Return the innermost line of a procedure in a traceback as "FILE:LINE", or an empty text.

    Args:
        trace: the traceback.
        files: paths of the procedures' files.
    """
    found = ""
    while trace is not None:
        file = trace.tb_frame.f_code.co_filename
        if file in files:
            found = f"{_short(file)}:{trace.tb_lineno}"
        trace = trace.tb_next
    return found


def _short(file: str) -> str:
    path = Path(file)
    try:
        return str(path.relative_to(Path.cwd()))
    except ValueError:
        return file


_REASONS = {
    "it belongs to the storage of a COSMOS server": (
        "get_target_file put_target_file delete_target_file download_file script_list script_create script_delete "
        "script_body open_file_dialog open_files_dialog open_bucket_dialog load_config save_config delete_config "
        "list_configs config_tool_names get_download_url start_logging stop_logging get_logger_info"
    ),
    "it belongs to the settings of a COSMOS server": (
        "save_setting set_setting get_setting get_settings get_all_settings list_settings set_offline_access "
        "offline_access_needed initialize_offline_access package_list"
    ),
    "it changes a COSMOS server": (
        "enable_cmd disable_cmd critical_cmd_status critical_cmd_approve critical_cmd_reject critical_cmd_can_approve "
        "delete_limits_set"
    ),
    "it returns definitions as COSMOS keeps them": (
        "get_all_cmds get_all_commands get_cmd get_command get_param get_parameter get_all_tlm get_all_telemetry "
        "get_all_tlm_item_names get_tlm get_telemetry get_item get_tlm_available get_tlm_details "
        "get_packet_derived_items get_target get_target_info get_target_interfaces get_all_target_info"
    ),
    "definitions have no limits groups here": (
        "enable_limits_group disable_limits_group get_limits_groups get_limits_events"
    ),
    "it belongs to interfaces of a COSMOS server": (
        "connect_interface disconnect_interface interface_cmd interface_protocol_cmd get_interface "
        "get_interface_names start_raw_logging_interface stop_raw_logging_interface connect_router disconnect_router "
        "interface_target_enable interface_target_disable interface_details get_router get_router_names "
        "get_all_router_info router_cmd router_protocol_cmd router_target_enable router_target_disable "
        "router_details start_raw_logging_router stop_raw_logging_router "
        "get_all_interface_info map_target_to_interface unmap_target_from_interface inject_tlm"
    ),
    "it belongs to screens and other tools of COSMOS": (
        "display_screen clear_screen clear_all_screens delete_screen local_screen get_screen_list "
        "get_screen_definition create_screen autonomic_group_list metadata_all metadata_get metadata_set "
        "metadata_update metadata_input check_box table_create_binary table_create_report plugin_list plugin_get"
    ),
    "scripts of a COSMOS server run beside each other; use load_utility": (
        "script_run script_lock script_unlock script_syntax_check running_script_list running_script_get "
        "running_script_go running_script_step running_script_backtrace running_script_debug running_script_prompt "
        "completed_script_list completed_scripts_list script_instrumented running_script_execute_while_paused goto "
        "disconnect_script get_scripts "
        "running_script_stop running_script_pause running_script_retry running_script_delete"
    ),
    "it belongs to timelines and triggers of COSMOS": (
        "list_timelines create_timeline get_timeline delete_timeline create_timeline_activity get_timeline_activity "
        "set_timeline_color get_timeline_activities delete_timeline_activity"
    ),
}
REFUSED = {name: reason for reason, names in _REASONS.items() for name in names.split()}
"""Names of functions and the reason why each is refused."""


def refusing(name: str) -> Callable[..., NoReturn]:
    """Return a function that refuses its call."""

    def refuse(*given: Any, **options: Any) -> NoReturn:
        raise UnsupportedError(f"{name} is not supported: {REFUSED[name]}")

    return refuse

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
        raise UnsupportedError(f"{name} is not supported: {REFUSED[name]}")

    return refuse

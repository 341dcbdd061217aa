"""Commands that start, end and restart applications (CFE_ES_StartAppCmd and its neighbours)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cfepy.es import events as ev
from cfepy.es import packets as pk
from cfepy.es.command_group import CommandGroup, Handlers
from cfepy.es.records import StartParams
from cfepy.es.startup_script import EXCEPTION_PROC_RESTART
from cfepy.fs import FileCategory, parse_input_file_name
from cfepy.status import CfeError


class AppCommands(CommandGroup):
    """Starting, ending and restarting applications."""

    def handlers(self) -> Handlers:
        return (
            (pk.START_APP, self._start),
            (pk.STOP_APP, self._stop),
            (pk.RESTART_APP, self._restart),
            (pk.RELOAD_APP, self._reload),
        )

    def _start(self, packet: bytes) -> None:
        fields = pk.START_APP.read(packet)
        name = fields["Application"]
        refusal = _why_not_start(fields)
        if refusal is not None:
            self._replies.reject(*refusal)
            return
        file = parse_input_file_name(fields["AppFileName"], FileCategory.DYNAMIC_MODULE)
        stack = fields["StackSize"] or self._es.config.es_default_stack_size
        params = StartParams(file, fields["AppEntryPoint"], stack, fields["Priority"], fields["ExceptionAction"])
        try:
            app_id = self._es.create_app(name, params)
        except CfeError as failure:
            self._replies.reject(ev.START_ERR_EID, f"Failed to start {name} from {file}, RC = {failure.hex}")
            return
        self._replies.accept(ev.START_INF_EID, f"Started {name} from {file}, AppID = {app_id}")

    def _stop(self, packet: bytes) -> None:
        name = pk.STOP_APP.read(packet)["Application"]
        self._control(name, "Stop", self._es.delete_app, ev.STOP_DBG_EID, ev.STOP_ERR1_EID, ev.STOP_ERR2_EID)

    def _restart(self, packet: bytes) -> None:
        name = pk.RESTART_APP.read(packet)["Application"]
        ids = ev.RESTART_APP_DBG_EID, ev.RESTART_APP_ERR1_EID, ev.RESTART_APP_ERR2_EID
        self._control(name, "Restart", self._es.restart_app, *ids)

    def _reload(self, packet: bytes) -> None:
        fields = pk.RELOAD_APP.read(packet)

        def reload(app_id: int) -> None:
            self._es.reload_app(app_id, parse_input_file_name(fields["AppFileName"], FileCategory.DYNAMIC_MODULE))

        ids = ev.RELOAD_APP_DBG_EID, ev.RELOAD_APP_ERR1_EID, ev.RELOAD_APP_ERR2_EID
        self._control(fields["Application"], "Reload", reload, *ids)

    def _control(
        self, name: str, action: str, call: Callable[[int], None], begun: int, failed: int, unknown: int
    ) -> None:
        """Ask for something to be done to a running application; the background task does it."""
        try:
            app_id = self._es.get_app_id_by_name(name)
        except CfeError as missing:
            text = f"{action} Application {name}, GetAppIDByName failed. RC = {missing.hex}."
            self._replies.reject(unknown, text)
            return
        try:
            call(app_id)
        except CfeError as failure:
            self._replies.reject(failed, f"{action} Application {name} Failed, RC = {failure.hex}")
            return
        self._replies.accept(begun, f"{action} Application {name} Initiated.", ev.DEBUG)


def _why_not_start(fields: dict[str, Any]) -> tuple[int, str] | None:
    """Event id and text of what is wrong with a START_APP command, or None."""
    command = "CFE_ES_StartAppCmd: "
    try:
        parse_input_file_name(fields["AppFileName"], FileCategory.DYNAMIC_MODULE)
    except CfeError as bad:
        text = f"{command}invalid filename, status={bad.status & 0xFFFFFFFFFFFFFFFF:x}"
        return ev.START_INVALID_FILENAME_ERR_EID, text
    if not fields["AppEntryPoint"]:
        return ev.START_INVALID_ENTRY_POINT_ERR_EID, f"{command}App Entry Point is empty."
    if not fields["Application"]:
        return ev.START_NULL_APP_NAME_ERR_EID, f"{command}App Name is empty."
    if fields["Priority"] > 255:
        return ev.START_PRIORITY_ERR_EID, f"{command}Priority is too large: {fields['Priority']}."
    if fields["ExceptionAction"] > EXCEPTION_PROC_RESTART:
        text = f"{command}Invalid Exception Action: {fields['ExceptionAction']}."
        return ev.START_EXC_ACTION_ERR_EID, text
    return None

"""The files that Event Services writes on command: its event log, and what it knows of every application.

Stands for CFE_EVS_WriteLogDataFileCmd and CFE_EVS_WriteAppDataFileCmd. It makes the bytes; who writes them is given by
the mission.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from cfepy.evs import events as ev
from cfepy.evs import packets as pk
from cfepy.evs.apps import AppEvents
from cfepy.evs.core import EventCore
from cfepy.evs.telemetry import apps_by_slot
from cfepy.fs import (
    FileCategory,
    get_default_extension,
    get_default_mount_point,
    init_header,
    parse_input_file_name_ex,
    stamp_header,
)
from cfepy.fs.header import SUBTYPE_EVS_APPDATA, SUBTYPE_EVS_EVENTLOG
from cfepy.status import CfeError

DEFAULT_LOG_FILE = "/ram/cfe_evs.log"
DEFAULT_APP_DATA_FILE = "/ram/cfe_evs_app.dat"


class EventFiles:
    """Handlers of the two commands.

    Args:
        core: what is written.
        write_file: writes bytes to a path.
    """

    def __init__(self, core: EventCore, write_file: Callable[[str, bytes], object]) -> None:
        self._core = core
        self._write_file = write_file

    def log_file(self) -> bytes:
        """The event log as a file: the cFE header and the long event packets, oldest first."""
        return self._header("cFE EVS Log File", SUBTYPE_EVS_EVENTLOG) + b"".join(self._core.log.entries())

    def app_data_file(self) -> bytes:
        """All registered applications as a file: the cFE header and a record for each."""
        records = b"".join(_record(app) for app in apps_by_slot(self._core))
        return self._header("EVS Application Data File", SUBTYPE_EVS_APPDATA) + records

    def write_log(self, fields: Mapping[str, Any]) -> bool:
        """Handle the command that writes the event log."""
        count = len(self._core.log.entries())
        path = self._write(
            fields["Filename"], DEFAULT_LOG_FILE, self.log_file(), "Write Log File", ev.CFE_EVS_ERR_CRLOGFILE_EID
        )
        if path is None:
            return False
        text = f"Write Log File Command: {count} event log entries written to {path}"
        self._core.send_own(ev.CFE_EVS_WRLOG_EID, ev.DEBUG, text)
        return True

    def write_app_data(self, fields: Mapping[str, Any]) -> bool:
        """Handle the command that writes what is known of applications."""
        count = len(self._core.apps)
        path = self._write(
            fields["Filename"],
            DEFAULT_APP_DATA_FILE,
            self.app_data_file(),
            "Write App Data",
            ev.CFE_EVS_ERR_CRDATFILE_EID,
        )
        if path is None:
            return False
        text = f"Write App Data Command: {count} application data entries written to {path}"
        self._core.send_own(ev.CFE_EVS_WRDAT_EID, ev.DEBUG, text)
        return True

    def _write(self, name: str, default: str, data: bytes, command: str, failed: int) -> str | None:
        """Write a file; its path, or None after an event."""
        category = FileCategory.BINARY_DATA_DUMP
        try:
            path = parse_input_file_name_ex(
                name, default, get_default_mount_point(category), get_default_extension(category)
            )
        except CfeError as error:
            text = f"{command} Command Error: CFE_FS_ParseInputFileNameEx() = {error.hex}"
            self._core.send_own(failed, ev.ERROR, text)
            return None
        try:
            self._write_file(path, data)
        except CfeError as error:
            text = f"{command} Command Error: OS_OpenCreate = {error.status}, filename = {path}"
            self._core.send_own(failed, ev.ERROR, text)
            return None
        return path

    def _header(self, description: str, subtype: int) -> bytes:
        core = self._core
        header = stamp_header(
            init_header(description, subtype),
            spacecraft_id=core.config.spacecraft_id,
            processor_id=core.config.processor_id,
            application_id=core.own_app_id,
            time=core.ports.time.now(),
        )
        return header.pack()


def _record(app: AppEvents) -> bytes:
    return pk.APP_DATA_RECORD.pack(
        AppName=app.name,
        ActiveFlag=int(app.active),
        EventTypesActiveFlag=app.types,
        EventCount=app.sent,
        SquelchedCount=app.squelch.dropped,
        Filters=[{"EventID": slot.event_id, "Mask": slot.mask, "Count": slot.count} for slot in app.filters.slots],
    )

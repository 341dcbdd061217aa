"""The files that Event Services writes on command: its event log, and what it knows of every application.

Stands for CFE_EVS_WriteLogDataFileCmd and CFE_EVS_WriteAppDataFileCmd. Imports cfepy.osal and cfepy.fs, no service.
"""

from __future__ import annotations

from collections.abc import Callable

from cfepy.evs import events as ev
from cfepy.evs import packets as pk
from cfepy.evs.apps import AppEvents
from cfepy.evs.core import EventCore
from cfepy.evs.replies import Replies
from cfepy.evs.telemetry import apps_by_slot
from cfepy.fs import HEADER_SIZE, dump_file_name, init_header
from cfepy.fs.header import SUBTYPE_EVS_APPDATA, SUBTYPE_EVS_EVENTLOG
from cfepy.osal import Osal
from cfepy.osal.limits import OS_FILE_FLAG_CREATE, OS_FILE_FLAG_TRUNCATE, OS_WRITE_ONLY
from cfepy.status import CfeError, OsalError

DEFAULT_LOG_FILE = "/ram/cfe_evs.log"
DEFAULT_APP_DATA_FILE = "/ram/cfe_evs_app.dat"


class EventFiles:
    """Handlers of the two commands.

    Args:
        core: what is written.
        osal: its files.
    """

    def __init__(self, core: EventCore, osal: Osal) -> None:
        self._core = core
        self._osal = osal
        self._replies = Replies(core)

    def write_log(self, packet: bytes) -> bool:
        """Write the event log: the cFE header and the long event packets, oldest first."""
        name = pk.WRITE_LOG_DATA_FILE.read(packet)["LogFilename"]
        return self._in_file(name, DEFAULT_LOG_FILE, "Write Log File", ev.ERR_CRLOGFILE_EID, self._write_log)

    def _write_log(self, path: str, descriptor: int) -> bool:
        written = self._write_header(descriptor, "cFE EVS Log File", SUBTYPE_EVS_EVENTLOG)
        if written != HEADER_SIZE:
            what = f"WriteHdr RC: {written}, Expected: {HEADER_SIZE}, filename = {path}"
            return self._replies.refuse(ev.WRITE_HEADER_ERR_EID, f"Write File Header to Log File Error: {what}")
        entries = self._core.log.entries()
        for entry in entries:
            status = self._write(descriptor, entry)
            if status < 0:
                text = f"Write Log File Command Error: OS_write = {status}, filename = {path}"
                return self._replies.refuse(ev.ERR_WRLOGFILE_EID, text)
        text = f"Write Log File Command: {len(entries)} event log entries written to {path}"
        return self._replies.done(ev.WRLOG_EID, text)

    def write_app_data(self, packet: bytes) -> bool:
        """Write what is known of applications: the cFE header and a record for each that is registered."""
        name = pk.WRITE_APP_DATA_FILE.read(packet)["AppDataFilename"]
        return self._in_file(name, DEFAULT_APP_DATA_FILE, "Write App Data", ev.ERR_CRDATFILE_EID, self._write_app_data)

    def _write_app_data(self, path: str, descriptor: int) -> bool:
        written = self._write_header(descriptor, "EVS Application Data File", SUBTYPE_EVS_APPDATA)
        if written != HEADER_SIZE:
            return False  # NASA's sends no event here
        apps = apps_by_slot(self._core)
        for count, app in enumerate(apps):
            status = self._write(descriptor, _record(app))
            if status < 0:
                where = f"At entry = {count}, OS_write = {status}, filename = {path}"
                return self._replies.refuse(ev.ERR_WRDATFILE_EID, f"Write App Data Command Error: {where}")
        text = f"Write App Data Command: {len(apps)} application data entries written to {path}"
        return self._replies.done(ev.WRDAT_EID, text)

    def _in_file(self, name: str, default: str, command: str, failed: int, write: Callable[[str, int], bool]) -> bool:
        """Have a new file written: `write` gets its path and descriptor, and says how it went."""
        opened = self._open(name, default, command, failed)
        if opened is None:
            return False
        try:
            return write(*opened)
        finally:
            self._osal.close(opened[1])

    def _open(self, name: str, default: str, command: str, failed: int) -> tuple[str, int] | None:
        """Path and descriptor of a new file; None after an event."""
        try:
            path = dump_file_name(name, default)
        except CfeError as error:
            self._replies.refuse(failed, f"{command} Command Error: CFE_FS_ParseInputFileNameEx() = {error.hex}")
            return None
        try:
            flags = OS_FILE_FLAG_CREATE | OS_FILE_FLAG_TRUNCATE
            return path, self._osal.open_create(path, flags, OS_WRITE_ONLY)
        except OsalError as error:
            text = f"{command} Command Error: OS_OpenCreate = {error.status}, filename = {path}"
            self._replies.refuse(failed, text)
            return None

    def _write_header(self, descriptor: int, description: str, subtype: int) -> int:
        """How many bytes were written, or the status of a failure."""
        try:
            return self._core.ports.fs.write_header(descriptor, init_header(description, subtype))
        except CfeError as error:
            return error.status

    def _write(self, descriptor: int, data: bytes) -> int:
        """How many bytes were written, or the status of a failure."""
        try:
            return self._osal.write(descriptor, data)
        except OsalError as error:
            return error.status


def _record(app: AppEvents) -> bytes:
    return pk.APP_DATA_RECORD.pack(
        AppName=app.name,
        ActiveFlag=int(app.active),
        EventTypesActiveFlag=app.types,
        EventCount=app.sent,
        SquelchedCount=app.squelch.dropped,
        Filters=[{"EventID": slot.event_id, "Mask": slot.mask, "Count": slot.count} for slot in app.filters.slots],
    )

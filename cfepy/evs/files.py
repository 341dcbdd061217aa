"""The files that Event Services writes on command: its event log, and what it knows of every application.

Stands for CFE_EVS_WriteLogDataFileCmd and CFE_EVS_WriteAppDataFileCmd. Imports cfepy.osal and cfepy.fs, no service.
"""

from __future__ import annotations

from cfepy.evs import events as ev
from cfepy.evs import packets as pk
from cfepy.evs.apps import AppEvents
from cfepy.evs.core import EventCore
from cfepy.evs.replies import Replies
from cfepy.evs.telemetry import apps_by_slot
from cfepy.fs import (
    HEADER_SIZE,
    FileCategory,
    get_default_extension,
    get_default_mount_point,
    init_header,
    parse_input_file_name_ex,
    stamp_header,
)
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
        opened = self._open(name, DEFAULT_LOG_FILE, "Write Log File", ev.ERR_CRLOGFILE_EID)
        if opened is None:
            return False
        path, descriptor = opened
        try:
            return self._write_log(path, descriptor)
        finally:
            self._osal.close(descriptor)

    def _write_log(self, path: str, descriptor: int) -> bool:
        written = self._write(descriptor, self._header("cFE EVS Log File", SUBTYPE_EVS_EVENTLOG))
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
        opened = self._open(name, DEFAULT_APP_DATA_FILE, "Write App Data", ev.ERR_CRDATFILE_EID)
        if opened is None:
            return False
        path, descriptor = opened
        try:
            return self._write_app_data(path, descriptor)
        finally:
            self._osal.close(descriptor)

    def _write_app_data(self, path: str, descriptor: int) -> bool:
        if self._write(descriptor, self._header("EVS Application Data File", SUBTYPE_EVS_APPDATA)) != HEADER_SIZE:
            return False  # NASA's sends no event here
        apps = apps_by_slot(self._core)
        for count, app in enumerate(apps):
            status = self._write(descriptor, _record(app))
            if status < 0:
                where = f"At entry = {count}, OS_write = {status}, filename = {path}"
                return self._replies.refuse(ev.ERR_WRDATFILE_EID, f"Write App Data Command Error: {where}")
        text = f"Write App Data Command: {len(apps)} application data entries written to {path}"
        return self._replies.done(ev.WRDAT_EID, text)

    def _open(self, name: str, default: str, command: str, failed: int) -> tuple[str, int] | None:
        """Path and descriptor of a new file; None after an event."""
        category = FileCategory.BINARY_DATA_DUMP
        try:
            path = parse_input_file_name_ex(
                name, default, get_default_mount_point(category), get_default_extension(category)
            )
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

    def _write(self, descriptor: int, data: bytes) -> int:
        """How many bytes were written, or the status of a failure."""
        try:
            return self._osal.write(descriptor, data)
        except OsalError as error:
            return error.status

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

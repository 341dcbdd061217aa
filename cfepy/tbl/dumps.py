"""Dumping a table to a file: a request, a snapshot of the image, and the file, written with the next housekeeping.

Stands for cfe_tbl_dump.c. The snapshot of a dump-only table is taken by its owner (CFE_TBL_DumpToBuffer), of any other
table at once.
"""

from __future__ import annotations

from cfepy.config import PlatformConfig
from cfepy.fs import HEADER_SIZE, TABLE_HEADER_SIZE, FileHeader, write_table_file
from cfepy.ports import Ports
from cfepy.status import (
    CFE_STATUS_EXTERNAL_RESOURCE_FAIL,
    CFE_SUCCESS,
    CFE_TBL_BAD_ARGUMENT,
    CFE_TBL_ERR_NO_BUFFER_AVAIL,
    CFE_TBL_INFO_DUMP_PENDING,
    CFE_TBL_INFO_NO_DUMP_PENDING,
    CfeError,
    OsalError,
)
from cfepy.tbl import events as ev
from cfepy.tbl.buffers import Buffer, BufferMemory
from cfepy.tbl.packets import ACTIVE_BUFFER, INACTIVE_BUFFER
from cfepy.tbl.registry import DumpControl, TableRecord
from cfepy.tbl.table_file import TableStorage

DESCRIPTION = "Table Dump Image"


class DumpRefused(CfeError):
    """A dump that cannot be, with the id of the event that tells the ground; `text` is what that event says."""

    def __init__(self, status: int, event_id: int, text: str) -> None:
        super().__init__(status, text)
        self.event_id = event_id


def select_buffer(table: TableRecord, which: int) -> Buffer | None:
    """The image that a dump or validate command means; None when there is none (CFE_TBL_GetSelectedBuffer)."""
    if which == ACTIVE_BUFFER:
        return table.active
    return table.inactive() if which == INACTIVE_BUFFER else None


class Dumps:
    """The dumps under way, at most CFE_PLATFORM_TBL_MAX_SIMULTANEOUS_LOADS.

    Attributes:
        last_file: the file written last, for housekeeping.
    """

    def __init__(self, memory: BufferMemory, config: PlatformConfig, ports: Ports, files: TableStorage) -> None:
        self._memory = memory
        self._config = config
        self._ports = ports
        self._files = files
        self._dumps: list[DumpControl] = []
        self.last_file = ""

    def request(self, table: TableRecord, which: int, file_name: str) -> None:
        """Begin a dump of the active or inactive image.

        Raises:
            DumpRefused: one is pending, there is no such image, or no buffer for the snapshot.
        """
        if table.dump is not None:
            raise DumpRefused(CFE_TBL_INFO_DUMP_PENDING, ev.DUMP_PENDING_ERR_EID, "A dump is already pending")
        source = select_buffer(table, which)
        if source is None:
            text = f"Cmd had illegal buffer parameter (0x{which:08X})"
            raise DumpRefused(CFE_TBL_BAD_ARGUMENT, ev.ILLEGAL_BUFF_PARAM_ERR_EID, text)
        if len(self._dumps) >= self._config.tbl_max_simultaneous_loads:
            text = "Too many table dumps have been requested"
            raise DumpRefused(CFE_TBL_ERR_NO_BUFFER_AVAIL, ev.TOO_MANY_DUMPS_ERR_EID, text)
        try:
            image = self._memory.acquire_shared()
        except CfeError as error:
            text = "No working buffers available"
            raise DumpRefused(error.status, ev.NO_WORK_BUFFERS_ERR_EID, text) from None
        dump = DumpControl(table, source, image, file_name)
        self._dumps.append(dump)
        if table.dump_only:
            table.dump = dump
        else:
            self._take(dump)

    def take_snapshot(self, table: TableRecord) -> int:
        """Take the snapshot that waits for the owner.

        Returns:
            CFE_SUCCESS, or CFE_TBL_INFO_NO_DUMP_PENDING.
        """
        dump, table.dump = table.dump, None
        if dump is None:
            return CFE_TBL_INFO_NO_DUMP_PENDING
        self._take(dump)
        return CFE_SUCCESS

    def _take(self, dump: DumpControl) -> None:
        dump.image.copy(dump.source.view())
        dump.file_time = self._ports.time.now()
        dump.performed = True

    def write_files(self, app_id: int, app_name: str) -> None:
        """Write every snapshot that was taken to its file, and tell the ground.

        Args:
            app_id: AppId of Table Services, for header and event.
            app_name: its name.
        """
        for dump in [dump for dump in self._dumps if dump.performed]:
            event_id, event_type, text = self._write(dump, app_id)
            self._end(dump)
            where = f"dump,table={dump.table.name},app={app_name},file={dump.file_name}"
            self._ports.evs.send_event_with_app_id(event_id, event_type, app_id, f"{where}:{text}")

    def _write(self, dump: DumpControl, app_id: int) -> tuple[int, int, str]:
        existed = self._files.exists(dump.file_name)
        header = FileHeader(
            description=DESCRIPTION,
            spacecraft_id=self._config.spacecraft_id,
            processor_id=self._config.processor_id,
            application_id=app_id,
            time_seconds=dump.file_time[0],
            time_subseconds=dump.file_time[1],
        )
        failed = self._store(dump.file_name, write_table_file(header, dump.table.name, bytes(dump.image.view())))
        if failed is not None:
            event_id, text = failed
            return event_id, ev.ERROR, text
        self.last_file = dump.file_name
        if existed:
            return ev.OVERWRITE_DUMP_INF_EID, ev.INFORMATION, "Successfully overwrote table dump"
        return ev.WRITE_DUMP_INF_EID, ev.INFORMATION, "Successfully dumped table"

    def _store(self, name: str, data: bytes) -> tuple[int, str] | None:
        """Write a file piece by piece, so that it is known which one found no room; event and text of that failure."""
        headers = HEADER_SIZE + TABLE_HEADER_SIZE
        no_header = f"Error writing cFE File Header, Status=0x{CFE_STATUS_EXTERNAL_RESOURCE_FAIL & 0xFFFFFFFF:08X}"
        for end, event_id, text in (
            (0, ev.CREATING_DUMP_FILE_ERR_EID, "Error creating dump file, Status={}"),
            (HEADER_SIZE, ev.WRITE_CFE_HDR_ERR_EID, no_header),
            (headers, ev.WRITE_TBL_HDR_ERR_EID, "Error writing cFE TBL Header, Status={}"),
            (len(data), ev.WRITE_TBL_IMG_ERR_EID, "Error writing Tbl image, Status={}"),
        ):
            try:
                self._files.write_file(name, data[:end])
            except OsalError as error:
                return event_id, text.format(error.status)
        return None

    def forget_owner(self, app_id: int) -> None:
        """Drop the dumps of an app's tables, because the app ends."""
        for dump in [dump for dump in self._dumps if dump.table.owner == app_id]:
            self._end(dump)

    def _end(self, dump: DumpControl) -> None:
        if dump.table.dump is dump:
            dump.table.dump = None
        self._dumps.remove(dump)
        self._memory.release_shared(dump.image)

"""Table dumps: a request, a snapshot of the image, and the file, written with the next housekeeping.

The module replaces cfe_tbl_dump.c. The owner takes the snapshot of a dump-only table (CFE_TBL_DumpToBuffer). Snapshots
of other tables are taken at once.
"""

from __future__ import annotations

from collections.abc import Iterator

from cfepy.config.platform import PlatformConfig
from cfepy.fs import HEADER_SIZE, TABLE_HEADER_SIZE, FileHeader, write_table_file
from cfepy.ids import TBL_DUMPCTRLID_BASE, UNDEFINED, IdTable
from cfepy.ports import Ports
from cfepy.status import (
    CFE_STATUS_EXTERNAL_RESOURCE_FAIL,
    CFE_SUCCESS,
    CFE_TBL_BAD_ARGUMENT,
    CFE_TBL_ERR_INVALID_HANDLE,
    CFE_TBL_ERR_NO_BUFFER_AVAIL,
    CFE_TBL_INFO_DUMP_PENDING,
    CFE_TBL_INFO_NO_DUMP_PENDING,
    OS_ERR_INVALID_SIZE,
    CfeError,
    OsalError,
)
from cfepy.tbl import events as ev
from cfepy.tbl.buffers import Buffer, BufferMemory
from cfepy.tbl.packets import ACTIVE_BUFFER, INACTIVE_BUFFER
from cfepy.tbl.registry import Access, TableRecord, TableRegistry
from cfepy.tbl.table_file import TableStorage

DESCRIPTION = "Table Dump Image"


def select_buffer(registry: TableRegistry, table: TableRecord, which: int) -> Buffer | None:
    """Return the image selected in a dump or validate command; None if there is none (CFE_TBL_GetSelectedBuffer)."""
    if which == ACTIVE_BUFFER:
        return registry.active(table)
    return registry.inactive(table) if which == INACTIVE_BUFFER else None


class DumpRefused(CfeError):
    """Exception for a refused dump, with the id and `text` of the event for the ground.

    There is no event for a buffer whose id was freed: cFE refuses that dump silently.
    """

    def __init__(self, status: int, event_id: int, text: str) -> None:
        super().__init__(status, text)
        self.event_id = event_id


class DumpControl:
    """A dump requested by the ground (CFE_TBL_DumpControl_t).

    Attributes:
        table: the table.
        table_name: its name.
        source: the buffer to copy.
        source_id: its id at the request; 0 once it was copied.
        image: the snapshot for the file.
        file_name: name of the file.
        file_time: time of the snapshot.
        performed: whether the snapshot was taken.
        number: its id.
    """

    __slots__ = ("file_name", "file_time", "image", "number", "performed", "source", "source_id", "table", "table_name")

    def __init__(self, table: TableRecord, source: Buffer) -> None:
        self.table = table
        self.table_name = table.name
        self.source = source
        self.source_id = source.load_id
        self.image: Buffer | None = None
        self.file_name = ""
        self.file_time = (0, 0)
        self.performed = False
        self.number = UNDEFINED

    @property
    def has_source(self) -> bool:
        """Whether the buffer still has the same id."""
        return self.source_id != UNDEFINED and self.source.load_id == self.source_id


class Dumps:
    """The dumps in progress, at most CFE_PLATFORM_TBL_MAX_SIMULTANEOUS_LOADS.

    Attributes:
        last_file: the file written last, for housekeeping.
    """

    def __init__(
        self, registry: TableRegistry, memory: BufferMemory, config: PlatformConfig, ports: Ports, files: TableStorage
    ) -> None:
        self._registry = registry
        self._memory = memory
        self._config = config
        self._ports = ports
        self._files = files
        self._dumps: IdTable[DumpControl] = IdTable(TBL_DUMPCTRLID_BASE, config.tbl_max_simultaneous_loads)
        self.last_file = ""

    def request(self, table: TableRecord, which: int, file_name: str) -> None:
        """Start a dump of the active or inactive image (CFE_TBL_AllocateDumpCtrlBlock, _PrepareDumpSnapshotBuffer).

        As in cFE, a dump that fails for lack of a buffer or an id keeps its slot forever.

        Raises:
            DumpRefused: if one is pending, the image does not exist, there are too many dumps, no buffer is free for
                the snapshot, or the buffer has no id.
        """
        if table.dump_id != UNDEFINED:
            raise DumpRefused(CFE_TBL_INFO_DUMP_PENDING, ev.DUMP_PENDING_ERR_EID, "A dump is already pending")
        source = select_buffer(self._registry, table, which)
        if source is None:
            text = f"Cmd had illegal buffer parameter (0x{which:08X})"
            raise DumpRefused(CFE_TBL_BAD_ARGUMENT, ev.ILLEGAL_BUFF_PARAM_ERR_EID, text)
        if len(self._dumps) >= self._dumps.capacity:
            text = "Too many table dumps have been requested"
            raise DumpRefused(CFE_TBL_ERR_NO_BUFFER_AVAIL, ev.TOO_MANY_DUMPS_ERR_EID, text)
        dump = DumpControl(table, source)
        dump.number = self._dumps.create(dump)
        image = self._memory.acquire_shared()
        if image is None:
            text = "No working buffers available"
            raise DumpRefused(CFE_TBL_ERR_NO_BUFFER_AVAIL, ev.NO_WORK_BUFFERS_ERR_EID, text)
        dump.image, dump.file_name = image, file_name
        if table.dump_only:
            table.dump_id = dump.number
        elif not self._take(dump):
            image.load_id = UNDEFINED
            raise DumpRefused(CFE_TBL_ERR_INVALID_HANDLE, UNDEFINED, f"{table.name!r} cannot be dumped")

    def take_snapshot(self, table: TableRecord, access: Access) -> int:
        """Take the pending snapshot as the owner (CFE_TBL_DumpToBuffer).

        The table stays pending until the file was written and this was called once more.

        Returns:
            CFE_SUCCESS, or CFE_TBL_INFO_NO_DUMP_PENDING.

        Raises:
            CfeError: CFE_TBL_ERR_INVALID_HANDLE if the buffer has lost its id, or the snapshot was already taken.
        """
        dump = self._dumps.find(table.dump_id)
        if dump is not None:
            if not self._take(dump):
                raise CfeError(CFE_TBL_ERR_INVALID_HANDLE, f"the image of {table.name!r} cannot be copied")
            return CFE_SUCCESS
        if table.dump_id != UNDEFINED:
            table.dump_id = UNDEFINED
            text = f"App(0x{access.app_id:x}) had stale dump request pending on 0x{int(access.handle):x} (dropped)"
            self._ports.syslog.write_to_sys_log(f"CFE_TBL_DumpToBuffer: {text}")
        return CFE_TBL_INFO_NO_DUMP_PENDING

    def _take(self, dump: DumpControl) -> bool:
        """Copy the image (CFE_TBL_ExecuteDumpSnapshot); return whether its buffer still has its id."""
        if not dump.has_source or dump.image is None:
            return False
        dump.image.copy(dump.source.view())
        dump.file_time = self._ports.time.now()
        dump.performed, dump.source_id = True, UNDEFINED
        return True

    def write_files(self, app_id: int) -> Iterator[tuple[DumpControl, int, int, str]]:
        """Write every finished snapshot to its file.

        Args:
            app_id: AppId of Table Services, for the header.

        Returns:
            Each dump with the id, type and text of its event.
        """
        for number in range(self._dumps.capacity):
            dump = self._dumps.at(number)
            if dump is not None and dump.performed and dump.image is not None:
                yield dump, *self._write(dump, dump.image, app_id)
                dump.image.load_id = UNDEFINED
                self._dumps.delete(dump.number)

    def _write(self, dump: DumpControl, image: Buffer, app_id: int) -> tuple[int, int, str]:
        existed = self._files.exists(dump.file_name)
        header = FileHeader(
            description=DESCRIPTION,
            spacecraft_id=self._config.spacecraft_id,
            processor_id=self._config.processor_id,
            application_id=app_id,
            time_seconds=dump.file_time[0],
            time_subseconds=dump.file_time[1],
        )
        failed = self._store(dump.file_name, write_table_file(header, dump.table_name, bytes(image.view())))
        if failed is not None:
            event_id, text = failed
            return event_id, ev.ERROR, text
        self.last_file = dump.file_name
        if existed:
            return ev.OVERWRITE_DUMP_INF_EID, ev.INFORMATION, "Successfully overwrote table dump"
        return ev.WRITE_DUMP_INF_EID, ev.INFORMATION, "Successfully dumped table"

    def _store(self, name: str, data: bytes) -> tuple[int, str] | None:
        """Write a file in parts, to find the part that fails; return event and text of the failure, or None."""
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
                if end == len(data) == headers and event_id == ev.WRITE_TBL_IMG_ERR_EID:
                    raise OsalError(OS_ERR_INVALID_SIZE, "a table dump requires content")
            except OsalError as error:
                return event_id, text.format(error.status)
        return None

    def forget_owner(self, app_id: int) -> None:
        """Drop the dumps of an app's tables whose snapshots were not taken, because the app ends (CFE_TBL_CleanUpApp).

        As in cFE, their shared buffers are not released.
        """
        for dump in [dump for dump in self._dumps if dump.has_source]:
            if dump.table.reg_id in self._registry.tables and dump.table.owner == app_id:
                self._dumps.delete(dump.number)

"""Loading a table: checks of the file, the working buffer, validation, and the switch to the new image.

Stands for cfe_tbl_load.c. A refusal carries the event that reports it; whoever asked for the load sends it. Imports
only cfepy.fs, cfepy.ports, cfepy.status and its neighbours here.
"""

from __future__ import annotations

from typing import Protocol

from cfepy.fs import CONTENT_ID, HEADER_SIZE, TABLE_HEADER_SIZE, FileHeader, TableHeader, read_header, read_table_header
from cfepy.fs.header import SUBTYPE_TBL_IMG
from cfepy.ports import Ports
from cfepy.status import (
    CFE_STATUS_VALIDATION_FAILURE,
    CFE_SUCCESS,
    CFE_TBL_ERR_ACCESS,
    CFE_TBL_ERR_BAD_CONTENT_ID,
    CFE_TBL_ERR_BAD_SUBTYPE_ID,
    CFE_TBL_ERR_DUMP_ONLY,
    CFE_TBL_ERR_FILE_FOR_WRONG_TABLE,
    CFE_TBL_ERR_FILE_TOO_LARGE,
    CFE_TBL_ERR_FILENAME_TOO_LONG,
    CFE_TBL_ERR_ILLEGAL_SRC_TYPE,
    CFE_TBL_ERR_LOAD_IN_PROGRESS,
    CFE_TBL_ERR_LOAD_INCOMPLETE,
    CFE_TBL_ERR_NO_BUFFER_AVAIL,
    CFE_TBL_ERR_NO_STD_HEADER,
    CFE_TBL_ERR_NO_TBL_HEADER,
    CFE_TBL_ERR_PARTIAL_LOAD,
    CFE_TBL_INFO_NO_UPDATE_PENDING,
    CFE_TBL_INFO_TABLE_LOCKED,
    CFE_TBL_WARN_PARTIAL_LOAD,
    CFE_TBL_WARN_SHORT_FILE,
    OS_FS_ERR_NAME_TOO_LONG,
    OS_FS_ERR_PATH_TOO_LONG,
    CfeError,
    OsalError,
)
from cfepy.tbl import events as eid
from cfepy.tbl.buffers import Buffer, BufferMemory, Bytes
from cfepy.tbl.registry import FIRST_PLACE, Registry, Table

_SIGN_EXTENDED = 0xFFFFFFFFFFFFFFFF


class Files(Protocol):
    """The file system as Table Services use it; failures raise OsalError."""

    def read_file(self, path: str) -> bytes:
        """The whole content of a file."""

    def write_file(self, path: str, data: bytes) -> None:
        """Make or replace a file."""

    def exists(self, path: str) -> bool:
        """Whether there is such a file."""


class Refused(CfeError):
    """A load that cannot be.

    Args:
        status: what CFE_TBL_Load returns.
        event_id: the event that tells the ground.
        text: what is wrong, as that event says it.
        names_file: whether that event names the file too.
    """

    def __init__(self, status: int, event_id: int, text: str, names_file: bool = True) -> None:
        super().__init__(status, text)
        self.event_id = event_id
        self.names_file = names_file


class TableFile:
    """A table file as far as it could be read: `table_name` stays "[unknown]" until both headers are found good."""

    def __init__(self, path: str) -> None:
        self.path = path
        self.table_name = "[unknown]"
        self.header = FileHeader()
        self.table = TableHeader("", 0)
        self.image = b""

    def open(self, files: Files) -> None:
        """Read the file and check its headers (CFE_TBL_TxnOpenTableLoadFile).

        Raises:
            Refused: it cannot be opened, is no cFE file, or no table image.
        """
        try:
            data = files.read_file(self.path)
        except OsalError as error:
            if error.status in (OS_FS_ERR_PATH_TOO_LONG, OS_FS_ERR_NAME_TOO_LONG):
                status, event_id = CFE_TBL_ERR_FILENAME_TOO_LONG, eid.CFE_TBL_LOAD_FILENAME_LONG_ERR_EID
                raise Refused(status, event_id, "Filename invalid") from None
            text = f"Unable to open, Status = {error.status}"
            raise Refused(CFE_TBL_ERR_ACCESS, eid.CFE_TBL_FILE_ACCESS_ERR_EID, text) from None
        self._read_headers(data)

    def _read_headers(self, data: bytes) -> None:
        if len(data) < HEADER_SIZE:
            text = f"Unable to read std header, Status = 0x{len(data):08x}"
            raise Refused(CFE_TBL_ERR_NO_STD_HEADER, eid.CFE_TBL_FILE_STD_HDR_ERR_EID, text)
        self.header = header = read_header(data)
        if header.content_type != CONTENT_ID:
            text = f"not a cFE file type, ContentType = 0x{header.content_type:08x}"
            raise Refused(CFE_TBL_ERR_BAD_CONTENT_ID, eid.CFE_TBL_FILE_TYPE_ERR_EID, text)
        if header.subtype != SUBTYPE_TBL_IMG:
            text = f"File subtype is wrong. Subtype = 0x{header.subtype:08x}"
            raise Refused(CFE_TBL_ERR_BAD_SUBTYPE_ID, eid.CFE_TBL_FILE_SUBTYPE_ERR_EID, text)
        if len(data) < HEADER_SIZE + TABLE_HEADER_SIZE:
            text = f"Unable to read tbl header, Status = 0x{len(data) - HEADER_SIZE:08x}"
            raise Refused(CFE_TBL_ERR_NO_TBL_HEADER, eid.CFE_TBL_FILE_TBL_HDR_ERR_EID, text)
        self.table = read_table_header(data)
        self.table_name = self.table.table_name or self.table_name
        self.image = data[HEADER_SIZE + TABLE_HEADER_SIZE :]

    def check_fits(self, table: Table) -> None:
        """Check that the content belongs into a table (CFE_TBL_ValidateFileIsLoadable and the checks of the content).

        Raises:
            Refused: another table's file, no data, partial data for a table never loaded, data that does not fit,
                or not as much data as the header says.
        """
        name, offset, size = self.table.table_name, self.table.offset, self.table.num_bytes
        if name != table.name:
            text = f"File for wrong table '{name}'"
            raise Refused(CFE_TBL_ERR_FILE_FOR_WRONG_TABLE, eid.CFE_TBL_LOAD_TBLNAME_MISMATCH_ERR_EID, text)
        if size == 0:
            text = "Table header indicates no data in file"
            raise Refused(CFE_TBL_ERR_NO_TBL_HEADER, eid.CFE_TBL_ZERO_LENGTH_LOAD_ERR_EID, text)
        if offset > 0 and table.active is None:
            text = "partial load for uninitialized table"
            raise Refused(CFE_TBL_ERR_PARTIAL_LOAD, eid.CFE_TBL_PARTIAL_LOAD_ERR_EID, text)
        if offset + size > table.size:
            text = f"Cannot load {size} at off {offset}"
            raise Refused(CFE_TBL_ERR_FILE_TOO_LARGE, eid.CFE_TBL_LOAD_EXCEEDS_SIZE_ERR_EID, text)
        if len(self.image) < size:
            text = "Incomplete load into working buffer"
            raise Refused(CFE_TBL_ERR_LOAD_INCOMPLETE, eid.CFE_TBL_FILE_INCOMPLETE_ERR_EID, text)
        if len(self.image) > size:
            text = f"File has more data than Tbl Hdr indicates ({size})"
            raise Refused(CFE_TBL_ERR_FILE_TOO_LARGE, eid.CFE_TBL_FILE_TOO_BIG_ERR_EID, text)

    def completeness(self, table: Table) -> int:
        """CFE_SUCCESS, or the warning that the file held only part of the table."""
        if self.table.offset > 0:
            return CFE_TBL_WARN_PARTIAL_LOAD
        return CFE_TBL_WARN_SHORT_FILE if self.table.num_bytes < table.size else CFE_SUCCESS


class Loads:
    """What loads need of the registry, the buffers and the other services."""

    def __init__(self, registry: Registry, memory: BufferMemory, ports: Ports, files: Files) -> None:
        self._registry = registry
        self._memory = memory
        self._ports = ports
        self._files = files

    def reserve(self, table: Table, from_file: bool) -> None:
        """Check that a table can be loaded now, and reserve its working buffer (CFE_TBL_ValidateLoadRequest).

        Raises:
            Refused: a load is in progress, the table is dump-only, or no buffer is to be had.
        """
        if table.loading is not None:
            text = "Load already in progress"
            raise Refused(CFE_TBL_ERR_LOAD_IN_PROGRESS, eid.CFE_TBL_LOAD_IN_PROGRESS_ERR_EID, text, names_file=False)
        if table.dump_only and (not table.user_defined or table.active is not None):
            text = "Attempted to load DUMP-ONLY table"
            raise Refused(CFE_TBL_ERR_DUMP_ONLY, eid.CFE_TBL_LOADING_A_DUMP_ONLY_ERR_EID, text, names_file=False)
        if table.dump_only and from_file:
            text = "Attempted to load from illegal source type=0"
            raise Refused(CFE_TBL_ERR_ILLEGAL_SRC_TYPE, eid.CFE_TBL_LOAD_TYPE_ERR_EID, text, names_file=False)
        if not table.user_defined:
            table.loading = self._working_buffer(table)

    def _working_buffer(self, table: Table) -> Buffer:
        """A buffer that starts as a copy of the active image, so that a file may hold part of the table."""
        try:
            own = table.active is None or table.double_buffered
            buffer = self._registry.exclusive_buffer(table) if own else self._memory.acquire_shared()
        except CfeError as error:
            if table.double_buffered:
                self._ports.syslog.write_to_sys_log(f"CFE_TBL_GetInactiveBufferExclusive: {error.text}")
            text = f"No working buffers available, stat=0x{CFE_TBL_ERR_NO_BUFFER_AVAIL & _SIGN_EXTENDED:x}"
            event_id = eid.CFE_TBL_NO_WORK_BUFFERS_ERR_EID
            raise Refused(CFE_TBL_ERR_NO_BUFFER_AVAIL, event_id, text, names_file=False) from None
        if table.active is not None:
            buffer.copy(table.active.view())
        buffer.mark_unvalidated()
        return buffer

    def fill_from_file(self, table: Table, file: TableFile) -> None:
        """Read a file into the working buffer.

        Raises:
            Refused: the file does not belong into the table.
        """
        file.check_fits(table)
        buffer = _loading(table)
        buffer.data[file.table.offset : file.table.offset + file.table.num_bytes] = file.image
        buffer.source = file.path
        buffer.file_time = file.header.time_seconds, file.header.time_subseconds
        buffer.recompute_crc()
        buffer.is_valid = table.validator is None

    def fill_from_memory(self, table: Table, source: Bytes) -> None:
        """Copy an image into the working buffer, or, with a user-defined address, make it the working buffer.

        Raises:
            Refused: the source is shorter than the table (C would read past its end).
        """
        if len(source) < table.size:
            text = f"Cannot load {len(source)} at off 0"
            raise Refused(CFE_TBL_ERR_LOAD_INCOMPLETE, eid.CFE_TBL_LOAD_EXCEEDS_SIZE_ERR_EID, text, names_file=False)
        image = memoryview(source)[: table.size]
        if table.user_defined:
            table.loading = self._memory.external(image, FIRST_PLACE)
        buffer = _loading(table)
        if not table.user_defined:
            buffer.copy(image)
        buffer.source = f"Addr 0x{buffer.address:08X}"
        buffer.file_time = (0, 0)
        buffer.recompute_crc()

    def validate(self, table: Table) -> list[Refused]:
        """Run the validator over the working buffer; returns what to report, nothing when the image is good.

        A bad image is overwritten with zeros. A positive result of a validator is a mistake of its own and is reported
        besides.
        """
        buffer = _loading(table)
        result = 0 if table.validator is None else table.validator(buffer.view())
        buffer.is_valid = buffer.activate_requested = result == 0
        if result == 0:
            return []
        faults = []
        if result > 0:
            text = f"Validation func return code invalid (Stat={result & _SIGN_EXTENDED:x})"
            result = CFE_STATUS_VALIDATION_FAILURE
            faults.append(Refused(result, eid.CFE_TBL_LOAD_VAL_ERR_EID, text, names_file=False))
        buffer.clear()
        text = f"Validation func reports table invalid (Stat={result & _SIGN_EXTENDED:x})"
        return [*faults, Refused(result, eid.CFE_TBL_VALIDATION_ERR_EID, text, names_file=False)]

    def update(self, table: Table) -> int:
        """Make the loaded image the active one (CFE_TBL_UpdateInternal).

        Returns:
            CFE_SUCCESS, CFE_TBL_INFO_NO_UPDATE_PENDING, or CFE_TBL_INFO_TABLE_LOCKED: then try again later.
        """
        loaded = table.loading
        if loaded is None:
            return CFE_TBL_INFO_NO_UPDATE_PENDING
        target = loaded
        if loaded.is_shared:
            try:
                target = self._registry.exclusive_buffer(table)
            except CfeError:
                return CFE_TBL_INFO_TABLE_LOCKED
            target.take_over(loaded)
        table.active = target
        table.last_file, table.last_update, table.modified = target.source, self._ports.time.now(), False
        for access in table.accesses:
            access.updated = True
        self._registry.discard_load(table)
        return CFE_SUCCESS

    def report(self, refused: Refused, app_id: int, caller: str, file: TableFile | None, table: Table | None) -> None:
        """Send the event of a refusal, in the name of Table Services.

        Args:
            refused: what happened.
            app_id: AppId of Table Services.
            caller: name of the app that asked.
            file: the file it was about, if any.
            table: the table it was about, when it was found.
        """
        name = file.table_name if file else table.name if table else "[unknown]"
        where = f"file={file.path},tbl={name}" if file and refused.names_file else f"tbl={name}"
        text = f"{'LoadFile' if file else 'Load'},app={caller},{where}:{refused.text}"
        self._ports.evs.send_event_with_app_id(refused.event_id, eid.ERROR, app_id, text)

    def open(self, file: TableFile) -> None:
        """Read and check a file that was named; see `TableFile.open`."""
        file.open(self._files)


def _loading(table: Table) -> Buffer:
    if table.loading is None:
        raise CfeError(CFE_TBL_ERR_NO_BUFFER_AVAIL, f"no load of {table.name!r} is in progress; please report this")
    return table.loading

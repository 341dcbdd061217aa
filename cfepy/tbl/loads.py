"""Loading a table: the working buffer, validation, and the switch to the new image.

Stands for the second half of cfe_tbl_load.c.
"""

from __future__ import annotations

from cfepy.ports import Ports
from cfepy.status import (
    CFE_STATUS_VALIDATION_FAILURE,
    CFE_SUCCESS,
    CFE_TBL_ERR_DUMP_ONLY,
    CFE_TBL_ERR_ILLEGAL_SRC_TYPE,
    CFE_TBL_ERR_LOAD_IN_PROGRESS,
    CFE_TBL_ERR_LOAD_INCOMPLETE,
    CFE_TBL_ERR_NO_BUFFER_AVAIL,
    CFE_TBL_INFO_NO_UPDATE_PENDING,
    CFE_TBL_INFO_TABLE_LOCKED,
    CfeError,
)
from cfepy.tbl import events as ev
from cfepy.tbl.buffers import Buffer, BufferMemory, Bytes
from cfepy.tbl.critical import CriticalTables
from cfepy.tbl.registry import FIRST_PLACE, TableRecord, TableRegistry
from cfepy.tbl.table_file import LoadFile, Refused, TableStorage

_SIGN_EXTENDED = 0xFFFFFFFFFFFFFFFF


class Loads:
    """What loads need of the registry, the buffers and the other services."""

    def __init__(
        self, registry: TableRegistry, memory: BufferMemory, ports: Ports, files: TableStorage, critical: CriticalTables
    ) -> None:
        self._critical = critical
        self._registry = registry
        self._memory = memory
        self._ports = ports
        self._files = files

    def reserve(self, table: TableRecord, from_file: bool) -> None:
        """Check that a table can be loaded now, and reserve its working buffer (CFE_TBL_ValidateLoadRequest).

        Raises:
            Refused: a load is in progress, the table is dump-only, or no buffer is to be had.
        """
        if table.loading is not None:
            text = "Load already in progress"
            raise Refused(CFE_TBL_ERR_LOAD_IN_PROGRESS, ev.LOAD_IN_PROGRESS_ERR_EID, text, names_file=False)
        if table.dump_only and (not table.user_defined or table.active is not None):
            text = "Attempted to load DUMP-ONLY table"
            raise Refused(CFE_TBL_ERR_DUMP_ONLY, ev.LOADING_A_DUMP_ONLY_ERR_EID, text, names_file=False)
        if table.dump_only and from_file:
            text = "Attempted to load from illegal source type=0"
            raise Refused(CFE_TBL_ERR_ILLEGAL_SRC_TYPE, ev.LOAD_TYPE_ERR_EID, text, names_file=False)
        if not table.user_defined:
            table.loading = self._working_buffer(table)

    def _working_buffer(self, table: TableRecord) -> Buffer:
        """A buffer that starts as a copy of the active image, so that a file may hold part of the table."""
        try:
            own = table.active is None or table.double_buffered
            buffer = self._registry.exclusive_buffer(table) if own else self._memory.acquire_shared()
        except CfeError as error:
            if table.double_buffered:
                self._ports.syslog.write_to_sys_log(f"CFE_TBL_GetInactiveBufferExclusive: {error.text}")
            text = f"No working buffers available, stat=0x{CFE_TBL_ERR_NO_BUFFER_AVAIL & _SIGN_EXTENDED:x}"
            event_id = ev.NO_WORK_BUFFERS_ERR_EID
            raise Refused(CFE_TBL_ERR_NO_BUFFER_AVAIL, event_id, text, names_file=False) from None
        if table.active is not None:
            buffer.copy(table.active.view())
        buffer.mark_unvalidated()
        return buffer

    def fill_from_file(self, table: TableRecord, file: LoadFile) -> None:
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

    def fill_from_memory(self, table: TableRecord, source: Bytes) -> None:
        """Copy an image into the working buffer, or, with a user-defined address, make it the working buffer.

        Raises:
            Refused: the source has no bytes, or is shorter than the table (C would read past its end).
        """
        if not isinstance(source, Bytes):
            text = f"Attempted to load from illegal source type={type(source).__name__}"
            raise Refused(CFE_TBL_ERR_ILLEGAL_SRC_TYPE, ev.LOAD_TYPE_ERR_EID, text, names_file=False)
        if len(source) < table.size:
            text = f"Cannot load {len(source)} at off 0"
            raise Refused(CFE_TBL_ERR_LOAD_INCOMPLETE, ev.LOAD_EXCEEDS_SIZE_ERR_EID, text, names_file=False)
        image = memoryview(source)[: table.size]
        if table.user_defined:
            table.loading = self._memory.external(image, FIRST_PLACE)
        buffer = _loading(table)
        if not table.user_defined:
            buffer.copy(image)
        buffer.source = f"Addr 0x{buffer.address:08X}"
        buffer.file_time = (0, 0)
        buffer.recompute_crc()

    def validate(self, table: TableRecord) -> list[Refused]:
        """Run the validator over the working buffer; returns what to report, nothing when the image is good.

        A bad image is overwritten with zeros. A positive result of a validator is a mistake of its own and is reported
        besides.
        """
        buffer = _loading(table)
        result = table.judge(buffer.view())
        buffer.is_valid = buffer.activate_requested = result == 0
        if result == 0:
            return []
        faults = []
        if result > 0:
            text = f"Validation func return code invalid (Stat={result & _SIGN_EXTENDED:x})"
            result = CFE_STATUS_VALIDATION_FAILURE
            faults.append(Refused(result, ev.LOAD_VAL_ERR_EID, text, names_file=False))
        buffer.clear()
        text = f"Validation func reports table invalid (Stat={result & _SIGN_EXTENDED:x})"
        return [*faults, Refused(result, ev.VALIDATION_ERR_EID, text, names_file=False)]

    def update(self, table: TableRecord) -> int:
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
        self._critical.save(table)
        self._registry.discard_load(table)
        return CFE_SUCCESS

    def report(
        self, refused: Refused, app_id: int, caller: str, file: LoadFile | None, table: TableRecord | None
    ) -> None:
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
        self._ports.evs.send_event_with_app_id(refused.event_id, ev.ERROR, app_id, text)

    def open(self, file: LoadFile) -> None:
        """Read and check a file that was named; see `LoadFile.open`."""
        file.open(self._files)


def _loading(table: TableRecord) -> Buffer:
    if table.loading is None:
        raise CfeError(CFE_TBL_ERR_NO_BUFFER_AVAIL, f"no load of {table.name!r} is in progress; please report this")
    return table.loading

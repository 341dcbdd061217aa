"""Loading a table: the working buffer, validation, and the switch to the new image.

It replaces the second half of cfe_tbl_load.c.
"""

from __future__ import annotations

from collections.abc import Callable

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
from cfepy.tbl.registry import TableRecord, TableRegistry
from cfepy.tbl.table_file import LoadFile, Refused, TableStorage

_SIGN_EXTENDED = 0xFFFFFFFFFFFFFFFF
SRC_FILE, SRC_ADDRESS = 0, 1
"""The source of an image (CFE_TBL_SrcEnum_t)."""


class Loads:
    """The loads of tables, with the registry, the buffers and the other services."""

    def __init__(
        self, registry: TableRegistry, memory: BufferMemory, ports: Ports, files: TableStorage, critical: CriticalTables
    ) -> None:
        self._critical = critical
        self._registry = registry
        self._memory = memory
        self._ports = ports
        self._files = files

    def reserve(self, table: TableRecord, source_type: int) -> None:
        """Check that a table can be loaded now, and reserve its working buffer (CFE_TBL_ValidateLoadRequest).

        Args:
            table: the table to load.
            source_type: SRC_FILE or SRC_ADDRESS; C code can pass any number.

        Raises:
            Refused: if a load is in progress, the table is dump-only, or no buffer is free.
        """
        if table.is_loading:
            text = "Load already in progress"
            raise Refused(CFE_TBL_ERR_LOAD_IN_PROGRESS, ev.LOAD_IN_PROGRESS_ERR_EID, text, names_file=False)
        if table.dump_only and (not table.user_defined or table.is_loaded):
            text = "Attempted to load DUMP-ONLY table"
            raise Refused(CFE_TBL_ERR_DUMP_ONLY, ev.LOADING_A_DUMP_ONLY_ERR_EID, text, names_file=False)
        if source_type != SRC_ADDRESS and (table.dump_only or source_type != SRC_FILE):
            text = f"Attempted to load from illegal source type={source_type}"
            raise Refused(CFE_TBL_ERR_ILLEGAL_SRC_TYPE, ev.LOAD_TYPE_ERR_EID, text, names_file=False)
        if self._registry.working_buffer(table) is None:
            raise _no_buffer()

    def fill_from_file(self, table: TableRecord, file: LoadFile) -> None:
        """Read a file into the working buffer (CFE_TBL_LoadContentFromFile, CFE_TBL_SetMetaDataFromFileHeader).

        If the file is too short or too long, the bytes already read stay in the buffer.

        Raises:
            Refused: if the file does not belong to the table, or no load is in progress.
        """
        file.check_fits(table)
        buffer = self._registry.loading(table)
        if buffer is None:
            raise _no_buffer()
        offset, size = file.table.offset, file.table.num_bytes
        if offset + size > len(buffer.data):
            raise file.too_big()
        image = file.image[:size]
        buffer.data[offset : offset + len(image)] = image
        if len(image) < size:
            text = "Incomplete load into working buffer"
            raise Refused(CFE_TBL_ERR_LOAD_INCOMPLETE, ev.FILE_INCOMPLETE_ERR_EID, text)
        if len(file.image) > size:
            raise file.too_big()
        buffer.content_size = offset + size
        buffer.source = file.path
        buffer.file_time = file.header.time_seconds, file.header.time_subseconds
        buffer.recompute_crc()
        buffer.is_valid, buffer.activate_requested = table.validator is None, False

    def fill_from_memory(
        self,
        table: TableRecord,
        source: Bytes,
        address: int | None = None,
        read: Callable[[], bytes] | None = None,
    ) -> None:
        """Copy an image into the working buffer, or make it the working buffer if the address is user-defined.

        Args:
            table: the table to load.
            source: the image.
            address: its address in C; None for bytes of Python, which get a number for telemetry.
            read: reads it later, when C's memory may have disappeared.

        Raises:
            Refused: if the source is not bytes, or is shorter than the table (C would read past its end).
        """
        if not isinstance(source, Bytes):
            text = f"Attempted to load from illegal source type={type(source).__name__}"
            raise Refused(CFE_TBL_ERR_ILLEGAL_SRC_TYPE, ev.LOAD_TYPE_ERR_EID, text, names_file=False)
        if len(source) < table.size:
            text = f"Cannot load {len(source)} at off 0"
            raise Refused(CFE_TBL_ERR_LOAD_INCOMPLETE, ev.LOAD_EXCEEDS_SIZE_ERR_EID, text, names_file=False)
        image = memoryview(source)[: table.size]
        buffer = self._loading(table)
        if table.user_defined:
            buffer.refer_to(image, self._memory.address_for(table.size) if address is None else address, read)
        else:
            buffer.copy(image)
        buffer.source = f"Addr 0x{buffer.address if address is None else address:08X}"
        buffer.file_time = (0, 0)
        buffer.recompute_crc()

    def validate(self, table: TableRecord) -> list[Refused]:
        """Run the validator on the working buffer; return the refusals to report, or an empty list for a valid image.

        An invalid image is overwritten with zeros. A positive result of a validator is an error of the validator and is
        reported too.
        """
        buffer = self._loading(table)
        result = table.judge(table.image(buffer))
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

    def update(self, table: TableRecord, handle: int) -> int:
        """Make the loaded image the active one (CFE_TBL_UpdateInternal).

        Returns:
            CFE_SUCCESS, CFE_TBL_INFO_NO_UPDATE_PENDING, or CFE_TBL_INFO_TABLE_LOCKED, after which the caller should try
                again later.
        """
        registry = self._registry
        loaded = registry.loading(table)
        if loaded is None:
            return CFE_TBL_INFO_NO_UPDATE_PENDING
        target = loaded if registry.is_private(table, loaded) else registry.exclusive_buffer(table)
        if target is None:
            text = f"Unable to update locked table Handle={int(handle)}"
            self._ports.syslog.write_to_sys_log(f"CFE_TBL_UpdateInternal: {text}")
            return CFE_TBL_INFO_TABLE_LOCKED
        if target is not loaded:
            target.copy(loaded.view())
            target.source, target.file_time, target.crc = loaded.source, loaded.file_time, loaded.crc
        table.set_active(target)
        table.note_load(target.source, self._ports.time.now())
        table.tell_users()
        if table.critical:
            self._critical.save(table)
        registry.discard_load(table)
        return CFE_SUCCESS

    def open(self, file: LoadFile) -> None:
        """Read and check a file; see `LoadFile.open`."""
        file.open(self._files)

    def _loading(self, table: TableRecord) -> Buffer:
        buffer = self._registry.loading(table)
        if buffer is None:
            raise CfeError(CFE_TBL_ERR_NO_BUFFER_AVAIL, f"no load of {table.name!r} is in progress; please report this")
        return buffer


def _no_buffer() -> Refused:
    text = f"No working buffers available, stat=0x{CFE_TBL_ERR_NO_BUFFER_AVAIL & _SIGN_EXTENDED:x}"
    return Refused(CFE_TBL_ERR_NO_BUFFER_AVAIL, ev.NO_WORK_BUFFERS_ERR_EID, text, names_file=False)

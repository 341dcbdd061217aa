"""The Critical Data Store (cfe_es_cds.c, cfe_es_cds_mempool.c): named blocks that outlive a processor reset.

The whole store is bytes in the PSP's CDS memory: a signature, the registry, a pool with the blocks, another signature.
After a reset, the intact parts are used again. Without the signatures, the whole store is lost. A damaged record or
descriptor loses its block. Damaged data are detected when the owner reads them.

The registry has one record of 72 bytes for each block. The layout is C's (CFE_ES_CDS_RegRec_t), with one addition: the
four padding bytes hold a check value, which reveals a damaged record after a reset. A free record is all zeros.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Container, Iterator
from contextlib import suppress
from dataclasses import dataclass

from cfepy.es import events as ev
from cfepy.es.pools import BUCKETS, MIN_ALIGNMENT, GenericPool, min_size
from cfepy.es.tables import EsCore
from cfepy.fs import calculate_crc, crc16
from cfepy.ids import ES_CDSBLOCKID_BASE, UNDEFINED, find_next, make, name_size, to_index
from cfepy.psp import RST_TYPE_PROCESSOR, Psp
from cfepy.reading.texts import from_bytes, to_bytes
from cfepy.status import (
    CFE_ES_BAD_ARGUMENT,
    CFE_ES_CDS_ALREADY_EXISTS,
    CFE_ES_CDS_BLOCK_CRC_ERR,
    CFE_ES_CDS_INVALID_NAME,
    CFE_ES_CDS_INVALID_SIZE,
    CFE_ES_CDS_OWNER_ACTIVE_ERR,
    CFE_ES_CDS_WRONG_TYPE_ERR,
    CFE_ES_ERR_NAME_NOT_FOUND,
    CFE_ES_ERR_RESOURCEID_NOT_VALID,
    CFE_ES_NO_RESOURCE_IDS_AVAILABLE,
    CFE_ES_NOT_IMPLEMENTED,
    CFE_SUCCESS,
    CfeError,
)

RECORD = struct.Struct("<IIQQ40s?7x")
FULL_NAME_SIZE = 40
"""Bytes of a block's full name, including the NUL (CFE_MISSION_ES_CDS_MAX_FULL_NAME_LEN)."""

BLOCK_HEADER = struct.Struct("<I")
"""The header of a block's data: their CRC (CFE_ES_CDS_BlockHeader_t)."""

FREE_RECORD = bytes(RECORD.size)
_CHECK_AT = 4
SIGNATURE_BEGIN = b"_CDSBeg_"
SIGNATURE_END = b"_CDSEnd_"
MAX_BLOCK_SIZE = (1 << 30) - BLOCK_HEADER.size
_SIGNATURE_BYTES = 8
_COUNT_BYTES = 4
_REGISTRY_AT = _SIGNATURE_BYTES + _COUNT_BYTES
MAX_NAME_LENGTH = 16
"""Characters of a block's own name (CFE_MISSION_ES_CDS_MAX_NAME_LENGTH)."""


@dataclass(slots=True, eq=False)
class CdsBlock:
    """A block: its handle, its offset, its size with the header, its full name, and whether it holds a
    critical table.
    """

    handle: int
    offset: int
    size: int
    name: str
    is_table: bool

    @property
    def user_size(self) -> int:
        """The bytes that its owner sees; 0 if the block has lost its bytes because there was no room for a new size."""
        return max(0, self.size - BLOCK_HEADER.size)


def pack(block: CdsBlock) -> bytes:
    """Return the record of a block."""
    name = to_bytes(block.name)[: FULL_NAME_SIZE - 1]
    record = RECORD.pack(block.handle, 0, block.offset, block.size, name, block.is_table)
    return _with_check(record, crc16(record))


def is_sound(record: bytes) -> bool:
    """Return whether a record is intact."""
    found = int.from_bytes(record[_CHECK_AT : _CHECK_AT + 4], "little")
    return found == crc16(_with_check(record, 0))


def unpack(record: bytes) -> CdsBlock:
    """Return the CDS block that a registry record describes."""
    handle, _, offset, size, name, is_table = RECORD.unpack(record)
    return CdsBlock(handle, offset, size, from_bytes(name), is_table)


def _with_check(record: bytes, check: int) -> bytes:
    return record[:_CHECK_AT] + check.to_bytes(4, "little") + record[_CHECK_AT + 4 :]


class DamagedData(CfeError):
    """Exception for damaged data of a block; `data` has the data, which NASA's code leaves in the caller's memory."""

    def __init__(self, text: str, data: bytes) -> None:
        super().__init__(CFE_ES_CDS_BLOCK_CRC_ERR, text)
        self.data = data


class CriticalDataStore:
    """The CDS of one processor.

    Args:
        psp: provides the memory.
        capacity: number of records in the registry.
        log: the system log.

    Attributes:
        is_available: whether the store can be used; False before `early_init`, and on a board with too little memory.
    """

    def __init__(self, psp: Psp, capacity: int, log: Callable[[str], object]) -> None:
        self.is_available = False
        self._psp = psp
        self._capacity = capacity
        self._log = log
        self._size = psp.get_cds_size() & ~3
        self._pool_at = _REGISTRY_AT + capacity * RECORD.size
        self._blocks: list[CdsBlock | None] = [None] * capacity
        self._last_handle = make(ES_CDSBLOCKID_BASE, 0)

    def __iter__(self) -> Iterator[CdsBlock]:
        """Iterate over the blocks in the order of the registry."""
        return iter([block for block in self._blocks if block is not None])

    @property
    def overhead(self) -> int:
        """The bytes not available for blocks: the signatures and the registry."""
        return self._pool_at + _SIGNATURE_BYTES

    def room_of(self, block: CdsBlock) -> int:
        """Return the bytes of the CDS that a block takes, with its descriptor."""
        return self._pool.room_of(block.size) if block.size else 0

    # -- after a reset ---------------------------------------------------------------------------------------------

    def early_init(self) -> None:
        """Take over the content of the memory, or start with an empty store (CFE_ES_CDS_EarlyInit)."""
        reserved = self._pool_at + _SIGNATURE_BYTES
        required = reserved + min_size(BUCKETS, self._capacity)
        if self._size < required:
            self._log(f"CFE_ES_CDS_EarlyInit: CDS Size ({self._size}) less than required ({required})")
            return
        self._pool = GenericPool(
            self._psp.read_from_cds,
            lambda offset, data: self._psp.write_to_cds(data, offset),
            self._log,
            start=self._pool_at,
            size=self._size - reserved,
            alignment=MIN_ALIGNMENT,
            sizes=BUCKETS,
        )
        if self._is_valid():
            self._rebuild()
        else:
            self._begin_anew()
        self.is_available = True

    def _is_valid(self) -> bool:
        """Return whether the memory has a CDS of the same size (CFE_ES_ValidateCDS and the first check of
        CFE_ES_RebuildCDS).
        """
        read = self._psp.read_from_cds
        after_reset = self._psp.get_restart_type().reset_type == RST_TYPE_PROCESSOR
        begin, end = read(0, _SIGNATURE_BYTES), read(self._size - _SIGNATURE_BYTES, _SIGNATURE_BYTES)
        if (begin, end) != (SIGNATURE_BEGIN, SIGNATURE_END):
            if after_reset:
                self._log("CFE_ES_ValidateCDS: No valid CDS found after a processor reset, it is made anew")
            return False
        count = int.from_bytes(read(_SIGNATURE_BYTES, _COUNT_BYTES), "little")
        if count != self._capacity:
            self._log(f"CFE_ES_RebuildCDS: Registry in CDS incorrect size ({count})")
        return count == self._capacity

    def _begin_anew(self) -> None:
        """Clear the CDS and create an empty one (CFE_ES_ClearCDS, _InitCDSSignatures, _InitCDSRegistry)."""
        write = self._psp.write_to_cds
        write(bytes(self._size), 0)
        write(SIGNATURE_BEGIN, 0)
        write(self._capacity.to_bytes(_COUNT_BYTES, "little"), _SIGNATURE_BYTES)
        write(SIGNATURE_END, self._size - _SIGNATURE_BYTES)

    def _rebuild(self) -> None:
        """Take over the records of the registry that are consistent with the pool (CFE_ES_RebuildCDS)."""
        unclaimed = self._pool.rebuild()
        for slot in range(self._capacity):
            record = self._psp.read_from_cds(_REGISTRY_AT + slot * RECORD.size, RECORD.size)
            if record == FREE_RECORD:
                continue
            block = unpack(record)
            if is_sound(record) and self._is_whole(slot, block, unclaimed):
                self._blocks[slot] = block
                del unclaimed[block.offset]
            else:
                self._log(f"CFE_ES_RebuildCDS: Entry {slot} of the CDS registry or its block is damaged, it is dropped")
                self._save(slot, None)
        for offset in unclaimed:
            self._free(offset)

    def _is_whole(self, slot: int, block: CdsBlock, unclaimed: Container[int]) -> bool:
        """Return whether a record belongs into its slot, and the pool has a matching block that is still unclaimed."""
        try:
            found = self._pool.size_of(block.offset)
            return found == block.size and block.offset in unclaimed and self._slot(block.handle) == slot
        except CfeError:
            return False

    # -- blocks ----------------------------------------------------------------------------------------------------

    def register(self, user_size: int, name: str, is_table: bool) -> tuple[int, int]:
        """Reserve a block, or find an existing one (CFE_ES_RegisterCDSEx).

        Args:
            user_size: bytes of data.
            name: full name, "APP.Name".
            is_table: whether it holds a critical table.

        Returns:
            The handle, and CFE_SUCCESS (a new block, all zeros) or CFE_ES_CDS_ALREADY_EXISTS.

        Raises:
            CfeError: CFE_ES_CDS_INVALID_SIZE, CFE_ES_NO_RESOURCE_IDS_AVAILABLE, CFE_ES_ERR_MEM_BLOCK_SIZE. After the
                last one, an existing block has lost its bytes but keeps its name and handle until a reset.
        """
        if not 0 < user_size <= MAX_BLOCK_SIZE:
            raise CfeError(CFE_ES_CDS_INVALID_SIZE, f"invalid size of a CDS block: {user_size} bytes")
        size = user_size + BLOCK_HEADER.size
        block = self.find(name)
        if block is not None and block.size == size:
            return block.handle, CFE_ES_CDS_ALREADY_EXISTS
        if block is not None:
            handle, is_table = block.handle, block.is_table
            self._empty(block)
        else:
            handle = self._next_handle()
        block = CdsBlock(handle, self._pool.get(size), size, name, is_table)
        self._blocks[self._slot(handle)] = block
        self._save(self._slot(handle), block)
        self.write(handle, bytes(user_size))
        return handle, CFE_SUCCESS

    def write(self, handle: int, data: bytes | bytearray | memoryview) -> None:
        """Replace a block's data (CFE_ES_CDSBlockWrite).

        Raises:
            CfeError: CFE_ES_ERR_RESOURCEID_NOT_VALID, CFE_ES_BAD_ARGUMENT (wrong number of bytes),
                CFE_ES_BUFFER_NOT_IN_POOL (it has lost its bytes), CFE_ES_POOL_BLOCK_INVALID (its descriptor is
                damaged).
        """
        block = self.get(handle)
        try:
            self._check(block)
        except CfeError:
            self._log("CFE_ES_CDSBlockWrite: Invalid Handle or Block Descriptor.")
            raise
        if len(data) != block.user_size:
            raise CfeError(
                CFE_ES_BAD_ARGUMENT, f"data for {block.name!r} must have {block.user_size} bytes, not {len(data)}"
            )
        self._psp.write_to_cds(BLOCK_HEADER.pack(calculate_crc(data)), block.offset)
        self._psp.write_to_cds(data, block.offset + BLOCK_HEADER.size)

    def read(self, handle: int) -> bytes:
        """Return a block's data (CFE_ES_CDSBlockRead).

        Raises:
            CfeError: CFE_ES_ERR_RESOURCEID_NOT_VALID, CFE_ES_POOL_BLOCK_INVALID or CFE_ES_CDS_INVALID_SIZE (the block's
                descriptor is damaged).
            DamagedData: if its data are damaged (CFE_ES_CDS_BLOCK_CRC_ERR).
        """
        block = self.get(handle)
        self._check(block)
        raw = self._psp.read_from_cds(block.offset, block.size)
        data = raw[BLOCK_HEADER.size :]
        if BLOCK_HEADER.unpack_from(raw)[0] != calculate_crc(data):
            raise DamagedData(f"the data of CDS block {block.name!r} are damaged", data)
        return data

    def delete(self, name: str) -> None:
        """Free a block (the end of CFE_ES_DeleteCDS).

        Raises:
            CfeError: CFE_ES_ERR_NAME_NOT_FOUND.
        """
        self._remove(self.named(name))

    def find(self, name: str) -> CdsBlock | None:
        """Return the block of a full name, or None."""
        return next((block for block in self if block.name == name), None)

    def named(self, name: str) -> CdsBlock:
        """Return the block of a full name; raises CFE_ES_ERR_NAME_NOT_FOUND."""
        block = self.find(name)
        if block is None:
            raise CfeError(CFE_ES_ERR_NAME_NOT_FOUND, f"unknown CDS block {name!r}")
        return block

    def get(self, handle: int) -> CdsBlock:
        """Return the block of a handle; raises CFE_ES_ERR_RESOURCEID_NOT_VALID."""
        block = self._blocks[self._slot(handle)]
        if block is None or block.handle != handle:
            raise CfeError(CFE_ES_ERR_RESOURCEID_NOT_VALID, f"invalid CDS handle 0x{handle:x}")
        return block

    def _check(self, block: CdsBlock) -> None:
        if self._pool.size_of(block.offset) != block.size:
            raise CfeError(CFE_ES_CDS_INVALID_SIZE, f"the size of CDS block {block.name!r} is damaged")

    def _slot(self, handle: int) -> int:
        return to_index(handle, ES_CDSBLOCKID_BASE, self._capacity)

    def _next_handle(self) -> int:
        handle = find_next(self._last_handle, self._capacity, lambda each: self._blocks[self._slot(each)] is not None)
        if handle == UNDEFINED:
            raise CfeError(CFE_ES_NO_RESOURCE_IDS_AVAILABLE, f"the limit of {self._capacity} CDS blocks is reached")
        self._last_handle = handle
        return handle

    def _remove(self, block: CdsBlock) -> None:
        self._empty(block)
        self._blocks[self._slot(block.handle)] = None

    def _empty(self, block: CdsBlock) -> None:
        """Free the bytes of a block; its record stays, but only in the registry of this run."""
        self._save(self._slot(block.handle), None)
        if block.offset:
            self._free(block.offset)
        block.offset = block.size = 0

    def _free(self, offset: int) -> None:
        try:
            self._pool.put(offset)
        except CfeError as error:  # a damaged block is lost until the next power-on
            text = f"Failed to free CDS Mem Block (Handle=0x{offset:08X})(Stat={error.hex})"
            self._log(f"CFE_ES_DeleteCDS: {text}")

    def _save(self, slot: int, block: CdsBlock | None) -> None:
        record = FREE_RECORD if block is None else pack(block)
        self._psp.write_to_cds(record, _REGISTRY_AT + slot * RECORD.size)


class CdsHandle(int):
    """A CDS handle: an int with the status of CFE_ES_RegisterCDS.

    Attributes:
        status: CFE_SUCCESS for a new block, CFE_ES_CDS_ALREADY_EXISTS for a block that may hold earlier data.
    """

    status: int = CFE_SUCCESS

    @classmethod
    def with_status(cls, handle: int, status: int) -> CdsHandle:
        """Return a handle with its status."""
        made = cls(handle)
        made.status = status
        return made


class CdsApi(EsCore):
    """The CDS part of Executive Services."""

    cds: CriticalDataStore | None = None

    def cds_early_init(self) -> None:
        """Find or create the CDS, before any task runs (CFE_ES_CDS_EarlyInit).

        Raises:
            CfeError: CFE_STATUS_EXTERNAL_RESOURCE_FAIL if the board has too little RAM.
        """
        self.ports.memory.claim("CFE_ES", "CDS", self.psp.get_cds_size())
        self.cds = CriticalDataStore(self.psp, self.config.es_cds_max_num_entries, self.write_to_sys_log)
        self.cds.early_init()

    def register_cds(self, block_size: int, name: str) -> CdsHandle:
        """Reserve a block for the calling application, or find its block from before a reset (CFE_ES_RegisterCDS).

        Args:
            block_size: size in bytes; a size other than before creates a new block.
            name: at most 16 characters; the full name is "APP.name".

        Returns:
            The handle; `handle.status` is CFE_SUCCESS or CFE_ES_CDS_ALREADY_EXISTS.

        Raises:
            CfeError: CFE_ES_ERR_RESOURCEID_NOT_VALID (the caller is not an application), CFE_ES_NOT_IMPLEMENTED (there
                is no CDS), CFE_ES_CDS_INVALID_NAME, CFE_ES_CDS_INVALID_SIZE, CFE_ES_NO_RESOURCE_IDS_AVAILABLE,
                CFE_ES_ERR_MEM_BLOCK_SIZE; an event also reports the error to the ground.
        """
        app = self.app_of_caller()
        if app is None:
            self.write_to_sys_log("CFE_ES_RegisterCDS: Bad AppId context")
            raise CfeError(CFE_ES_ERR_RESOURCEID_NOT_VALID, "the caller must be a task of an application")
        try:
            return self._register(block_size, name, app.name)
        except CfeError as error:
            text = f"{app.name} Failed to Register CDS '{name}', Status={error.hex}"
            with suppress(CfeError):  # an application may register a block before it registers for events
                self.ports.evs.send_event_with_app_id(ev.CDS_REGISTER_ERR_EID, ev.ERROR, app.app_id, text)
            raise

    def _register(self, block_size: int, name: str, app_name: str) -> CdsHandle:
        if self.cds is None or not self.cds.is_available:
            self.write_to_sys_log("CFE_ES_RegisterCDS: CDS not available")
        elif not 0 < name_size(name) <= MAX_NAME_LENGTH:
            cut = name[: FULL_NAME_SIZE - 1]
            self.write_to_sys_log(f"CFE_ES_RegisterCDS: CDS Name ({cut}) is either too long, or an empty string")
            raise CfeError(CFE_ES_CDS_INVALID_NAME, f"CDS name {name!r} must have 1 to {MAX_NAME_LENGTH} characters")
        try:
            handle, status = self.register_cds_ex(block_size, f"{app_name}.{name}", critical_table=False)
            return CdsHandle.with_status(handle, status)
        except CfeError as error:
            if error.status == CFE_ES_CDS_INVALID_SIZE:
                self.write_to_sys_log(f"CFE_ES_RegisterCDS: CDS {name} has invalid size ({block_size})")
            raise

    def register_cds_ex(self, block_size: int, full_name: str, critical_table: bool) -> tuple[int, int]:
        """Reserve or find a block under its full name (CFE_ES_RegisterCDSEx).

        Args:
            block_size: bytes.
            full_name: "APP.Name".
            critical_table: whether Table Services keep a table in it.

        Returns:
            The handle, and CFE_SUCCESS or CFE_ES_CDS_ALREADY_EXISTS.

        Raises:
            CfeError: see `register_cds`.
        """
        return self._store().register(block_size, full_name, critical_table)

    def copy_to_cds(self, handle: int, data: bytes | bytearray | memoryview) -> None:
        """Save a block's data (CFE_ES_CopyToCDS).

        Args:
            handle: handle of the block.
            data: data of exactly the block's size.

        Raises:
            CfeError: CFE_ES_ERR_RESOURCEID_NOT_VALID, CFE_ES_BAD_ARGUMENT (wrong number of bytes),
                CFE_ES_POOL_BLOCK_INVALID, CFE_ES_CDS_INVALID_SIZE (the block is damaged).
        """
        self._store().write(handle, data)

    def restore_from_cds(self, handle: int) -> bytes:
        """Return a block's saved data (CFE_ES_RestoreFromCDS).

        Raises:
            CfeError: CFE_ES_ERR_RESOURCEID_NOT_VALID, CFE_ES_CDS_BLOCK_CRC_ERR (the data are damaged),
                CFE_ES_POOL_BLOCK_INVALID, CFE_ES_CDS_INVALID_SIZE (the block is damaged).
        """
        return self._store().read(handle)

    def get_cds_block_id_by_name(self, full_name: str) -> int:
        """Return the handle of a block by its full name; raises CFE_ES_ERR_NAME_NOT_FOUND
        (CFE_ES_GetCDSBlockIDByName).
        """
        return self._store().named(full_name).handle

    def get_cds_block_name(self, handle: int) -> str:
        """Return the full name of a block; raises CFE_ES_ERR_RESOURCEID_NOT_VALID (CFE_ES_GetCDSBlockName)."""
        return self._store().get(handle).name

    def delete_cds(self, full_name: str, called_by_tbl_services: bool = False) -> None:
        """Delete a block whose owner has ended (CFE_ES_DeleteCDS).

        Args:
            full_name: "APP.Name".
            called_by_tbl_services: whether TBL calls; TBL may delete only blocks of critical tables.

        Raises:
            CfeError: CFE_ES_ERR_NAME_NOT_FOUND, CFE_ES_CDS_WRONG_TYPE_ERR, CFE_ES_CDS_OWNER_ACTIVE_ERR.
        """
        store = self._store()
        block = store.named(full_name)
        if block.is_table != called_by_tbl_services:
            raise CfeError(CFE_ES_CDS_WRONG_TYPE_ERR, f"{full_name!r} is {'' if block.is_table else 'not '}a table's")
        owner = full_name.partition(".")[0]
        if self.app_named(owner) is not None:
            raise CfeError(CFE_ES_CDS_OWNER_ACTIVE_ERR, f"the owner {owner} is still running")
        store.delete(full_name)

    def cds_blocks(self) -> list[CdsBlock]:
        """Return the blocks in the CDS, in the order of its registry; an empty list without a CDS."""
        return [] if self.cds is None else list(self.cds)

    def _store(self) -> CriticalDataStore:
        if self.cds is None or not self.cds.is_available:
            raise CfeError(CFE_ES_NOT_IMPLEMENTED, "this processor has no Critical Data Store")
        return self.cds

"""Memory by address (CFE_PSP_Mem*): the table of memory ranges and what lies in them.

Ranges hold bytes here when somebody attached an area to them, as the PSP does with the retained areas and the EEPROM;
NASA's Linux PSP refuses direct RAM access, so reading and writing RAM works better here than there. May import
cfepy.status only.
"""

from __future__ import annotations

from typing import NamedTuple

from cfepy.status import (
    CFE_PSP_ERROR_ADDRESS_MISALIGNED,
    CFE_PSP_INVALID_MEM_ADDR,
    CFE_PSP_INVALID_MEM_ATTR,
    CFE_PSP_INVALID_MEM_RANGE,
    CFE_PSP_INVALID_MEM_TYPE,
    CFE_PSP_INVALID_MEM_WORDSIZE,
    OsalError,
)

MEM_RAM = 1
MEM_EEPROM = 2
MEM_ANY = 3
MEM_INVALID = 4
MEM_ATTR_WRITE = 1
MEM_ATTR_READ = 2
MEM_ATTR_READWRITE = 3
MEM_TABLE_SIZE = 10
_WORD_SIZES = (1, 2, 4)


class MemRange(NamedTuple):
    """One entry of the table (CFE_PSP_MemTable_t)."""

    memory_type: int = MEM_INVALID
    start_addr: int = 0
    size: int = 0
    word_size: int = 1
    attributes: int = MEM_ATTR_READWRITE


class AddressSpace:
    """The memory ranges of a board, and their bytes."""

    def __init__(self) -> None:
        super().__init__()
        self._ranges = [MemRange()] * MEM_TABLE_SIZE
        self._areas: dict[int, bytearray] = {}  # by number of the range

    def mem_ranges(self) -> int:
        """How many ranges the table holds (CFE_PSP_MemRanges)."""
        return MEM_TABLE_SIZE

    def mem_range_set(
        self,
        range_num: int,
        memory_type: int,
        start_addr: int,
        size: int,
        word_size: int,
        attributes: int,
        area: bytearray | None = None,
    ) -> None:
        """Define a range (CFE_PSP_MemRangeSet).

        Args:
            range_num: 0 to 9.
            memory_type: MEM_RAM or MEM_EEPROM.
            start_addr: first address.
            size: bytes.
            word_size: 1, 2 or 4.
            attributes: MEM_ATTR_READ, _WRITE or _READWRITE.
            area: the bytes that live there; None for new ones.

        Raises:
            OsalError: CFE_PSP_INVALID_MEM_RANGE, _TYPE, _WORDSIZE or _ATTR.
        """
        self._check_number(range_num)
        if memory_type not in (MEM_RAM, MEM_EEPROM):
            raise OsalError(CFE_PSP_INVALID_MEM_TYPE, f"memory type {memory_type}")
        if word_size not in _WORD_SIZES:
            raise OsalError(CFE_PSP_INVALID_MEM_WORDSIZE, f"words of {word_size} bytes")
        if attributes not in (MEM_ATTR_READ, MEM_ATTR_WRITE, MEM_ATTR_READWRITE):
            raise OsalError(CFE_PSP_INVALID_MEM_ATTR, f"memory attributes {attributes}")
        self._ranges[range_num] = MemRange(memory_type, start_addr, size, word_size, attributes)
        self._areas[range_num] = bytearray(size) if area is None else area

    def mem_range_get(self, range_num: int) -> MemRange:
        """The definition of a range (CFE_PSP_MemRangeGet), or CFE_PSP_INVALID_MEM_RANGE."""
        self._check_number(range_num)
        return self._ranges[range_num]

    def mem_validate_range(self, address: int, size: int, memory_type: int) -> None:
        """Check that a stretch of memory lies in one range of a type (CFE_PSP_MemValidateRange).

        Raises:
            OsalError: CFE_PSP_INVALID_MEM_TYPE for a bad or another type, CFE_PSP_INVALID_MEM_ADDR when it begins in
                no range, CFE_PSP_INVALID_MEM_RANGE when it ends beyond it.
        """
        if memory_type not in (MEM_RAM, MEM_EEPROM, MEM_ANY):
            raise OsalError(CFE_PSP_INVALID_MEM_TYPE, f"memory type {memory_type}")
        number = self._range_of(address)
        found = self._ranges[number]
        if size < 0 or address + size > found.start_addr + found.size:
            raise OsalError(CFE_PSP_INVALID_MEM_RANGE, f"{size} bytes at {address:#x} reach beyond range {number}")
        if memory_type not in (MEM_ANY, found.memory_type):
            raise OsalError(CFE_PSP_INVALID_MEM_TYPE, f"{address:#x} is of type {found.memory_type}")

    def mem_read8(self, address: int) -> int:
        """The byte at an address (CFE_PSP_MemRead8), or CFE_PSP_INVALID_MEM_*."""
        return self._read(address, 1)

    def mem_read16(self, address: int) -> int:
        """The 16-bit word at an even address (CFE_PSP_MemRead16); also CFE_PSP_ERROR_ADDRESS_MISALIGNED."""
        return self._read(address, 2)

    def mem_read32(self, address: int) -> int:
        """The 32-bit word at an address divisible by 4 (CFE_PSP_MemRead32); also CFE_PSP_ERROR_ADDRESS_MISALIGNED."""
        return self._read(address, 4)

    def mem_write8(self, address: int, value: int) -> None:
        """Change a byte of RAM (CFE_PSP_MemWrite8), or CFE_PSP_INVALID_MEM_*."""
        self._write(address, value, 1, MEM_RAM)

    def mem_write16(self, address: int, value: int) -> None:
        """Change a 16-bit word of RAM (CFE_PSP_MemWrite16); also CFE_PSP_ERROR_ADDRESS_MISALIGNED."""
        self._write(address, value, 2, MEM_RAM)

    def mem_write32(self, address: int, value: int) -> None:
        """Change a 32-bit word of RAM (CFE_PSP_MemWrite32); also CFE_PSP_ERROR_ADDRESS_MISALIGNED."""
        self._write(address, value, 4, MEM_RAM)

    def mem_cpy(self, dest: int, src: int, size: int) -> None:
        """Copy bytes between addresses (CFE_PSP_MemCpy), or CFE_PSP_INVALID_MEM_*."""
        self._view(dest, size, is_write=True)[:] = bytes(self._view(src, size))

    def mem_set(self, dest: int, value: int, size: int) -> None:
        """Set all bytes of a stretch (CFE_PSP_MemSet), or CFE_PSP_INVALID_MEM_*."""
        self._view(dest, size, is_write=True)[:] = bytes([value & 0xFF]) * size

    def _check_number(self, range_num: int) -> None:
        if not 0 <= range_num < MEM_TABLE_SIZE:
            raise OsalError(CFE_PSP_INVALID_MEM_RANGE, f"memory range {range_num} is not 0 to {MEM_TABLE_SIZE - 1}")

    def _range_of(self, address: int) -> int:
        for number, entry in enumerate(self._ranges):
            is_used = entry.memory_type != MEM_INVALID
            if is_used and entry.start_addr <= address < entry.start_addr + entry.size:
                return number
        raise OsalError(CFE_PSP_INVALID_MEM_ADDR, f"there is no memory at {address:#x}")

    def _view(self, address: int, size: int, memory_type: int = MEM_ANY, is_write: bool = False) -> memoryview:
        self.mem_validate_range(address, size, memory_type)
        number = self._range_of(address)
        self._check_access(self._ranges[number].memory_type, is_write)
        offset = address - self._ranges[number].start_addr
        return memoryview(self._areas[number])[offset : offset + size]

    def _check_access(self, memory_type: int, is_write: bool) -> None:
        """For kinds of memory that cannot always be read or written; see `cfepy.psp.eeprom`."""

    def _read(self, address: int, size: int) -> int:
        _check_alignment(address, size)
        return int.from_bytes(self._view(address, size), "little")

    def _write(self, address: int, value: int, size: int, memory_type: int) -> None:
        _check_alignment(address, size)
        data = (value & (1 << 8 * size) - 1).to_bytes(size, "little")
        self._view(address, size, memory_type, is_write=True)[:] = data


def _check_alignment(address: int, size: int) -> None:
    if address % size:
        raise OsalError(CFE_PSP_ERROR_ADDRESS_MISALIGNED, f"{address:#x} is not divisible by {size}")

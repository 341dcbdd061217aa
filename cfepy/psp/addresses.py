"""Memory and I/O ports by address (CFE_PSP_Mem*, CFE_PSP_Eeprom*, CFE_PSP_Port*), and byte order.

A memory range holds bytes if an area is attached to it. The PSP attaches the retained areas and the EEPROM.

The profile chooses how memory is reached (`cfepy.psp.profile.MEMORIES`). With `linux`, as on NASA's Linux, one range of
RAM is all of memory, CFE_PSP_MemRead8 and its relatives are not implemented, and a wrong address of the other functions
is a fault of the caller. With `direct` these functions work, and fault as well. With `ranges` only the board's own
ranges exist, and a wrong address is a status.

EEPROM has its own write functions, and can be protected and switched off by bank. On a board with data flash both work,
and the EEPROM starts protected, as such a part does after a reset. On other boards it behaves as on NASA's Linux: a
word can be written anywhere, even at odd addresses and into RAM.

Ports are the registers of devices that the board's profile declares. A register returns the value last written by
flight software, or by a test that simulates the device (`port_areas`).

The simulated processors are little-endian, so the LE forms of CFE_PSP_HtoBE16 and its relatives change nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple, Protocol

from cfepy.psp.profile import PortRange
from cfepy.status import (
    CFE_PSP_ERROR,
    CFE_PSP_ERROR_ADDRESS_MISALIGNED,
    CFE_PSP_ERROR_NOT_IMPLEMENTED,
    CFE_PSP_ERROR_TIMEOUT,
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
NUM_EEPROM_BANKS = 1
_ADDRESSES = 1 << 64
"""cpuaddr wraps around"""
SIZE_MAX = _ADDRESSES - 1


class MemRange(NamedTuple):
    """An entry of the table (CFE_PSP_MemTable_t); an entry that was never set has zeros."""

    memory_type: int = 0
    start_addr: int = 0
    size: int = 0
    word_size: int = 0
    attributes: int = 0


class MemoryArea(Protocol):
    """The bytes of a range, such as a bytearray: read and written by slices with a start and a stop."""

    def __getitem__(self, where: slice, /) -> bytes | bytearray | memoryview:
        """Return a slice of the bytes."""

    def __setitem__(self, where: slice, data: bytes, /) -> None:
        """Replace a slice by the same number of bytes."""


class BadAddress(Exception):
    """An access to an address without memory, which a processor answers by an exception: on Linux, SIGSEGV.

    Attributes:
        ends_process: SIGSEGV ends NASA's process on Linux.
    """

    ends_process = True


class AllMemory:
    """All of memory as one area, whose first address is 0: areas of the board, and the memory of compiled code.

    Args:
        areas: the first address and the bytes of each area; asked again each time, because areas can be moved.

    Attributes:
        elsewhere: the memory outside of the areas; None for none.
    """

    def __init__(self, areas: Callable[[], Iterable[tuple[int, bytearray | memoryview]]]) -> None:
        self._areas = areas
        self.elsewhere: MemoryArea | None = None

    def __getitem__(self, where: slice, /) -> bytes | bytearray | memoryview:
        area, part = self._place(where)
        return area[part]

    def __setitem__(self, where: slice, data: bytes, /) -> None:
        area, part = self._place(where)
        area[part] = data

    def _place(self, where: slice) -> tuple[MemoryArea, slice]:
        for start, data in self._areas():
            if start <= where.start and where.stop <= start + len(data):
                return data, slice(where.start - start, where.stop - start)
        if self.elsewhere is None:
            raise BadAddress(f"SIGSEGV (invalid memory), address {where.start:#x}")
        return self.elsewhere, where


class AddressSpace:
    """The memory ranges of a board, and their bytes.

    Attributes:
        has_ram_access: whether CFE_PSP_MemRead8, CFE_PSP_MemWrite8 and their relatives are implemented.
    """

    has_ram_access = True

    def __init__(self) -> None:
        super().__init__()
        self._ranges = [MemRange()] * MEM_TABLE_SIZE
        self._areas: dict[int, MemoryArea] = {}  # by number of the range; created when needed

    def mem_ranges(self) -> int:
        """Return the number of ranges in the table (CFE_PSP_MemRanges)."""
        return MEM_TABLE_SIZE

    def mem_range_set(
        self,
        range_num: int,
        memory_type: int,
        start_addr: int,
        size: int,
        word_size: int,
        attributes: int,
        area: MemoryArea | None = None,
    ) -> None:
        """Define a range (CFE_PSP_MemRangeSet).

        Args:
            range_num: 0 to 9.
            memory_type: MEM_RAM or MEM_EEPROM.
            start_addr: first address.
            size: bytes.
            word_size: 1, 2 or 4.
            attributes: MEM_ATTR_READ, _WRITE or _READWRITE.
            area: the bytes of the range; None for new bytes.

        Raises:
            OsalError: CFE_PSP_INVALID_MEM_RANGE, _TYPE, _WORDSIZE or _ATTR.
        """
        self._check_number(range_num)
        if memory_type not in (MEM_RAM, MEM_EEPROM):
            raise OsalError(CFE_PSP_INVALID_MEM_TYPE, f"invalid memory type {memory_type}")
        if word_size not in _WORD_SIZES:
            raise OsalError(CFE_PSP_INVALID_MEM_WORDSIZE, f"invalid word size: {word_size} bytes")
        if attributes not in (MEM_ATTR_READ, MEM_ATTR_WRITE, MEM_ATTR_READWRITE):
            raise OsalError(CFE_PSP_INVALID_MEM_ATTR, f"invalid memory attributes {attributes}")
        self._ranges[range_num] = MemRange(memory_type, start_addr, size, word_size, attributes)
        self._areas.pop(range_num, None)
        if area is not None:
            self._areas[range_num] = area

    def mem_range_get(self, range_num: int) -> MemRange:
        """Return the definition of a range (CFE_PSP_MemRangeGet); raises CFE_PSP_INVALID_MEM_RANGE."""
        self._check_number(range_num)
        return self._ranges[range_num]

    def mem_validate_range(self, address: int, size: int, memory_type: int) -> None:
        """Check that a block of memory lies in one range of a type (CFE_PSP_MemValidateRange).

        Raises:
            OsalError: CFE_PSP_INVALID_MEM_TYPE for an invalid type, CFE_PSP_INVALID_MEM_RANGE if the block ends beyond
                the last address. Otherwise the error is about the last range of the table, whichever contains the
                block, as in NASA's PSP: CFE_PSP_INVALID_MEM_ADDR unless the block begins in that range.
        """
        found = self._find(address, size, memory_type)
        if isinstance(found, OsalError):
            raise found

    def mem_read8(self, address: int) -> int:
        """Return the byte at an address (CFE_PSP_MemRead8).

        Raises:
            OsalError: CFE_PSP_ERROR_NOT_IMPLEMENTED with NASA's PSP for Linux. CFE_PSP_INVALID_MEM_* on a board with
                `memory: ranges`.
            BadAddress: no memory is there, with `memory: direct`.
        """
        return self._read(address, 1)

    def mem_read16(self, address: int) -> int:
        """Return the 16-bit word at an even address (CFE_PSP_MemRead16); also CFE_PSP_ERROR_ADDRESS_MISALIGNED."""
        return self._read(address, 2)

    def mem_read32(self, address: int) -> int:
        """Return the 32-bit word at an address divisible by 4 (CFE_PSP_MemRead32); also
        CFE_PSP_ERROR_ADDRESS_MISALIGNED.
        """
        return self._read(address, 4)

    def mem_write8(self, address: int, value: int) -> None:
        """Change a byte of RAM (CFE_PSP_MemWrite8); raises CFE_PSP_INVALID_MEM_*."""
        self._write(address, value, 1, MEM_RAM)

    def mem_write16(self, address: int, value: int) -> None:
        """Change a 16-bit word of RAM (CFE_PSP_MemWrite16); also CFE_PSP_ERROR_ADDRESS_MISALIGNED."""
        self._write(address, value, 2, MEM_RAM)

    def mem_write32(self, address: int, value: int) -> None:
        """Change a 32-bit word of RAM (CFE_PSP_MemWrite32); also CFE_PSP_ERROR_ADDRESS_MISALIGNED."""
        self._write(address, value, 4, MEM_RAM)

    def mem_cpy(self, dest: int, src: int, size: int) -> None:
        """Copy bytes between addresses (CFE_PSP_MemCpy); raises CFE_PSP_INVALID_MEM_* or `BadAddress`."""
        self._store(dest, self._load(src, size))

    def mem_set(self, dest: int, value: int, size: int) -> None:
        """Set all bytes of a block (CFE_PSP_MemSet); raises CFE_PSP_INVALID_MEM_* or `BadAddress`."""
        self._store(dest, bytes([value & 0xFF]) * size)

    def _check_number(self, range_num: int) -> None:
        if not 0 <= range_num < MEM_TABLE_SIZE:
            raise OsalError(
                CFE_PSP_INVALID_MEM_RANGE, f"memory range must be 0 to {MEM_TABLE_SIZE - 1}, not {range_num}"
            )

    def _range_of(self, address: int, size: int, memory_type: int) -> int:
        """Return the number of the first range that contains the whole block; the error is about the range that the
        block begins in, if there is one.
        """
        found = self._find(address, size, memory_type)
        if not isinstance(found, OsalError):
            return found
        near = (self._fit(number, address, size, memory_type) for number in range(MEM_TABLE_SIZE))
        raise next((each for each in near if each is not None and each.status != CFE_PSP_INVALID_MEM_ADDR), found)

    def _find(self, address: int, size: int, memory_type: int) -> int | OsalError:
        """Return the number of the first range that contains the whole block, otherwise NASA's error."""
        if memory_type not in (MEM_RAM, MEM_EEPROM, MEM_ANY):
            return OsalError(CFE_PSP_INVALID_MEM_TYPE, f"invalid memory type {memory_type}")
        if (address + size) % _ADDRESSES < address:
            return OsalError(CFE_PSP_INVALID_MEM_RANGE, f"{size} bytes at {address:#x} reach beyond the last address")
        problem = OsalError(CFE_PSP_INVALID_MEM_ADDR, "the table has no ranges")
        for number in range(MEM_TABLE_SIZE):
            misfit = self._fit(number, address, size, memory_type)
            if misfit is None:
                return number
            problem = misfit
        return problem

    def _fit(self, number: int, address: int, size: int, memory_type: int) -> OsalError | None:
        """Return None if a range contains a block, otherwise why not. A range that was never set is empty."""
        entry = self._ranges[number]
        end = (entry.start_addr + entry.size) % _ADDRESSES
        if not entry.start_addr <= address < end:
            return OsalError(CFE_PSP_INVALID_MEM_ADDR, f"address {address:#x} is not in memory range {number}")
        if address + size > end:
            return OsalError(CFE_PSP_INVALID_MEM_RANGE, f"{size} bytes at {address:#x} exceed memory range {number}")
        if memory_type not in (MEM_ANY, entry.memory_type):
            text = f"address {address:#x} is in memory of type {entry.memory_type}"
            return OsalError(CFE_PSP_INVALID_MEM_TYPE, text)
        return None

    def _load(self, address: int, size: int) -> bytes:
        area, where = self._place(address, size, MEM_ANY, False)
        return bytes(area[where])

    def _store(self, address: int, data: bytes, memory_type: int = MEM_ANY) -> None:
        area, where = self._place(address, len(data), memory_type, True)
        area[where] = data

    def _place(self, address: int, size: int, memory_type: int, is_write: bool) -> tuple[MemoryArea, slice]:
        number = self._range_of(address, size, memory_type)
        entry = self._ranges[number]
        self._check_access(entry.memory_type, is_write)
        if number not in self._areas:
            self._areas[number] = _new_area(entry)
        offset = address - entry.start_addr
        return self._areas[number], slice(offset, offset + size)

    def _check_access(self, memory_type: int, is_write: bool) -> None:
        """Check the access to memory that cannot always be read or written; see `cfepy.psp.addresses`."""

    def _read(self, address: int, size: int) -> int:
        self._check_ram_access()
        _check_alignment(address, size)
        return int.from_bytes(self._load(address, size), "little")

    def _check_ram_access(self) -> None:
        if not self.has_ram_access:
            raise OsalError(CFE_PSP_ERROR_NOT_IMPLEMENTED, "this PSP does not read and write RAM by address")

    def _write(self, address: int, value: int, size: int, memory_type: int) -> None:
        if memory_type == MEM_RAM:
            self._check_ram_access()
        _check_alignment(address, size)
        self._store(address, _little(value, size), memory_type)


def _little(value: int, size: int) -> bytes:
    return (value & (1 << 8 * size) - 1).to_bytes(size, "little")


def _check_alignment(address: int, size: int) -> None:
    if address % size:
        raise OsalError(CFE_PSP_ERROR_ADDRESS_MISALIGNED, f"address {address:#x} must be a multiple of {size}")


def _new_area(entry: MemRange) -> bytearray:
    """Return the bytes of a range; a range may span the whole address space, which no host has.

    Raises:
        OsalError: CFE_PSP_INVALID_MEM_ADDR if the host has no room for the bytes.
    """
    try:
        return bytearray(entry.size)
    except (MemoryError, OverflowError):
        raise OsalError(
            CFE_PSP_INVALID_MEM_ADDR, f"the memory range of {entry.size} bytes has no content in the simulation"
        ) from None


class EepromSpace(AddressSpace):
    """An address space whose EEPROM can be protected.

    Attributes:
        has_eeprom_control: whether the board has hardware that protects the EEPROM and switches it off.
        is_writable, is_powered: its state; always true without that hardware.
    """

    def __init__(self) -> None:
        super().__init__()
        self.has_eeprom_control = False
        self.is_writable = self.is_powered = True

    def protect_eeprom(self) -> None:
        """Enable the hardware that protects the EEPROM, which starts protected."""
        self.has_eeprom_control = True
        self.is_writable = False

    def eeprom_write8(self, address: int, value: int) -> None:
        """Change a byte of EEPROM (CFE_PSP_EepromWrite8).

        Raises:
            OsalError: CFE_PSP_INVALID_MEM_*; CFE_PSP_ERROR_TIMEOUT while it is protected or switched off. A board that
                cannot protect it writes to any memory, as NASA's Linux does.
        """
        self._write_eeprom(address, value, 1)

    def eeprom_write16(self, address: int, value: int) -> None:
        """Change a 16-bit word of EEPROM (CFE_PSP_EepromWrite16); also CFE_PSP_ERROR_ADDRESS_MISALIGNED.

        A board that cannot protect its EEPROM accepts odd addresses, as NASA's Linux does.
        """
        self._write_eeprom(address, value, 2)

    def eeprom_write32(self, address: int, value: int) -> None:
        """Change a 32-bit word of EEPROM (CFE_PSP_EepromWrite32); see `eeprom_write16`."""
        self._write_eeprom(address, value, 4)

    def eeprom_write_enable(self, bank: int) -> None:
        """Allow writing to the EEPROM (CFE_PSP_EepromWriteEnable).

        Args:
            bank: must be 0, the only bank.

        Raises:
            OsalError: CFE_PSP_ERROR for another bank; CFE_PSP_ERROR_NOT_IMPLEMENTED on a board that cannot protect it.
        """
        self._check_control(bank)
        self.is_writable = True

    def eeprom_write_disable(self, bank: int) -> None:
        """Protect the EEPROM (CFE_PSP_EepromWriteDisable); see `eeprom_write_enable` for the errors."""
        self._check_control(bank)
        self.is_writable = False

    def eeprom_power_up(self, bank: int) -> None:
        """Switch the EEPROM on (CFE_PSP_EepromPowerUp); no effect on a board without this hardware."""
        if self.has_eeprom_control:
            self._check_control(bank)
            self.is_powered = True

    def eeprom_power_down(self, bank: int) -> None:
        """Switch the EEPROM off (CFE_PSP_EepromPowerDown); no effect on a board without this hardware."""
        if self.has_eeprom_control:
            self._check_control(bank)
            self.is_powered = False

    def _write_eeprom(self, address: int, value: int, size: int) -> None:
        if self.has_eeprom_control:
            self._write(address, value, size, MEM_EEPROM)
        else:
            self._store(address, _little(value, size))

    def _check_control(self, bank: int) -> None:
        if not self.has_eeprom_control:
            raise OsalError(CFE_PSP_ERROR_NOT_IMPLEMENTED, "the EEPROM of this board cannot be protected")
        if not 0 <= bank < NUM_EEPROM_BANKS:
            raise OsalError(CFE_PSP_ERROR, f"invalid EEPROM bank {bank}")

    def _check_access(self, memory_type: int, is_write: bool) -> None:
        if memory_type != MEM_EEPROM:
            return
        if not self.is_powered:
            raise OsalError(CFE_PSP_ERROR_TIMEOUT, "the EEPROM is switched off")
        if is_write and not self.is_writable:
            raise OsalError(CFE_PSP_ERROR_TIMEOUT, "the EEPROM is protected; see CFE_PSP_EepromWriteEnable")


class _Area(NamedTuple):
    """A range and its bytes."""

    start: int
    data: bytearray


class PortSpace:
    """The CFE_PSP_Port* functions; `port_areas` has the bytes of every range by name."""

    def __init__(self) -> None:
        self.port_areas: dict[str, bytearray] = {}
        self._port_ranges: list[_Area] = []

    def declare_ports(self, ranges: Iterable[PortRange]) -> None:
        """Create the ports of a board, with all bits 0."""
        for declared in ranges:
            data = self.port_areas[declared.name] = bytearray(declared.size)
            self._port_ranges.append(_Area(declared.address, data))

    def port_read8(self, port_address: int) -> int:
        """Return an 8-bit register (CFE_PSP_PortRead8).

        Raises:
            OsalError: CFE_PSP_INVALID_MEM_ADDR if the port does not exist; CFE_PSP_ERROR_NOT_IMPLEMENTED on a board
                without ports, as on NASA's Linux.
        """
        return self._read_port(port_address, 1)

    def port_read16(self, port_address: int) -> int:
        """Return a 16-bit register (CFE_PSP_PortRead16); also CFE_PSP_ERROR_ADDRESS_MISALIGNED."""
        return self._read_port(port_address, 2)

    def port_read32(self, port_address: int) -> int:
        """Return a 32-bit register (CFE_PSP_PortRead32); also CFE_PSP_ERROR_ADDRESS_MISALIGNED."""
        return self._read_port(port_address, 4)

    def port_write8(self, port_address: int, value: int) -> None:
        """Set an 8-bit register (CFE_PSP_PortWrite8); see `port_read8` for the errors."""
        self._write_port(port_address, value, 1)

    def port_write16(self, port_address: int, value: int) -> None:
        """Set a 16-bit register (CFE_PSP_PortWrite16); also CFE_PSP_ERROR_ADDRESS_MISALIGNED."""
        self._write_port(port_address, value, 2)

    def port_write32(self, port_address: int, value: int) -> None:
        """Set a 32-bit register (CFE_PSP_PortWrite32); also CFE_PSP_ERROR_ADDRESS_MISALIGNED."""
        self._write_port(port_address, value, 4)

    def _read_port(self, address: int, size: int) -> int:
        return int.from_bytes(self._register(address, size), "little")

    def _write_port(self, address: int, value: int, size: int) -> None:
        self._register(address, size)[:] = _little(value, size)

    def _register(self, address: int, size: int) -> memoryview:
        if not self._port_ranges:
            raise OsalError(CFE_PSP_ERROR_NOT_IMPLEMENTED, "this board has no I/O ports")
        for start, data in self._port_ranges:
            if start <= address and address + size <= start + len(data):
                if address % size:
                    raise OsalError(
                        CFE_PSP_ERROR_ADDRESS_MISALIGNED, f"address {address:#x} must be a multiple of {size}"
                    )
                return memoryview(data)[address - start : address - start + size]
        raise OsalError(CFE_PSP_INVALID_MEM_ADDR, f"address {address:#x} is not an I/O port of {size} bytes")


def _swapped(value: int, size: int) -> int:
    return int.from_bytes(_little(value, size), "big")


def swap_16(value: int) -> int:
    """Return a 16-bit number with its bytes reversed (CFE_PSP_HtoBE16, CFE_PSP_BE16toH)."""
    return _swapped(value, 2)


def swap_32(value: int) -> int:
    """Return a 32-bit number with its bytes reversed (CFE_PSP_HtoBE32, CFE_PSP_BE32toH)."""
    return _swapped(value, 4)


def swap_64(value: int) -> int:
    """Return a 64-bit number with its bytes reversed (CFE_PSP_HtoBE64, CFE_PSP_BE64toH)."""
    return _swapped(value, 8)


def keep_16(value: int) -> int:
    """Return the lower 16 bits unchanged (CFE_PSP_HtoLE16, CFE_PSP_LE16toH)."""
    return value & 0xFFFF


def keep_32(value: int) -> int:
    """Return the lower 32 bits unchanged (CFE_PSP_HtoLE32, CFE_PSP_LE32toH)."""
    return value & 0xFFFFFFFF


def keep_64(value: int) -> int:
    """Return the lower 64 bits unchanged (CFE_PSP_HtoLE64, CFE_PSP_LE64toH)."""
    return value & 0xFFFFFFFFFFFFFFFF


def is_big_endian() -> bool:
    """Return whether the processor is big-endian (CFE_PSP_IsBigEndian)."""
    return False


def is_little_endian() -> bool:
    """Return whether the processor is little-endian (CFE_PSP_IsLittleEndian)."""
    return True

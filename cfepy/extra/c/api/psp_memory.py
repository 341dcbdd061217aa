"""CFE_PSP_Mem*, CFE_PSP_Eeprom*, CFE_PSP_Port* and the areas of the board's memory, for C.

The memory of compiled code belongs to the range of all memory, as on NASA's Linux, where a wrong address is a fault of
the caller. On a board with `memory: ranges` it is one more range of the table. While there is compiled code, the reset
area, the user reserved area and the EEPROM also lie in that memory. So C code may use their pointers, and other
applications see the same bytes. At the end of the processor their contents go to the retained memory.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from cfepy.extra.c.arena import REGION
from cfepy.extra.c.crashes import CFault
from cfepy.extra.c.guard import alignment_of
from cfepy.extra.c.memory import CMemory
from cfepy.psp import AREA_ADDRESSES, Psp
from cfepy.status import (
    CFE_PSP_ERROR,
    CFE_PSP_ERROR_NOT_IMPLEMENTED,
    CFE_PSP_INVALID_MEM_ADDR,
    CFE_PSP_INVALID_POINTER,
    OsalError,
)

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

CODE_RANGE = 3
"""The number of the range for the memory of compiled code: the next one after the board's own."""
_WORDS = 8
"""Minimum alignment of an area in bytes."""
MEM_RAM, MEM_ATTR_READWRITE, WORD = 1, 3, 4
AREA_NAMES = {"reset_area": "the reset area", "eeprom": "the EEPROM", "user_reserved": "the user reserved area"}


class RawMemory:
    """The memory of compiled code as bytes at their addresses; an access to no memory is a fault of the caller.

    Args:
        memory: of C.
    """

    def __init__(self, memory: CMemory) -> None:
        self._memory = memory

    def __getitem__(self, where: slice) -> bytes:
        return bytes(self._memory.peek(where.start, where.stop - where.start))

    def __setitem__(self, where: slice, data: bytes) -> None:
        self._memory.poke(where.start, data)


class CodeMemory:
    """The memory of compiled code as the bytes of a range.

    Args:
        memory: of C.
        base: first address of the range.
    """

    def __init__(self, memory: CMemory, base: int) -> None:
        self._memory = memory
        self._base = base

    def __getitem__(self, where: slice) -> bytes:
        try:
            return bytes(self._memory.peek(self._base + where.start, where.stop - where.start))
        except CFault as fault:
            raise OsalError(CFE_PSP_INVALID_MEM_ADDR, str(fault)) from None

    def __setitem__(self, where: slice, data: bytes) -> None:
        try:
            self._memory.poke(self._base + where.start, data)
        except CFault as fault:
            raise OsalError(CFE_PSP_INVALID_MEM_ADDR, str(fault)) from None


class SharedAreas:
    """The retained areas in the memory of compiled code.

    Args:
        c: the C side of the processor; when it ends, the areas leave its memory.
    """

    def __init__(self, c: CRuntime) -> None:
        self._psp: Psp = c.cfe.psp
        self._places: dict[str, tuple[int, int]] = {}
        for name in AREA_NAMES:
            self._psp.move_area(name, partial(self._take, c, name))
        c.at_close.append(self._leave)

    def _take(self, c: CRuntime, name: str, size: int) -> memoryview:
        pointer = c.arena.map(size)  # also with the guard, so that later memory has the same address
        if c.guard is not None:
            pointer = c.guard.take(size, AREA_NAMES[name], alignment=max(alignment_of(size), _WORDS))
        self._places[name] = pointer, size
        view: memoryview = c.memory.view(pointer, size)
        return view

    def _leave(self) -> None:
        if self._psp.all_memory is not None:
            self._psp.all_memory.elsewhere = None
        for name in AREA_NAMES:
            self._psp.move_area(name, bytearray)

    def place(self, name: str) -> tuple[int, int]:
        """Return the pointer to an area, and its size in bytes."""
        return self._places[name]

    def board_address(self, pointer: int) -> int:
        """Translate C's pointer to the address in the board's table."""
        for name, (start, size) in self._places.items():
            if start <= pointer < start + size:
                return AREA_ADDRESSES[name] + pointer - start
        return pointer

    def pointer(self, address: int) -> int:
        """Return C's pointer to the start of a range if it is one of the areas; otherwise return `address`."""
        for name, (start, _) in self._places.items():
            if AREA_ADDRESSES[name] == address:
                return start
        return address


def declare(api: Declarations, c: CRuntime) -> None:
    psp, base = c.cfe.psp, c.arena.base
    if psp.all_memory is not None:
        psp.all_memory.elsewhere = RawMemory(c.memory)
    else:
        psp.mem_range_set(CODE_RANGE, MEM_RAM, base, REGION, WORD, MEM_ATTR_READWRITE, CodeMemory(c.memory, base))
    areas = SharedAreas(c)
    _declare_areas(api, c, areas)
    _declare_ranges(api, c, areas)
    _declare_access(api, c, areas)
    _declare_eeprom(api, c, areas)
    _declare_ports(api, c)


def _declare_areas(api: Declarations, c: CRuntime, areas: SharedAreas) -> None:
    psp = c.handle.psp

    api.add("CFE_PSP_GetResetArea", "84", lambda: areas.place("reset_area"), CFE_PSP_ERROR)
    api.add("CFE_PSP_GetUserReservedArea", "84", lambda: areas.place("user_reserved"), CFE_PSP_ERROR)
    api.add("CFE_PSP_GetVolatileDiskMem", "84", lambda: (0, len(psp.get_volatile_disk_mem())), CFE_PSP_ERROR)
    api.add("CFE_PSP_GetKernelTextSegmentInfo", "~84", psp.get_kernel_text_segment_info, CFE_PSP_ERROR)
    api.add("CFE_PSP_GetCFETextSegmentInfo", "~84", psp.get_cfe_text_segment_info, CFE_PSP_ERROR)


def _declare_ranges(api: Declarations, c: CRuntime, areas: SharedAreas) -> None:
    psp = c.handle.psp

    def validate(address: int, size: int, memory_type: int) -> None:
        psp.mem_validate_range(areas.board_address(address), size, memory_type)

    def get(number: int) -> tuple[int, int, int, int, int]:
        found = psp.mem_range_get(number)
        start = areas.pointer(found.start_addr)
        return found.memory_type, start, found.size, found.word_size, found.attributes

    def define(number: int, memory_type: int, start: int, size: int, word_size: int, attributes: int) -> None:
        is_code = c.arena.base <= start and start + size <= c.arena.base + REGION
        area = CodeMemory(c.memory, start) if is_code else None
        psp.mem_range_set(number, memory_type, start, size, word_size, attributes, area)

    api.add("CFE_PSP_MemValidateRange", "QQI", validate)
    api.add("CFE_PSP_MemRanges", "", psp.mem_ranges)
    api.add("CFE_PSP_MemRangeSet", "IIQQQI", define)
    api.add("CFE_PSP_MemRangeGet", "I48884", get, CFE_PSP_INVALID_POINTER)


def _declare_access(api: Declarations, c: CRuntime, areas: SharedAreas) -> None:
    psp, at = c.handle.psp, areas.board_address

    def copy(target: int, source: int, size: int) -> None:
        psp.mem_cpy(at(target), at(source), size)

    def fill(target: int, value: int, size: int) -> None:
        psp.mem_set(at(target), value, size)

    def to_null(*_: int) -> None:
        if c.cfe.psp.all_memory is not None:
            raise CFault("bad address 0x0")

    has_access = c.cfe.psp.has_ram_access
    null = CFE_PSP_INVALID_POINTER if has_access else CFE_PSP_ERROR_NOT_IMPLEMENTED
    on_null = to_null if has_access else None
    api.add("CFE_PSP_MemRead8", "Q1", lambda address: psp.mem_read8(at(address)), null, on_null)
    api.add("CFE_PSP_MemRead16", "Q2", lambda address: psp.mem_read16(at(address)), null, on_null)
    api.add("CFE_PSP_MemRead32", "Q4", lambda address: psp.mem_read32(at(address)), null, on_null)
    api.add("CFE_PSP_MemWrite8", "QB", lambda address, value: psp.mem_write8(at(address), value))
    api.add("CFE_PSP_MemWrite16", "QH", lambda address, value: psp.mem_write16(at(address), value))
    api.add("CFE_PSP_MemWrite32", "QI", lambda address, value: psp.mem_write32(at(address), value))
    api.add("CFE_PSP_MemCpy", "PPI", copy, CFE_PSP_ERROR)
    api.add("CFE_PSP_MemSet", "PBI", fill, CFE_PSP_ERROR)


def _declare_eeprom(api: Declarations, c: CRuntime, areas: SharedAreas) -> None:
    psp, at = c.handle.psp, areas.board_address
    api.add("CFE_PSP_EepromWrite8", "QB", lambda address, value: psp.eeprom_write8(at(address), value))
    api.add("CFE_PSP_EepromWrite16", "QH", lambda address, value: psp.eeprom_write16(at(address), value))
    api.add("CFE_PSP_EepromWrite32", "QI", lambda address, value: psp.eeprom_write32(at(address), value))
    api.add("CFE_PSP_EepromWriteEnable", "I", psp.eeprom_write_enable)
    api.add("CFE_PSP_EepromWriteDisable", "I", psp.eeprom_write_disable)
    api.add("CFE_PSP_EepromPowerUp", "I", psp.eeprom_power_up)
    api.add("CFE_PSP_EepromPowerDown", "I", psp.eeprom_power_down)


def _declare_ports(api: Declarations, c: CRuntime) -> None:
    psp = c.handle.psp
    api.add("CFE_PSP_PortRead8", "$Q1", psp.port_read8, CFE_PSP_INVALID_POINTER)
    api.add("CFE_PSP_PortRead16", "$Q2", psp.port_read16, CFE_PSP_INVALID_POINTER)
    api.add("CFE_PSP_PortRead32", "$Q4", psp.port_read32, CFE_PSP_INVALID_POINTER)
    api.add("CFE_PSP_PortWrite8", "QB", psp.port_write8)
    api.add("CFE_PSP_PortWrite16", "QH", psp.port_write16)
    api.add("CFE_PSP_PortWrite32", "QI", psp.port_write32)

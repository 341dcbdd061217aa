"""Memory by address: ranges, reading and writing, EEPROM that outlives every reset, hardware that is not there."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from cfepy.psp import Retained
from cfepy.psp.addresses import (
    MEM_ANY,
    MEM_ATTR_READWRITE,
    MEM_EEPROM,
    MEM_INVALID,
    MEM_RAM,
    AddressSpace,
    MemRange,
)
from cfepy.status import (
    CFE_PSP_ERROR_ADDRESS_MISALIGNED,
    CFE_PSP_ERROR_NOT_IMPLEMENTED,
    CFE_PSP_INVALID_MEM_ADDR,
    CFE_PSP_INVALID_MEM_ATTR,
    CFE_PSP_INVALID_MEM_RANGE,
    CFE_PSP_INVALID_MEM_TYPE,
    CFE_PSP_INVALID_MEM_WORDSIZE,
    OsalError,
)
from tests.psp.test_psp import Board

RAM, EEPROM = 0x1000, 0x8000


@pytest.fixture
def memory() -> AddressSpace:
    """64 bytes of RAM and 32 of EEPROM."""
    made = AddressSpace()
    made.mem_range_set(0, MEM_RAM, RAM, 64, 4, MEM_ATTR_READWRITE)
    made.mem_range_set(5, MEM_EEPROM, EEPROM, 32, 4, MEM_ATTR_READWRITE)
    return made


def _status(call: Callable[[], object]) -> int:
    with pytest.raises(OsalError) as caught:
        call()
    return caught.value.status


def test_words_are_little_endian(memory: AddressSpace) -> None:
    memory.mem_write32(RAM, 0x12345678)
    memory.mem_write16(RAM + 4, 0xABCD)
    memory.mem_write8(RAM + 6, 0x1EF)
    assert memory.mem_read8(RAM) == 0x78
    assert memory.mem_read16(RAM + 2) == 0x1234
    assert memory.mem_read32(RAM + 4) == 0x00EFABCD


def test_copy_and_set(memory: AddressSpace) -> None:
    memory.mem_set(RAM, 0xAA, 8)
    memory.mem_cpy(RAM + 4, RAM + 6, 4)
    memory.mem_cpy(EEPROM, RAM, 8)
    assert memory.mem_read32(EEPROM + 4) == 0x0000AAAA


def test_eeprom_is_written_by_its_own_functions(memory: AddressSpace) -> None:
    memory.eeprom_write32(EEPROM, 0x01020304)
    memory.eeprom_write16(EEPROM + 4, 0x0506)
    memory.eeprom_write8(EEPROM + 6, 7)
    assert memory.mem_read32(EEPROM + 4) == 0x00070506
    assert _status(lambda: memory.mem_write8(EEPROM, 1)) == CFE_PSP_INVALID_MEM_TYPE
    assert _status(lambda: memory.eeprom_write8(RAM, 1)) == CFE_PSP_INVALID_MEM_TYPE


@pytest.mark.parametrize(
    ("address", "size", "memory_type", "status"),
    [
        (RAM - 1, 4, MEM_ANY, CFE_PSP_INVALID_MEM_ADDR),
        (RAM + 64, 1, MEM_ANY, CFE_PSP_INVALID_MEM_ADDR),
        (RAM + 62, 4, MEM_ANY, CFE_PSP_INVALID_MEM_RANGE),
        (RAM, 4, MEM_EEPROM, CFE_PSP_INVALID_MEM_TYPE),
        (RAM, 4, MEM_INVALID, CFE_PSP_INVALID_MEM_TYPE),
    ],
)
def test_invalid_ranges(memory: AddressSpace, address: int, size: int, memory_type: int, status: int) -> None:
    assert _status(lambda: memory.mem_validate_range(address, size, memory_type)) == status


def test_bad_definitions(memory: AddressSpace) -> None:
    def define(number: int = 1, kind: int = MEM_RAM, word: int = 4, attributes: int = 3) -> None:
        memory.mem_range_set(number, kind, 0, 8, word, attributes)

    assert _status(lambda: define(number=10)) == CFE_PSP_INVALID_MEM_RANGE
    assert _status(lambda: define(kind=MEM_ANY)) == CFE_PSP_INVALID_MEM_TYPE
    assert _status(lambda: define(word=3)) == CFE_PSP_INVALID_MEM_WORDSIZE
    assert _status(lambda: define(attributes=0)) == CFE_PSP_INVALID_MEM_ATTR
    assert _status(lambda: memory.mem_range_get(10)) == CFE_PSP_INVALID_MEM_RANGE
    assert memory.mem_range_get(0) == MemRange(MEM_RAM, RAM, 64, 4, 3)
    assert memory.mem_range_get(1).memory_type == MEM_INVALID
    assert memory.mem_ranges() == 10


def test_words_must_be_aligned(memory: AddressSpace) -> None:
    assert _status(lambda: memory.mem_read16(RAM + 1)) == CFE_PSP_ERROR_ADDRESS_MISALIGNED
    assert _status(lambda: memory.mem_write32(RAM + 2, 0)) == CFE_PSP_ERROR_ADDRESS_MISALIGNED


def test_the_eeprom_of_a_board_outlives_a_power_on_reset() -> None:
    retained = Retained(eeprom_bytes=64)
    for written in (0, 99):
        board = Board(retained)
        with board.kernel:
            board.psp.boot(2)
            eeprom = board.psp.mem_range_get(1)
            assert (eeprom.memory_type, eeprom.size) == (MEM_EEPROM, 64)
            assert board.psp.mem_read8(eeprom.start_addr) == written
            board.psp.eeprom_power_up(0)
            board.psp.eeprom_write8(eeprom.start_addr, 99)
            board.psp.eeprom_power_down(0)


def test_absent_hardware_says_so() -> None:
    board = Board()
    with board.kernel:
        assert _status(lambda: board.psp.port_read8(0)) == CFE_PSP_ERROR_NOT_IMPLEMENTED
        assert _status(lambda: board.psp.eeprom_write_enable(0)) == CFE_PSP_ERROR_NOT_IMPLEMENTED

"""Memory by address: ranges, reading and writing, EEPROM that survives every reset, missing hardware."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from cfepy.psp import AREA_ADDRESSES, BadAddress, BoardProfile, Retained
from cfepy.psp.addresses import (
    MEM_ANY,
    MEM_ATTR_READWRITE,
    MEM_EEPROM,
    MEM_INVALID,
    MEM_RAM,
    EepromSpace,
    MemRange,
)
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
from tests.psp.test_psp import Board

RAM, EEPROM = 0x1000, 0x8000


@pytest.fixture
def memory() -> EepromSpace:
    """64 bytes of RAM and 32 of EEPROM."""
    made = EepromSpace()
    made.mem_range_set(0, MEM_RAM, RAM, 64, 4, MEM_ATTR_READWRITE)
    made.mem_range_set(5, MEM_EEPROM, EEPROM, 32, 4, MEM_ATTR_READWRITE)
    return made


def _status(call: Callable[[], object]) -> int:
    with pytest.raises(OsalError) as caught:
        call()
    return caught.value.status


def test_words_are_little_endian(memory: EepromSpace) -> None:
    memory.mem_write32(RAM, 0x12345678)
    memory.mem_write16(RAM + 4, 0xABCD)
    memory.mem_write8(RAM + 6, 0x1EF)
    assert memory.mem_read8(RAM) == 0x78
    assert memory.mem_read16(RAM + 2) == 0x1234
    assert memory.mem_read32(RAM + 4) == 0x00EFABCD


def test_copy_and_set(memory: EepromSpace) -> None:
    memory.mem_set(RAM, 0xAA, 8)
    memory.mem_cpy(RAM + 4, RAM + 6, 4)
    memory.mem_cpy(EEPROM, RAM, 8)
    assert memory.mem_read32(EEPROM + 4) == 0x0000AAAA


def test_range_allocates_its_bytes_on_demand(memory: EepromSpace) -> None:
    memory.mem_range_set(5, MEM_RAM, 1 << 20, 1 << 62, 4, MEM_ATTR_READWRITE)
    memory.mem_validate_range(1 << 60, 4, MEM_RAM)
    with pytest.raises(OsalError) as caught:
        memory.mem_read8(1 << 60)
    assert caught.value.status == CFE_PSP_INVALID_MEM_ADDR
    memory.mem_range_set(5, MEM_RAM, 1 << 20, 16, 4, MEM_ATTR_READWRITE)
    memory.mem_write8(1 << 20, 7)
    assert memory.mem_read8(1 << 20) == 7


def test_area_of_the_retained_memory_can_be_moved() -> None:
    board = Board(profile=BoardProfile("test"))
    board.psp.boot()
    psp, places = board.psp, []
    address = psp.mem_range_get(2).start_addr
    psp.mem_write8(address + 1, 5)

    def make(size: int) -> memoryview:
        places.append(bytearray(size))
        return memoryview(places[0])

    psp.move_area("user_reserved", make)
    assert places[0][1] == 5
    places[0][2] = 6
    assert psp.get_user_reserved_area()[:3] == b"\0\5\6"
    psp.mem_write8(address, 4)
    assert places[0][0] == 4
    psp.move_area("user_reserved", bytearray)
    places[0][0] = 0
    assert psp.mem_read8(address) == 4


def test_eeprom_is_written_only_by_its_own_functions(memory: EepromSpace) -> None:
    memory.eeprom_write32(EEPROM, 0x01020304)
    memory.eeprom_write16(EEPROM + 4, 0x0506)
    memory.eeprom_write8(EEPROM + 6, 7)
    assert memory.mem_read32(EEPROM + 4) == 0x00070506
    assert _status(lambda: memory.mem_write8(EEPROM, 1)) == CFE_PSP_INVALID_MEM_TYPE


def test_unprotected_eeprom_is_written_anywhere(memory: EepromSpace) -> None:
    memory.eeprom_write32(EEPROM + 1, 0x01020304)
    memory.eeprom_write16(EEPROM + 3, 0x0506)
    memory.eeprom_write16(RAM + 7, 0x0809)
    assert memory.mem_read32(EEPROM) == 0x06030400
    assert memory.mem_read8(RAM + 8) == 8
    assert _status(lambda: memory.eeprom_write32(EEPROM + 30, 1)) == CFE_PSP_INVALID_MEM_RANGE
    assert _status(lambda: memory.eeprom_write8(EEPROM + 32, 1)) == CFE_PSP_INVALID_MEM_ADDR
    memory.protect_eeprom()
    memory.eeprom_write_enable(0)
    assert _status(lambda: memory.eeprom_write16(EEPROM + 1, 1)) == CFE_PSP_ERROR_ADDRESS_MISALIGNED
    assert _status(lambda: memory.eeprom_write32(EEPROM + 2, 1)) == CFE_PSP_ERROR_ADDRESS_MISALIGNED
    assert _status(lambda: memory.eeprom_write8(RAM, 1)) == CFE_PSP_INVALID_MEM_TYPE


def test_addresses_wrap_around() -> None:
    space = EepromSpace()
    highest = (1 << 64) - 16
    space.mem_range_set(0, MEM_RAM, highest, 32, 4, MEM_ATTR_READWRITE)
    assert _status(lambda: space.mem_validate_range(highest, 8, MEM_RAM)) == CFE_PSP_INVALID_MEM_ADDR
    space.mem_range_set(0, MEM_RAM, highest, 15, 4, MEM_ATTR_READWRITE)
    space.mem_validate_range(highest, 15, MEM_RAM)
    assert _status(lambda: space.mem_validate_range(highest - 1, 17, MEM_RAM)) == CFE_PSP_INVALID_MEM_RANGE
    assert _status(lambda: space.mem_validate_range(highest, (1 << 64) - 1, MEM_RAM)) == CFE_PSP_INVALID_MEM_RANGE


@pytest.mark.parametrize(
    ("address", "size", "memory_type", "status"),
    [
        (RAM - 1, 4, MEM_ANY, CFE_PSP_INVALID_MEM_ADDR),
        (RAM + 64, 1, MEM_ANY, CFE_PSP_INVALID_MEM_ADDR),
        (RAM + 62, 4, MEM_ANY, CFE_PSP_INVALID_MEM_ADDR),
        (RAM, 4, MEM_EEPROM, CFE_PSP_INVALID_MEM_ADDR),
        (RAM, 4, MEM_INVALID, CFE_PSP_INVALID_MEM_TYPE),
    ],
)
def test_invalid_ranges(memory: EepromSpace, address: int, size: int, memory_type: int, status: int) -> None:
    assert _status(lambda: memory.mem_validate_range(address, size, memory_type)) == status


def test_invalid_definitions_are_refused(memory: EepromSpace) -> None:
    def define(number: int = 1, kind: int = MEM_RAM, word: int = 4, attributes: int = 3) -> None:
        memory.mem_range_set(number, kind, 0, 8, word, attributes)

    assert _status(lambda: define(number=10)) == CFE_PSP_INVALID_MEM_RANGE
    assert _status(lambda: define(kind=MEM_ANY)) == CFE_PSP_INVALID_MEM_TYPE
    assert _status(lambda: define(word=3)) == CFE_PSP_INVALID_MEM_WORDSIZE
    assert _status(lambda: define(attributes=0)) == CFE_PSP_INVALID_MEM_ATTR
    assert _status(lambda: memory.mem_range_get(10)) == CFE_PSP_INVALID_MEM_RANGE
    assert memory.mem_range_get(0) == MemRange(MEM_RAM, RAM, 64, 4, 3)
    assert memory.mem_range_get(1) == MemRange(0, 0, 0, 0, 0)
    assert memory.mem_ranges() == 10


def test_words_must_be_aligned(memory: EepromSpace) -> None:
    assert _status(lambda: memory.mem_read16(RAM + 1)) == CFE_PSP_ERROR_ADDRESS_MISALIGNED
    assert _status(lambda: memory.mem_write32(RAM + 2, 0)) == CFE_PSP_ERROR_ADDRESS_MISALIGNED


def test_eeprom_survives_a_power_on_reset() -> None:
    retained = Retained(eeprom_bytes=64)
    for written in (0, 99):
        board = Board(retained, BoardProfile("test"))
        with board.kernel:
            board.psp.boot(2)
            eeprom = board.psp.mem_range_get(1)
            assert (eeprom.memory_type, eeprom.size) == (MEM_EEPROM, 64)
            assert board.psp.mem_read8(eeprom.start_addr) == written
            board.psp.eeprom_power_up(0)
            board.psp.eeprom_write8(eeprom.start_addr, 99)
            board.psp.eeprom_power_down(0)


def test_absent_hardware_is_reported() -> None:
    board = Board()
    with board.kernel:
        assert _status(lambda: board.psp.port_read8(0)) == CFE_PSP_ERROR_NOT_IMPLEMENTED
        assert _status(lambda: board.psp.eeprom_write_enable(0)) == CFE_PSP_ERROR_NOT_IMPLEMENTED
        assert _status(board.psp.get_kernel_text_segment_info) == CFE_PSP_ERROR_NOT_IMPLEMENTED
        assert _status(board.psp.get_cfe_text_segment_info) == CFE_PSP_ERROR_NOT_IMPLEMENTED
        assert _status(lambda: board.psp.init_ssr(1, 2, "SSR")) == CFE_PSP_ERROR
        assert len(board.psp.get_volatile_disk_mem()) == 0
        board.psp.flush_caches(1, RAM, 4)
        assert board.console.lines == ["CFE_PSP_FlushCaches called -- Currently no Linux/OSX/Cygwin implementation"]


def test_eeprom_that_can_be_protected() -> None:
    board = Board(profile=BoardProfile("flash", data_flash=64))
    with board.kernel:
        psp = board.psp
        psp.boot()
        eeprom = psp.mem_range_get(1).start_addr
        assert psp.mem_range_get(1).size == 64

        def writes() -> list[int]:
            return [
                _status_or_0(call)
                for call in (
                    lambda: psp.eeprom_write8(eeprom, 1),
                    lambda: psp.mem_set(eeprom, 2, 4),
                    lambda: psp.mem_cpy(eeprom, psp.mem_range_get(0).start_addr, 4),
                )
            ]

        assert writes() == [CFE_PSP_ERROR_TIMEOUT] * 3
        assert psp.mem_read32(eeprom) == 0
        psp.eeprom_write_enable(0)
        assert writes() == [0] * 3
        psp.eeprom_write16(eeprom + 2, 7)
        psp.eeprom_write_disable(0)
        assert writes() == [CFE_PSP_ERROR_TIMEOUT] * 3
        psp.eeprom_write_enable(0)
        psp.eeprom_power_down(0)
        assert writes() == [CFE_PSP_ERROR_TIMEOUT] * 3
        assert _status(lambda: psp.mem_read8(eeprom)) == CFE_PSP_ERROR_TIMEOUT
        psp.eeprom_power_up(0)
        assert psp.mem_read16(eeprom + 2) == 7
        for function in ("write_enable", "write_disable", "power_up", "power_down"):
            assert _status(lambda name=function: getattr(psp, f"eeprom_{name}")(1)) == CFE_PSP_ERROR


def _status_or_0(call: Callable[[], object]) -> int:
    try:
        call()
    except OsalError as error:
        return error.status
    return 0


def test_access_must_be_valid_in_one_of_overlapping_ranges() -> None:
    # as NASA's Linux has it: a range of RAM that is all memory, and the EEPROM in it
    space = EepromSpace()
    space.mem_range_set(0, MEM_RAM, 0, 0x10000, 4, MEM_ATTR_READWRITE)
    space.mem_range_set(1, MEM_EEPROM, 0x1000, 0x100, 4, MEM_ATTR_READWRITE)
    for kind in (MEM_RAM, MEM_EEPROM, MEM_ANY):
        space.mem_validate_range(0x1080, 4, kind)
    assert _status(lambda: space.mem_validate_range(0x1080, 0x100, MEM_EEPROM)) == CFE_PSP_INVALID_MEM_ADDR


def test_the_last_range_of_the_table_decides_the_error(memory: EepromSpace) -> None:
    memory.mem_range_set(9, MEM_RAM, RAM, 64, 4, MEM_ATTR_READWRITE)
    assert _status(lambda: memory.mem_validate_range(RAM, 65, MEM_ANY)) == CFE_PSP_INVALID_MEM_RANGE
    assert _status(lambda: memory.mem_validate_range(RAM, 64, MEM_EEPROM)) == CFE_PSP_INVALID_MEM_TYPE
    assert _status(lambda: memory.mem_validate_range(EEPROM, 4, MEM_RAM)) == CFE_PSP_INVALID_MEM_ADDR


def test_all_of_memory_is_ram_on_linux_and_none_is_read_by_address() -> None:
    board = Board(profile=BoardProfile("test", memory="linux"))
    board.psp.boot()
    psp = board.psp
    assert psp.mem_range_get(0) == MemRange(MEM_RAM, 0, (1 << 64) - 1, 4, 3)
    assert psp.mem_range_get(2) == MemRange()
    for address in (0, 16, 1 << 63, psp.mem_range_get(1).start_addr):
        psp.mem_validate_range(address, 4, MEM_RAM)
    for call in (psp.mem_read8, psp.mem_read16, psp.mem_read32):
        assert _status(lambda call=call: call(1)) == CFE_PSP_ERROR_NOT_IMPLEMENTED  # type: ignore[misc]
    for write in (psp.mem_write8, psp.mem_write16, psp.mem_write32):
        assert _status(lambda write=write: write(1, 1)) == CFE_PSP_ERROR_NOT_IMPLEMENTED  # type: ignore[misc]


@pytest.mark.parametrize("kind", ["linux", "direct"])
def test_an_address_without_memory_is_a_fault_on_linux(kind: str) -> None:
    board = Board(profile=BoardProfile("test", memory=kind))
    board.psp.boot()
    psp, eeprom, user = board.psp, AREA_ADDRESSES["eeprom"], AREA_ADDRESSES["user_reserved"]
    psp.mem_set(eeprom, 7, 4)
    psp.mem_cpy(user + 8, eeprom + 2, 4)
    psp.eeprom_write16(user + 1, 0x0506)
    assert bytes(psp.get_user_reserved_area()[:12]) == bytes([0, 6, 5, 0, 0, 0, 0, 0, 7, 7, 0, 0])
    for call in (
        lambda: psp.mem_set(16, 1, 4),
        lambda: psp.mem_cpy(user, 16, 4),
        lambda: psp.mem_cpy(16, user, 4),
        lambda: psp.eeprom_write8(16, 1),
        lambda: psp.mem_set(eeprom - 1, 1, 2),
    ):
        with pytest.raises(BadAddress, match="SIGSEGV"):
            call()


def test_ram_is_read_and_written_by_address_with_ram_direct() -> None:
    board = Board(profile=BoardProfile("test", memory="direct"))
    board.psp.boot()
    psp, user = board.psp, AREA_ADDRESSES["user_reserved"]
    assert "CFE_PSP: Using DIRECT memory mapped RAM implementation" in board.console.lines
    psp.mem_write16(user, 0x0102)
    psp.mem_write8(AREA_ADDRESSES["eeprom"], 3)
    assert (psp.mem_read32(user), psp.mem_read8(AREA_ADDRESSES["eeprom"])) == (0x0102, 3)
    assert _status(lambda: psp.mem_read16(user + 1)) == CFE_PSP_ERROR_ADDRESS_MISALIGNED
    with pytest.raises(BadAddress):
        psp.mem_read8(0)

"""I/O ports, on a board that declares some."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from cfepy.psp import BoardProfile, Psp, load_profile
from cfepy.psp.profile import PortRange
from cfepy.status import CFE_PSP_ERROR_ADDRESS_MISALIGNED, CFE_PSP_INVALID_MEM_ADDR, OsalError, UsageError
from tests.psp.test_psp import Board

GPIO, UART = 0x8C000, 0x8A000


@pytest.fixture
def psp() -> Iterator[Psp]:
    """A board with two devices."""
    ports = (PortRange("gpio", GPIO, 8), PortRange("uart", UART, 4))
    board = Board(profile=BoardProfile("ports", ports=ports))
    with board.kernel:
        yield board.psp


def test_register_has_the_written_value(psp: Psp) -> None:
    psp.port_write32(GPIO, 0x1_0403_0201)
    psp.port_write16(GPIO + 2, 0xBBAA)
    psp.port_write8(UART + 3, 0x1FF)
    assert psp.port_read32(GPIO) == 0xBBAA0201
    assert psp.port_read16(GPIO) == 0x0201
    assert psp.port_read8(UART + 3) == 0xFF


def test_code_can_simulate_the_device(psp: Psp) -> None:
    psp.port_areas["uart"][0] = ord("!")
    assert psp.port_read8(UART) == ord("!")
    psp.port_write8(UART + 1, 9)
    assert psp.port_areas["uart"][1] == 9


@pytest.mark.parametrize("address", [0, GPIO - 1, GPIO + 8, UART + 4])
def test_address_without_a_port_is_refused(psp: Psp, address: int) -> None:
    with pytest.raises(OsalError) as caught:
        psp.port_read8(address)
    assert caught.value.status == CFE_PSP_INVALID_MEM_ADDR


def test_access_that_is_misaligned_or_beyond_the_end_is_refused(psp: Psp) -> None:
    with pytest.raises(OsalError) as caught:
        psp.port_write16(GPIO + 1, 0)
    assert caught.value.status == CFE_PSP_ERROR_ADDRESS_MISALIGNED
    with pytest.raises(OsalError) as caught:
        psp.port_read32(GPIO + 6)
    assert caught.value.status == CFE_PSP_INVALID_MEM_ADDR


def test_boot_reports_ports_on_the_console(psp: Psp) -> None:
    psp.boot()
    assert "CFE_PSP: Using DIRECT memory mapped PORT implementation" in psp.console.lines
    assert "CFE_PSP: I/O Port access not implemented" not in psp.console.lines


def test_a_profile_declares_ports(tmp_path: Path) -> None:
    file = tmp_path / "board.yaml"
    file.write_text("name: b\nports:\n  - {name: gpio, address: 0x8C000, size: 1 KiB}\n", encoding="utf-8")
    assert load_profile(file).ports == (PortRange("gpio", GPIO, 1024),)
    file.write_text("name: b\nports:\n  - {name: gpio, size: 64}\n", encoding="utf-8")
    with pytest.raises(UsageError, match="missing address"):
        load_profile(file)

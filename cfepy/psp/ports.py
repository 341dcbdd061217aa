"""I/O ports by address (CFE_PSP_Port*): registers of devices, as far as the board's profile declares some.

A register reads what was written to it last, by flight software or by a test that plays the device (`port_areas`). May
import cfepy.psp.profile and cfepy.status only.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from cfepy.psp.profile import PortRange
from cfepy.status import (
    CFE_PSP_ERROR_ADDRESS_MISALIGNED,
    CFE_PSP_ERROR_NOT_IMPLEMENTED,
    CFE_PSP_INVALID_MEM_ADDR,
    OsalError,
)


class _Area(NamedTuple):
    """A range and its bytes."""

    start: int
    data: bytearray


class PortSpace:
    """The CFE_PSP_Port* functions; `port_areas` has the bytes of every range by its name."""

    def __init__(self) -> None:
        self.port_areas: dict[str, bytearray] = {}
        self._port_ranges: list[_Area] = []

    def declare_ports(self, ranges: Iterable[PortRange]) -> None:
        """Make the ports of a board; all their bits are 0."""
        for declared in ranges:
            data = self.port_areas[declared.name] = bytearray(declared.size)
            self._port_ranges.append(_Area(declared.address, data))

    def port_read8(self, port_address: int) -> int:
        """An 8-bit register (CFE_PSP_PortRead8).

        Raises:
            OsalError: CFE_PSP_INVALID_MEM_ADDR when there is no such port; CFE_PSP_ERROR_NOT_IMPLEMENTED on a board
                without ports, as on NASA's Linux.
        """
        return self._read_port(port_address, 1)

    def port_read16(self, port_address: int) -> int:
        """A 16-bit register (CFE_PSP_PortRead16); also CFE_PSP_ERROR_ADDRESS_MISALIGNED."""
        return self._read_port(port_address, 2)

    def port_read32(self, port_address: int) -> int:
        """A 32-bit register (CFE_PSP_PortRead32); also CFE_PSP_ERROR_ADDRESS_MISALIGNED."""
        return self._read_port(port_address, 4)

    def port_write8(self, port_address: int, value: int) -> None:
        """Set an 8-bit register (CFE_PSP_PortWrite8); errors as `port_read8`."""
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
        self._register(address, size)[:] = (value & (1 << 8 * size) - 1).to_bytes(size, "little")

    def _register(self, address: int, size: int) -> memoryview:
        if not self._port_ranges:
            raise OsalError(CFE_PSP_ERROR_NOT_IMPLEMENTED, "this board has no I/O ports")
        for start, data in self._port_ranges:
            if start <= address and address + size <= start + len(data):
                if address % size:
                    raise OsalError(CFE_PSP_ERROR_ADDRESS_MISALIGNED, f"{address:#x} is not divisible by {size}")
                return memoryview(data)[address - start : address - start + size]
        raise OsalError(CFE_PSP_INVALID_MEM_ADDR, f"there is no port of {size} bytes at {address:#x}")

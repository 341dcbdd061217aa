"""The devices of the sensor application."""

from __future__ import annotations

from cfepy.extra.c import Device


class Receiver(Device):
    """Answers each message on a serial port with its bytes in capital letters, and the time in s."""

    def __init__(self) -> None:
        self._answers = b""

    def write(self, data: bytes) -> None:
        self._answers += data.upper() + f"{self.clock():.1f}".encode()

    def read(self, count: int) -> bytes:
        data, self._answers = self._answers[:count], self._answers[count:]
        return data

    def waiting(self) -> int:
        return len(self._answers)


class Magnetometer(Device):
    """An I2C device with registers: the address is written, and the values from there are read."""

    def __init__(self) -> None:
        self._registers = bytes(range(0x40))
        self._at = 0

    def write(self, data: bytes) -> None:
        self._at = data[0]

    def read(self, count: int) -> bytes:
        return self._registers[self._at : self._at + count]


class Inverter(Device):
    """A device on SPI that inverts all bits."""

    def transfer(self, data: bytes) -> bytes:
        return bytes(~each & 0xFF for each in data)


class Echo(Device):
    """Gives back the bytes that it was written, once."""

    def __init__(self) -> None:
        self._kept = b""

    def write(self, data: bytes) -> None:
        self._kept = data

    def read(self, count: int) -> bytes:
        data, self._kept = self._kept, b""
        return data[:count]

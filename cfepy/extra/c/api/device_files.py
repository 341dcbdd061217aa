"""Device files that `devices:` connects, behind POSIX's descriptors, and tcsetattr and related functions.

A read waits as on Linux: for the first byte, for VTIME, or not at all.
"""

from __future__ import annotations

import errno
from struct import Struct
from typing import TYPE_CHECKING

from cfepy.extra.c.api.posix_calls import FAILED, PosixCalls
from cfepy.extra.c.devices import I2C, Device, DevicePorts
from cfepy.extra.c.posix.open_descriptors import O_RDWR, POLLIN, POLLOUT, Descriptor, failure
from cfepy.units import NS_PER_MS

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.memory import CMemory
    from cfepy.extra.c.runtime import CRuntime

I2C_SLAVE, I2C_SLAVE_FORCE, I2C_RDWR = 0x0703, 0x0706, 0x0707
SPI_MAGIC, SPI_MESSAGE, SPI_SIZE = 0x6B, 0, 32
I2C_READ = 1
I2C_MESSAGE, I2C_DATA = Struct("<HHH2xQ"), Struct("<QI")
SPI_TRANSFER = Struct("<QQI12x")
TERMIOS = 60
VTIME, VMIN = 17 + 5, 17 + 6
"""Offsets of c_cc[VTIME] and c_cc[VMIN] in struct termios."""
SPEEDS = 52
"""Offset of c_ispeed and c_ospeed."""
RAW = bytes(TERMIOS - 8)
TENTH_NS = 100 * NS_PER_MS
_LOOK_NS = 10 * NS_PER_MS


class OpenDevice(Descriptor):
    """An open device file.

    Args:
        c: the C side of the processor.
        device: the device; None for an I2C bus, whose devices have addresses.
        bus: number of the I2C bus; -1 for none.
        flags: the flags of open.
    """

    announces_nothing = True

    def __init__(self, c: CRuntime, device: Device | None, bus: int, flags: int = O_RDWR) -> None:
        super().__init__(flags)
        self._c = c
        self._ports: DevicePorts = c.devices
        self.device = device
        self._bus = bus
        self.options = bytearray(TERMIOS)
        self.options[VMIN] = 1
        self._settings: dict[int, bytes] = {}

    @property
    def is_terminal(self) -> bool:  # type: ignore[override]
        """Whether it is a serial port, or may be one."""
        return self._bus == FAILED

    def read(self, count: int) -> bytes:
        device = self._reached()
        if self._bus != FAILED:
            return i2c_bytes(device, count)
        if self.is_nonblocking:
            data = device.read(count)[:count]
            if not data:
                raise failure(errno.EAGAIN)
            return data
        wait_ns = None if self.options[VMIN] else self.options[VTIME] * TENTH_NS
        return awaited(self._c, device, count, wait_ns)

    def write(self, data: bytes) -> int:
        self._reached().write(data)
        return len(data)

    def _reached(self) -> Device:
        if self.device is None:
            raise failure(errno.EREMOTEIO)
        return self.device

    @property
    def events(self) -> int:
        is_ready = self.device is None or self._bus != FAILED or self.device.waiting() > 0
        return POLLIN | POLLOUT if is_ready else POLLOUT

    def waiting(self) -> int:
        if self.device is None:
            raise failure(errno.ENOTTY)
        return self.device.waiting()

    def control(self, request: int, argument: int) -> int:
        memory = self._c.memory
        if self._bus != FAILED and request in (I2C_SLAVE, I2C_SLAVE_FORCE):
            self.device = self._ports.i2c(self._bus, argument)
            return 0
        if self._bus != FAILED and request == I2C_RDWR:
            count = i2c_messages(memory, self._ports, self._bus, argument)
            if count is None:
                raise failure(errno.EREMOTEIO)
            return count
        if request >> 8 & 0xFF == SPI_MAGIC and self.device is not None:
            return self._spi(self.device, request, argument)
        raise failure(errno.ENOTTY)

    def _spi(self, device: Device, request: int, argument: int) -> int:
        memory, size = self._c.memory, request >> 16 & 0x3FFF
        if request & 0xFF != SPI_MESSAGE:  # mode, bits and speed have one place for writing and reading
            if request >> 30 == 1:
                self._settings[request & 0xFF] = bytes(memory.peek(argument, size))
            else:
                memory.poke(argument, self._settings.get(request & 0xFF, bytes(size)))
            return 0
        total = 0
        for at in range(argument, argument + size, SPI_SIZE):
            sent, received, count = SPI_TRANSFER.unpack(memory.peek(at, SPI_SIZE))
            answer = device.transfer(bytes(memory.peek(sent, count)) if sent else bytes(count))
            if received:
                memory.poke(received, answer[:count].ljust(count, b"\0"))
            total += count
        return total


def i2c_bytes(device: Device, count: int) -> bytes:
    """Return the bytes of a read on I2C; a device that gives fewer leaves the bus high."""
    return device.read(count)[:count].ljust(count, b"\xff")


def i2c_messages(memory: CMemory, ports: DevicePorts, bus: int, argument: int) -> int | None:
    """Perform the messages of a struct i2c_rdwr_ioctl_data.

    Args:
        memory: the memory of C.
        ports: the devices.
        bus: number of the bus.
        argument: address of the structure.

    Returns:
        The number of messages; None if there is no device at an address.
    """
    at, count = I2C_DATA.unpack(memory.peek(argument, I2C_DATA.size))
    for number in range(count):
        place = at + number * I2C_MESSAGE.size
        address, flags, size, buffer = I2C_MESSAGE.unpack(memory.peek(place, I2C_MESSAGE.size))
        device = ports.i2c(bus, address)
        if device is None:
            return None
        if flags & I2C_READ:
            memory.poke(buffer, i2c_bytes(device, size))
        else:
            device.write(bytes(memory.peek(buffer, size)))
    return int(count)


def awaited(c: CRuntime, device: Device, count: int, wait_ns: int | None) -> bytes:
    """Return up to `count` bytes of a device, and wait for the first one.

    Args:
        c: the C side of the processor.
        device: the device.
        count: most bytes.
        wait_ns: longest wait in virtual time; None for any time.
    """
    end = None if wait_ns is None else c.kernel.now + wait_ns
    data = device.read(count)[:count]
    while not data and count and (end is None or c.kernel.now < end):
        c.kernel.delay(_LOOK_NS if end is None else min(_LOOK_NS, end - c.kernel.now))
        data = device.read(count)[:count]
    return data


def declare(api: Declarations, c: CRuntime) -> None:
    calls, files, memory = PosixCalls(api, c), DeviceFiles(c), c.memory
    c.openers.append(files.opened)
    calls.add("tcgetattr", "iP", files.get_options)
    calls.add("tcsetattr", "iiP", files.set_options)
    calls.add("tcflush", "ii", files.flush)
    calls.add("tcdrain", "i", files.drain)
    for name, offsets in (("cfsetispeed", (0,)), ("cfsetospeed", (4,)), ("cfsetspeed", (0, 4))):

        def set_speed(at: int, speed: int, offsets: tuple[int, ...] = offsets) -> int:
            for offset in offsets:
                memory.put_u32(at + SPEEDS + offset, speed)
            return 0

        calls.add(name, "PI", set_speed)
    api.add("cfgetispeed", "P", lambda at: memory.u32(at + SPEEDS), 0)
    api.add("cfgetospeed", "P", lambda at: memory.u32(at + SPEEDS + 4), 0)
    calls.add("cfmakeraw", "P", lambda at: memory.poke(at, RAW))


class DeviceFiles:
    """The device files of a processor.

    Args:
        c: its C side.
    """

    def __init__(self, c: CRuntime) -> None:
        self._c = c
        self._ports: DevicePorts = c.devices

    def opened(self, path: str, flags: int, mode: int) -> Descriptor | None:
        """Open a device; returns None if the mission connects none with this name."""
        device = self._ports.find(path)
        number = path.removeprefix(I2C)
        bus = int(number) if path.startswith(I2C) and number.isdecimal() else FAILED
        if device is None and not self._ports.has_bus(bus):
            return None
        if device is not None:
            device.open()
        return OpenDevice(self._c, device, bus, flags)

    def get_options(self, descriptor: int, at: int) -> int:
        self._c.memory.poke(at, bytes(self._device(descriptor).options))
        return 0

    def set_options(self, descriptor: int, when: int, at: int) -> int:
        self._device(descriptor).options[:] = self._c.memory.peek(at, TERMIOS)
        return 0

    def flush(self, descriptor: int, queue: int) -> int:
        """Discard received bytes."""
        device = self._device(descriptor).device
        while device is not None and queue != 1 and device.waiting():
            device.read(device.waiting())
        return 0

    def drain(self, descriptor: int) -> int:
        self._device(descriptor)
        return 0

    def _device(self, descriptor: int) -> OpenDevice:
        found = self._c.descriptors.of(descriptor)
        if not isinstance(found, OpenDevice):
            raise failure(errno.ENOTTY)
        return found

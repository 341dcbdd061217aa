"""open, read, write, ioctl, tcsetattr and related functions, for the device files that `devices:` connects.

The rest of POSIX's files is absent. A read waits as on Linux: for the first byte, for VTIME, or not at all.
"""

from __future__ import annotations

import errno
import os
from struct import Struct
from typing import TYPE_CHECKING

from cfepy.extra.c.crashes import CFault
from cfepy.extra.c.devices import DEVICE_FUNCTIONS, I2C, Device, DevicePorts
from cfepy.units import NS_PER_MS

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations, Declared
    from cfepy.extra.c.memory import CMemory
    from cfepy.extra.c.runtime import CRuntime

FAILED = -1
FIRST = 900
"""The first descriptor, so that they are no files of libgcov, and that they fit an fd_set."""
F_GETFL, F_SETFL = 3, 4
FIONREAD, I2C_SLAVE, I2C_SLAVE_FORCE, I2C_RDWR = 0x541B, 0x0703, 0x0706, 0x0707
SPI_MAGIC, SPI_MESSAGE, SPI_SIZE = 0x6B, 0, 32
I2C_READ = 1
I2C_MESSAGE, I2C_DATA = Struct("<HHH2xQ"), Struct("<QI")
SPI_TRANSFER = Struct("<QQI12x")
STANDARD = 3
"""The number of standard streams."""
TERMIOS = 60
VTIME, VMIN = 17 + 5, 17 + 6
"""Offsets of c_cc[VTIME] and c_cc[VMIN] in struct termios."""
SPEEDS = 52
"""Offset of c_ispeed and c_ospeed."""
RAW = bytes(TERMIOS - 8)
TENTH_NS = 100 * NS_PER_MS
_LOOK_NS = 10 * NS_PER_MS


class OpenDevice:
    """An open device file.

    Args:
        name: its path.
        device: the device; None for an I2C bus, whose devices have addresses.
        bus: number of the I2C bus.
        flags: the flags of open.
    """

    def __init__(self, name: str, device: Device | None, bus: int, flags: int) -> None:
        self.name = name
        self.device = device
        self.bus = bus
        self.flags = flags
        self.options = bytearray(TERMIOS)
        self.options[VMIN] = 1
        self.settings: dict[int, bytes] = {}


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
    if not isinstance(c.devices, DevicePorts) or not c.devices:
        return
    files = DeviceFiles(c, c.devices, {name: api.functions[name] for name in DEVICE_FUNCTIONS if name in api.functions})
    api.add("open", "SiI", files.open, FAILED)
    api.add("close", "i", files.close)
    api.add("read", "$iPQ", files.read, FAILED)
    api.add("write", "$iPQ", files.write, FAILED)
    api.add("ioctl", "$iQp", files.control)
    api.add("fcntl", "iip", files.flags)
    api.add("tcgetattr", "iP", files.get_options, FAILED)
    api.add("tcsetattr", "iiP", files.set_options, FAILED)
    api.add("tcflush", "ii", files.flush)
    api.add("tcdrain", "i", files.drain)
    memory = c.memory
    for name, offsets in (("cfsetispeed", (0,)), ("cfsetospeed", (4,)), ("cfsetspeed", (0, 4))):

        def set_speed(at: int, speed: int, offsets: tuple[int, ...] = offsets) -> int:
            for offset in offsets:
                memory.put_u32(at + SPEEDS + offset, speed)
            return 0

        api.add(name, "PI", set_speed, FAILED)
    api.add("cfgetispeed", "P", lambda at: memory.u32(at + SPEEDS), 0)
    api.add("cfgetospeed", "P", lambda at: memory.u32(at + SPEEDS + 4), 0)
    api.add("cfmakeraw", "P", lambda at: memory.poke(at, RAW), FAILED)


class DeviceFiles:
    """The open device files of a processor.

    Args:
        c: its C side.
        ports: its devices.
        others: functions of the same names for other files.
    """

    def __init__(self, c: CRuntime, ports: DevicePorts, others: dict[str, Declared]) -> None:
        self._c = c
        self._ports = ports
        self._others = others
        self._open: dict[int, OpenDevice] = {}

    def open(self, name: str, flags: int, mode: int) -> int:
        device = self._ports.find(name)
        number = name.removeprefix(I2C)
        bus = int(number) if name.startswith(I2C) and number.isdecimal() else FAILED
        if device is None and not self._ports.has_bus(bus):
            if name.startswith("/dev/"):
                return self._fail(errno.ENOENT)
            return self._other("open", name, flags, mode)
        descriptor = next(number for number in range(FIRST, 1 << 20) if number not in self._open)
        self._open[descriptor] = OpenDevice(name, device, bus, flags)
        return descriptor

    def close(self, descriptor: int) -> int:
        if descriptor not in self._open:
            is_other = 0 <= descriptor < FIRST
            return self._other("close", descriptor) if is_other else self._fail(errno.EBADF)
        del self._open[descriptor]
        return 0

    def read(self, descriptor: int, buffer: int, count: int) -> int:
        file = self._file("read", descriptor)
        if file is None:
            return FAILED
        if file.device is None:
            return self._fail(errno.EREMOTEIO)
        data = self._received(file, file.device, count)
        if data is None:
            return self._fail(errno.EAGAIN)
        self._c.memory.poke(buffer, data)
        return len(data)

    def write(self, descriptor: int, buffer: int, count: int) -> int:
        file = self._file("write", descriptor)
        if file is None:
            return FAILED
        if file.device is None:
            return self._fail(errno.EREMOTEIO)
        file.device.write(bytes(self._c.memory.peek(buffer, count)))
        return count

    def _received(self, file: OpenDevice, device: Device, count: int) -> bytes | None:
        """Return the bytes of a read, which may wait; None if there are none and it must not wait."""
        if file.bus != FAILED:
            return i2c_bytes(device, count)
        if file.flags & os.O_NONBLOCK:
            return device.read(count)[:count] or None
        wait_ns = None if file.options[VMIN] else file.options[VTIME] * TENTH_NS
        return awaited(self._c, device, count, wait_ns)

    def control(self, descriptor: int, request: int, argument: int) -> int:
        file, request = self._file("ioctl", descriptor), request & 0xFFFFFFFF
        if file is None:
            return FAILED
        if file.bus != FAILED and request in (I2C_SLAVE, I2C_SLAVE_FORCE):
            file.device = self._ports.i2c(file.bus, argument)
            return 0
        if file.bus != FAILED and request == I2C_RDWR:
            count = i2c_messages(self._c.memory, self._ports, file.bus, argument)
            return self._fail(errno.EREMOTEIO) if count is None else count
        if request == FIONREAD and file.device is not None:
            self._c.memory.put_u32(argument, file.device.waiting())
            return 0
        if request >> 8 & 0xFF == SPI_MAGIC and file.device is not None:
            return self._spi(file, file.device, request, argument)
        return self._fail(errno.ENOTTY)

    def _spi(self, file: OpenDevice, device: Device, request: int, argument: int) -> int:
        memory, size = self._c.memory, request >> 16 & 0x3FFF
        if request & 0xFF != SPI_MESSAGE:  # mode, bits and speed have one place for writing and reading
            if request >> 30 == 1:
                file.settings[request & 0xFF] = bytes(memory.peek(argument, size))
            else:
                memory.poke(argument, file.settings.get(request & 0xFF, bytes(size)))
            return 0
        total = 0
        for at in range(argument, argument + size, SPI_SIZE):
            sent, received, count = SPI_TRANSFER.unpack(memory.peek(at, SPI_SIZE))
            answer = device.transfer(bytes(memory.peek(sent, count)) if sent else bytes(count))
            if received:
                memory.poke(received, answer[:count].ljust(count, b"\0"))
            total += count
        return total

    def flags(self, descriptor: int, command: int, argument: int) -> int:
        file = self._open.get(descriptor)
        if file is None:
            is_other = 0 <= descriptor < FIRST
            return self._other("fcntl", descriptor, command, argument) if is_other else self._fail(errno.EBADF)
        if command == F_SETFL:
            file.flags = argument & 0xFFFFFFFF
        elif command != F_GETFL:
            return self._fail(errno.EINVAL)
        return file.flags if command == F_GETFL else 0

    def get_options(self, descriptor: int, at: int) -> int:
        file = self._file("tcgetattr", descriptor)
        if file is None:
            return FAILED
        self._c.memory.poke(at, bytes(file.options))
        return 0

    def set_options(self, descriptor: int, when: int, at: int) -> int:
        file = self._file("tcsetattr", descriptor)
        if file is None:
            return FAILED
        file.options[:] = self._c.memory.peek(at, TERMIOS)
        return 0

    def flush(self, descriptor: int, queue: int) -> int:
        """Discard received bytes."""
        file = self._file("tcflush", descriptor)
        if file is None:
            return FAILED
        device = file.device
        while device is not None and queue != 1 and device.waiting():
            device.read(device.waiting())
        return 0

    def drain(self, descriptor: int) -> int:
        return FAILED if self._file("tcdrain", descriptor) is None else 0

    def _file(self, function: str, descriptor: int) -> OpenDevice | None:
        """Return an open device, or set errno to EBADF as Linux does."""
        file = self._open.get(descriptor)
        if file is None and 0 <= descriptor < STANDARD:
            raise CFault(f"{function}() of {descriptor} is not available; use printf, or OSAL")
        if file is None:
            self._fail(errno.EBADF)
        return file

    def _other(self, function: str, *arguments: object) -> int:
        other = self._others.get(function)
        if other is None or other.function is None:
            raise CFault(f"{function}() is only available for devices of the mission; use OSAL")
        answer = other.function(*arguments)
        return answer if isinstance(answer, int) else 0

    def _fail(self, number: int) -> int:
        self._c.memory.put_u32(self._c.thread_locals.errno(), number)
        return FAILED

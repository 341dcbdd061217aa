"""Sockets of SocketCAN on the CAN buses of the mission (`devices:`)."""

from __future__ import annotations

import errno
from collections import deque
from struct import Struct

from cfepy.extra.c.devices import Device
from cfepy.extra.c.memory import CMemory
from cfepy.extra.c.posix.descriptors import POLLIN, POLLOUT, failure
from cfepy.extra.c.posix.sockets import MSG_DONTWAIT, MSG_PEEK, AnySocket
from cfepy.extra.c.posix.waiting import await_descriptors
from cfepy.osal import Place
from cfepy.rtos import Kernel

AF_CAN, SOCK_RAW, CAN_RAW = 29, 3, 1
SOL_CAN_RAW = 101
CAN_RAW_FILTER, CAN_RAW_LOOPBACK, CAN_RAW_RECV_OWN_MSGS = 1, 3, 4
CAN_INV_FILTER = 0x20000000
SIOCGIFINDEX = 0x8933
FRAME_BYTES = 16
MOST_FRAMES = 277
"""Frames that wait at a socket: the receive buffer of 212992 bytes, and 768 for each frame."""
MOST_AT_ONCE = 64
"""Frames that are taken from a device at one look."""
FILTER = Struct("<II")
ADDRESS = Struct("<HxxI")
"""The beginning of struct sockaddr_can: family, and index of the interface."""
IFREQ_NAME, NAME_BYTES = 0, 16
FIRST_INDEX = 2
"""The index of the first CAN bus; 1 is the loopback interface."""


class CanBus:
    """A CAN bus: the device, and the sockets that are bound to it.

    Args:
        device: the device.
    """

    def __init__(self, device: Device) -> None:
        self._device = device
        self.sockets: list[CanSocket] = []

    def receive(self) -> None:
        """Give the frames of the device to all sockets."""
        for _ in range(MOST_AT_ONCE):  # a device may have a frame at any time
            frame = self._device.read(FRAME_BYTES)
            if len(frame) != FRAME_BYTES:
                return
            for each in self.sockets:
                each.offer(frame)

    def send(self, frame: bytes, sender: CanSocket) -> None:
        """Send a frame to the device and to the other sockets of the bus."""
        self._device.write(frame)
        for each in self.sockets if sender.loops_back else ():
            if each is not sender or each.receives_own:
                each.offer(frame)


class CanBuses:
    """The CAN buses of a processor, by the index of their interface.

    Args:
        devices: the devices that may be buses, by name.
    """

    def __init__(self, devices: dict[str, Device]) -> None:
        self._names = list(devices)
        self.buses = {FIRST_INDEX + number: CanBus(each) for number, each in enumerate(devices.values())}

    def index(self, name: str) -> int:
        """Return the index of an interface.

        Raises:
            OSError: ENODEV.
        """
        if name == "lo":
            return 1
        if name not in self._names:
            raise failure(errno.ENODEV)
        return FIRST_INDEX + self._names.index(name)


class CanSocket(AnySocket):
    """A raw socket of SocketCAN.

    Args:
        kernel: the processor.
        memory: the memory of C.
        buses: the buses.
        flags: O_NONBLOCK or 0.

    Attributes:
        loops_back, receives_own: CAN_RAW_LOOPBACK and CAN_RAW_RECV_OWN_MSGS.
    """

    announces_nothing = True
    kind = SOCK_RAW

    def __init__(self, kernel: Kernel, memory: CMemory, buses: CanBuses, flags: int) -> None:
        super().__init__(flags)
        self._kernel = kernel
        self._memory = memory
        self._buses = buses
        self._bound: list[CanBus] = []
        self._index = 0
        self._frames: deque[bytes] = deque()
        self._filters = [(0, 0)]
        self.loops_back, self.receives_own = True, False

    @property
    def events(self) -> int:
        for bus in self._bound if not self._frames else ():
            bus.receive()
        return POLLOUT | (POLLIN if self._frames else 0)

    def offer(self, frame: bytes) -> None:
        """Take a frame that passes a filter, if there is room."""
        identifier = int.from_bytes(frame[:4], "little")
        for wanted, mask in self._filters:
            is_match = identifier & mask == wanted & ~CAN_INV_FILTER & mask
            if is_match != bool(wanted & CAN_INV_FILTER):
                if len(self._frames) < MOST_FRAMES:
                    self._frames.append(frame)
                return

    def bind_to(self, at: int, size: int) -> int:
        if size < ADDRESS.size:
            raise failure(errno.EINVAL)
        family, index = ADDRESS.unpack(self._memory.peek(at, ADDRESS.size))
        if family != AF_CAN:
            raise failure(errno.EINVAL)
        if index and index not in self._buses.buses:
            raise failure(errno.ENODEV)
        self._leave()
        self._index = index
        self._bound = [self._buses.buses[index]] if index else list(self._buses.buses.values())
        for bus in self._bound:
            bus.sockets.append(self)
        return 0

    def set_option(self, level: int, name: int, value: bytes) -> int:
        if level != SOL_CAN_RAW:
            raise failure(errno.ENOPROTOOPT)
        if name == CAN_RAW_FILTER:
            if len(value) % FILTER.size:
                raise failure(errno.EINVAL)
            self._filters = list(FILTER.iter_unpack(value))
        elif name == CAN_RAW_LOOPBACK:
            self.loops_back = any(value)
        elif name == CAN_RAW_RECV_OWN_MSGS:
            self.receives_own = any(value)
        return 0

    def control(self, request: int, argument: int) -> int:
        if request != SIOCGIFINDEX:
            raise failure(errno.ENOTTY)
        name = bytes(self._memory.peek(argument + IFREQ_NAME, NAME_BYTES)).partition(b"\0")[0]
        self._memory.put_u32(argument + NAME_BYTES, self._buses.index(name.decode("utf-8", "surrogateescape")))
        return 0

    def receive(self, count: int, flags: int) -> tuple[bytes, Place | None]:
        wait_ns = 0 if self.is_nonblocking or flags & MSG_DONTWAIT else self.receive_ns
        if not await_descriptors(self._kernel, [self], lambda: bool(self.events & POLLIN), wait_ns):
            raise failure(errno.EAGAIN)
        return self._frames[0] if flags & MSG_PEEK else self._frames.popleft(), None

    def send(self, data: bytes, flags: int, target: Place | None) -> int:
        if len(data) != FRAME_BYTES:
            raise failure(errno.EINVAL)
        if not self._index:
            raise failure(errno.ENXIO)
        self._bound[0].send(data, self)
        return len(data)

    def close(self) -> None:
        self._leave()

    def _leave(self) -> None:
        for bus in self._bound:
            bus.sockets.remove(self)
        self._bound = []

"""Sockets of UDP and TCP on the mission's network, and of SocketCAN on its CAN buses, with Linux's errors."""

from __future__ import annotations

import errno
from collections import deque
from collections.abc import Callable, Sequence
from struct import Struct

from cfepy.extra.c.devices import Device
from cfepy.extra.c.memory import CMemory
from cfepy.extra.c.posix.descriptor_waits import await_descriptors
from cfepy.extra.c.posix.open_descriptors import (
    O_NONBLOCK,
    O_RDWR,
    POLLERR,
    POLLHUP,
    POLLIN,
    POLLOUT,
    S_IFSOCK,
    Descriptor,
    Facts,
    failure,
)
from cfepy.extra.c.posix.signal_actions import SignalActions
from cfepy.osal import LONGEST_DATAGRAM, Datagram, Endpoint, Listener, Mailbox, Network, Place, Stream
from cfepy.rtos import FOREVER, Kernel

SOCK_STREAM, SOCK_DGRAM = 1, 2
MSG_PEEK, MSG_TRUNC, MSG_DONTWAIT, MSG_WAITALL, MSG_NOSIGNAL, MSG_OOB = 0x2, 0x20, 0x40, 0x100, 0x4000, 0x1
SHUT_RD, SHUT_WR, SHUT_RDWR = 0, 1, 2
POLLWRBAND = 0x200
BROADCAST = "255.255.255.255"
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


class AnySocket(Descriptor):
    """A socket of any family.

    Attributes:
        receive_ns, send_ns: SO_RCVTIMEO and SO_SNDTIMEO; FOREVER for none.
    """

    kind = SOCK_STREAM

    def __init__(self, flags: int) -> None:
        super().__init__(O_RDWR | flags & O_NONBLOCK)
        self.receive_ns = self.send_ns = FOREVER

    def read(self, count: int) -> bytes:
        return self.receive(count, 0)[0][:count]

    def write(self, data: bytes) -> int:
        return self.send(data, 0, None)

    def receive(self, count: int, flags: int) -> tuple[bytes, Place | None]:
        """Wait for bytes.

        Args:
            count: most bytes of a stream; a datagram is given whole.
            flags: MSG_*.

        Returns:
            The bytes, and the sender of a datagram.
        """
        raise NotImplementedError

    def send(self, data: bytes, flags: int, target: Place | None) -> int:
        """Send bytes, and wait for room.

        Args:
            data: the bytes.
            flags: MSG_*.
            target: the address for a datagram; None for the peer.

        Returns:
            The number of bytes that were sent.

        Raises:
            CFault: the connection is over, and SIGPIPE ends the process.
        """
        raise NotImplementedError

    def facts(self) -> Facts:
        return Facts(S_IFSOCK | 0o777)


class PosixSocket(AnySocket):
    """A socket of UDP or TCP.

    Args:
        kernel: the processor.
        network: the mission's network.
        signals: the action of SIGPIPE.
        is_ip6: whether it belongs to IPv6.
        kind: SOCK_STREAM or SOCK_DGRAM.
        flags: O_NONBLOCK or 0.
        stream: an accepted connection; None for a new socket.

    Attributes:
        error: the errno that SO_ERROR reports next; 0 for none.
        reuses, broadcasts: SO_REUSEADDR and SO_BROADCAST.
        options: the other options, by level and name.
    """

    def __init__(
        self,
        kernel: Kernel,
        network: Network,
        signals: SignalActions,
        is_ip6: bool,
        kind: int,
        flags: int,
        stream: Stream | None = None,
    ) -> None:
        super().__init__(flags)
        self._kernel = kernel
        self._signals = signals
        self._network = network
        self.is_ip6 = is_ip6
        self.kind = kind
        self._listener = Listener()  # holds the port of a stream socket
        self._end: Endpoint = stream or (Mailbox() if kind == SOCK_DGRAM else Endpoint())
        self._target: Place | None = None  # of a connection that began without waiting
        self._is_new = False  # such a connection was made, and no call has reported it
        self.error = 0
        self.reuses = self.broadcasts = False
        self.options: dict[tuple[int, int], bytes] = {}

    # -- states ------------------------------------------------------------------------------------------------------

    @property
    def endpoints(self) -> Sequence[Endpoint]:
        server = None if self._target is None else self._network.streams.find(self._target)
        return (self._end,) if server is None else (self._end, server)

    @property
    def events(self) -> int:
        self._go_on()
        end = self._end
        failed = POLLERR if self.error else 0
        if isinstance(end, Mailbox):
            failed |= POLLERR if end.refused else 0
            readable = not end.is_empty or end.read_shut
            return POLLOUT | failed | (POLLIN if readable else 0) | (POLLHUP if end.read_shut and end.write_shut else 0)
        if isinstance(end, Stream):
            return (POLLIN if end.readable else 0) | (POLLOUT if end.writable else 0) | (POLLHUP if end.dead else 0)
        if isinstance(end, Listener):
            return POLLIN if end.readable else 0
        if self._target is not None:
            return 0
        return POLLOUT | POLLHUP | failed | (POLLIN if failed else 0)

    @property
    def is_listening(self) -> bool:
        """Whether it accepts connections (SO_ACCEPTCONN)."""
        return isinstance(self._end, Listener)

    @property
    def place(self) -> Place:
        """Its own address."""
        place = self._end.place or self._listener.place
        if place is not None and isinstance(self._end, Mailbox) and self._end.peer is not None:
            place = place.reached()  # connecting chooses a route, and thus an address
        return place or self._any(0)

    def peer(self) -> Place:
        """Return the address of the other side; raises ENOTCONN."""
        end = self._end
        peer = end.peer if isinstance(end, Mailbox) else end.remote if isinstance(end, Stream) else None
        if peer is None:
            raise failure(errno.ENOTCONN)
        return peer

    def take_error(self) -> int:
        """Return and forget the pending error (SO_ERROR)."""
        self._go_on()
        if isinstance(self._end, Mailbox) and self._end.take_refusal():
            return errno.ECONNREFUSED
        found, self.error = self.error, 0
        return found

    def waiting(self) -> int:
        end = self._end
        if isinstance(end, Mailbox):
            return 0 if end.is_empty else len(end.peek().data)
        if isinstance(end, Listener):
            raise failure(errno.EINVAL)
        return len(end.peek(1 << 30)) if isinstance(end, Stream) else 0

    def _any(self, port: int) -> Place:
        return Place("::" if self.is_ip6 else "0.0.0.0", port)

    # -- addresses and connections -----------------------------------------------------------------------------------

    def bind(self, place: Place) -> None:
        """Take an address."""
        if self._end.place is not None or self._listener.place is not None:
            raise failure(errno.EINVAL)
        if not (place.is_here or (place.is_group and self.kind == SOCK_DGRAM)):
            raise failure(errno.EADDRNOTAVAIL)
        self._take(place)

    def _take(self, place: Place) -> Place:
        end = self._end
        if isinstance(end, Mailbox):
            end.shares = self.reuses
            taken = self._network.datagrams.bind(end, place)
        else:
            taken = self._network.streams.bind(self._listener, place)
        if taken is None:
            raise failure(errno.EADDRINUSE)
        return taken

    def listen(self) -> None:
        """Accept connections."""
        if isinstance(self._end, (Mailbox, Stream)):
            raise failure(errno.EOPNOTSUPP if isinstance(self._end, Mailbox) else errno.EINVAL)
        if self._listener.place is None:
            self._take(self._any(0))
        self._listener.listening = True
        self._end = self._listener

    def accept(self, flags: int) -> PosixSocket:
        """Wait for a connection. Returns its socket."""
        server = self._end
        if isinstance(server, Mailbox):
            raise failure(errno.EOPNOTSUPP)
        if not isinstance(server, Listener):
            raise failure(errno.EINVAL)
        self._wait(lambda: server.readable, self.receive_ns)
        return PosixSocket(self._kernel, self._network, self._signals, self.is_ip6, self.kind, flags, server.accept())

    def connect(self, place: Place | None) -> None:
        """Connect a stream, or set the peer of datagrams; None takes the peer away."""
        end = self._end
        if isinstance(end, Mailbox):
            if place is not None and place.host == BROADCAST and not self.broadcasts:
                raise failure(errno.EACCES)
            if place is not None and end.place is None:
                self._take(self._any(0))
            end.peer = None if place is None else self._reached(place)
            return
        if self._target is not None:
            self._go_on()
            if self._target is not None:
                raise failure(errno.EALREADY)
        if self._is_new:
            self._is_new = False
            if isinstance(self._end, Stream):
                return
            raise failure(self.take_error() or errno.ECONNABORTED)
        if isinstance(self._end, (Stream, Listener)):
            raise failure(errno.EISCONN)
        if place is None:
            return
        if not place.is_here:
            raise failure(errno.ENETUNREACH)
        self._target, self._is_new = self._reached(place), self.is_nonblocking
        if self._is_new:
            self._go_on()
            raise failure(errno.EINPROGRESS)
        server = self._network.streams.find(self._target)
        if server is not None and server.listening:
            self._wait(lambda: server.has_room or not server.listening, self.send_ns, errno.EINPROGRESS)
        self._go_on()
        if self.error:
            raise failure(self.take_error())

    def _go_on(self) -> None:
        """Complete a connection, if the other side has room."""
        if self._target is None:
            return
        target, server = self._target, self._network.streams.find(self._target)
        is_here = server is not None and server.listening
        if is_here and server is not None and not server.has_room:
            return
        self._target = None
        source = (self._listener.place or self._take(self._any(0))).reached()
        if is_here and server is not None:
            self._end = server.connect(source, target)
            return
        outside = self._network.dial(source, target) if self._network.dial is not None else None
        if outside is None:
            self.error = errno.ECONNREFUSED
        else:
            self._end = outside

    @staticmethod
    def _reached(place: Place) -> Place:
        return place.reached() if place.is_here else place

    def shut(self, how: int) -> None:
        """Stop reading or writing."""
        if how not in (SHUT_RD, SHUT_WR, SHUT_RDWR):
            raise failure(errno.EINVAL)
        read, write, end = how != SHUT_WR, how != SHUT_RD, self._end
        if isinstance(end, Stream):
            if not end.shut(read, write):
                raise failure(errno.ENOTCONN)
        elif isinstance(end, Listener) and read:
            end.close()
            self._end = Endpoint()
        elif isinstance(end, Mailbox):
            end.read_shut |= read
            end.write_shut |= write
            end.changed()
            if end.peer is None:
                raise failure(errno.ENOTCONN)
        else:
            raise failure(errno.ENOTCONN)

    def close(self) -> None:
        end = self._end
        if isinstance(end, Mailbox):
            self._network.datagrams.release(end)
        self._network.streams.release(self._listener)
        self._listener.close()
        if isinstance(end, Stream):
            end.close()
        end.changed()

    # -- bytes -------------------------------------------------------------------------------------------------------

    def receive(self, count: int, flags: int) -> tuple[bytes, Place | None]:
        if flags & MSG_OOB:
            raise failure(errno.EINVAL if self.kind == SOCK_STREAM else errno.EOPNOTSUPP)
        self._go_on()
        end, at_once = self._end, bool(flags & MSG_DONTWAIT)
        if isinstance(end, Mailbox):
            self._wait(lambda: end.readable, self.receive_ns, at_once=at_once)
            if end.take_refusal():
                raise failure(errno.ECONNREFUSED)
            if end.is_empty:
                return b"", None
            datagram = end.peek() if flags & MSG_PEEK else end.take()
            return datagram.data, datagram.source
        if not isinstance(end, Stream):
            raise failure(self.take_error() or (errno.EAGAIN if self._target else errno.ENOTCONN))
        if not count:
            return b"", None
        self._wait(lambda: end.readable, self.receive_ns, at_once=at_once)
        if end.take_reset():
            raise failure(errno.ECONNRESET)
        if flags & MSG_PEEK:
            return end.peek(count), None
        data = end.read(count)
        while flags & MSG_WAITALL and data and len(data) < count:
            try:
                self._wait(lambda: end.readable, self.receive_ns, at_once=at_once)
            except OSError:
                break
            more = end.read(count - len(data))
            if not more:
                break
            data += more
        return data, None

    def send(self, data: bytes, flags: int, target: Place | None) -> int:
        self._go_on()
        end = self._end
        if isinstance(end, Mailbox):
            to = target or end.peer
            if to is None:
                raise failure(errno.EDESTADDRREQ)
            return self._send_datagram(end, data, to)
        if not isinstance(end, Stream):
            if self._target is not None:
                raise failure(errno.EAGAIN)
            return self._broken(flags)
        sent = 0
        while sent < len(data):
            try:
                self._wait(lambda: end.writable, self.send_ns, at_once=bool(flags & MSG_DONTWAIT))
            except OSError:
                if sent:
                    return sent
                raise
            was_reset = end.dead and end.take_reset()
            count = end.write(data[sent:])
            if count is None:
                if was_reset:
                    raise failure(errno.ECONNRESET)
                return sent or self._broken(flags)
            sent += count
        return sent

    def _broken(self, flags: int) -> int:
        if flags & MSG_NOSIGNAL:
            raise failure(errno.EPIPE)
        why, advice = "the connection of the socket is over", "MSG_NOSIGNAL avoids the signal"
        raise self._signals.broken_pipe(why, advice)

    def _send_datagram(self, end: Mailbox, data: bytes, target: Place) -> int:
        if len(data) > LONGEST_DATAGRAM:
            raise failure(errno.EMSGSIZE)
        if not target.port:
            raise failure(errno.EINVAL)
        if end.write_shut:
            return self._broken(MSG_NOSIGNAL)
        if target.host == BROADCAST and not self.broadcasts:
            raise failure(errno.EACCES)
        if end.take_refusal():
            raise failure(errno.ECONNREFUSED)
        target = self._reached(target)
        source = (end.place or self._take(self._any(0))).reached()
        if end.peer is not None and target == end.peer and self._network.refuses(target):
            end.refused = True
        else:
            self._network.send(Datagram(source, target, data))
        return len(data)

    def _wait(
        self, ready: Callable[[], bool], timeout_ns: int, late: int = errno.EAGAIN, at_once: bool = False
    ) -> None:
        if self.is_nonblocking or at_once:
            timeout_ns = 0
        if not await_descriptors(self._kernel, [self], ready, timeout_ns):
            raise failure(late)


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

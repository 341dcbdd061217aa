"""socket, bind, sendto, recvfrom and related functions of POSIX, on the mission's network."""

from __future__ import annotations

import errno
from struct import Struct
from typing import TYPE_CHECKING

from cfepy.extra.c.api.posix_calls import PosixCalls
from cfepy.extra.c.api.posix_files import IOVEC
from cfepy.extra.c.crashes import CFault
from cfepy.extra.c.posix.inet_addresses import AF_INET, AF_INET6, read_place, write_place
from cfepy.extra.c.posix.open_descriptors import O_NONBLOCK, failure
from cfepy.extra.c.posix.open_sockets import (
    AF_CAN,
    CAN_RAW,
    MSG_TRUNC,
    SOCK_DGRAM,
    SOCK_STREAM,
    AnySocket,
    CanBuses,
    CanSocket,
    PosixSocket,
)
from cfepy.osal import Place
from cfepy.rtos import FOREVER
from cfepy.units import NS_PER_S, NS_PER_US

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

TYPE_BITS, SOCK_RAW, SOCK_MAX = 0xF, 3, 11
SOL_SOCKET = 1
SO_REUSEADDR, SO_TYPE, SO_ERROR, SO_BROADCAST, SO_SNDBUF, SO_RCVBUF = 2, 3, 4, 6, 7, 8
SO_RCVTIMEO, SO_SNDTIMEO, SO_ACCEPTCONN, SO_PROTOCOL, SO_DOMAIN = 20, 21, 30, 38, 39
LEVELS = (0, SOL_SOCKET, 6, 17, 41)
"""Levels of options: IP, socket, TCP, UDP, IPv6."""
PROTOCOLS = {SOCK_STREAM: 6, SOCK_DGRAM: 17}
BUFFER_BYTES = 212_992
TIMEVAL = Struct("<qq")
MSGHDR = Struct("<QI4xQQQQi4x")


class PosixSocketCalls:
    """The functions on sockets.

    Args:
        c: the C side of the processor.
    """

    def __init__(self, c: CRuntime) -> None:
        self._c = c
        self._memory = c.memory
        self._table = c.descriptors
        self._known_buses: CanBuses | None = None

    def _buses(self) -> CanBuses:
        """Return the CAN buses, made when they are first needed."""
        if self._known_buses is None:
            self._known_buses = CanBuses(self._c.devices.buses())
        return self._known_buses

    def make(self, domain: int, kind: int, protocol: int) -> int:
        self._c.kernel.preempt()
        flags, plain = kind & O_NONBLOCK, kind & TYPE_BITS
        if (domain, plain, protocol) == (AF_CAN, SOCK_RAW, CAN_RAW):
            return self._table.add(CanSocket(self._c.kernel, self._memory, self._buses(), flags))
        if domain not in (AF_INET, AF_INET6):
            self._c.console.write(f"{self._app()}: socket() of family {domain} is not available; errno is EAFNOSUPPORT")
            raise failure(errno.EAFNOSUPPORT)
        if plain not in PROTOCOLS and plain != SOCK_RAW:
            raise failure(errno.EINVAL if plain >= SOCK_MAX else errno.ESOCKTNOSUPPORT)
        if plain == SOCK_RAW:
            self._c.console.write(f"{self._app()}: socket() of type {plain} is not available; errno is EPERM")
            raise failure(errno.EPERM)
        if protocol not in (0, PROTOCOLS[plain]):
            raise failure(errno.EPROTONOSUPPORT)
        network, signals = self._c.cfe.os.network, self._c.signals
        return self._table.add(PosixSocket(self._c.kernel, network, signals, domain == AF_INET6, plain, flags))

    def _app(self) -> str:
        return str(getattr(self._c.kernel.current.owner, "name", ""))

    def _socket(self, number: int) -> PosixSocket:
        found = self._table.of(number)
        if not isinstance(found, PosixSocket):
            raise failure(errno.ENOTSOCK)
        return found

    def _any_socket(self, number: int) -> AnySocket:
        found = self._table.of(number)
        if not isinstance(found, AnySocket):
            raise failure(errno.ENOTSOCK)
        return found

    def _target(self, found: AnySocket, at: int, size: int) -> Place | None:
        """Return the address for a datagram; None for the peer."""
        if not at or not isinstance(found, PosixSocket) or found.kind != SOCK_DGRAM:
            return None
        return read_place(self._memory, at, size, found.is_ip6)

    def index_of(self, name: str) -> int:
        return self._buses().index(name)

    # -- addresses and connections -----------------------------------------------------------------------------------

    def bind(self, number: int, at: int, size: int) -> int:
        self._c.kernel.preempt()
        found = self._table.of(number)
        if not isinstance(found, PosixSocket):
            return found.bind_to(at, size)
        place = read_place(self._memory, at, size, found.is_ip6)
        found.bind(Place("::" if found.is_ip6 else "0.0.0.0", 0) if place is None else place)
        return 0

    def connect(self, number: int, at: int, size: int) -> int:
        self._c.kernel.preempt()
        found = self._socket(number)
        found.connect(read_place(self._memory, at, size, found.is_ip6))
        return 0

    def listen(self, number: int, backlog: int) -> int:
        self._c.kernel.preempt()
        self._socket(number).listen()
        return 0

    def accept(self, number: int, at: int, size_at: int) -> int:
        return self.accept_with(number, at, size_at, 0)

    def accept_with(self, number: int, at: int, size_at: int, flags: int) -> int:
        self._c.kernel.preempt()
        made = self._socket(number).accept(flags)
        accepted = self._table.add(made)
        write_place(self._memory, at, size_at, made.peer())
        return accepted

    def own_name(self, number: int, at: int, size_at: int) -> int:
        write_place(self._memory, at, size_at, self._socket(number).place)
        return 0

    def peer_name(self, number: int, at: int, size_at: int) -> int:
        write_place(self._memory, at, size_at, self._socket(number).peer())
        return 0

    def shut(self, number: int, how: int) -> int:
        self._c.kernel.preempt()
        self._socket(number).shut(how)
        return 0

    # -- transfers ---------------------------------------------------------------------------------------------------

    def send(self, number: int, data: int, count: int, flags: int) -> int:
        return self.send_to(number, data, count, flags, 0, 0)

    def send_to(self, number: int, data: int, count: int, flags: int, at: int, size: int) -> int:
        self._c.kernel.preempt()
        found = self._any_socket(number)
        target = self._target(found, at, size)
        return found.send(bytes(self._memory.peek(data, count)), flags, target)

    def receive(self, number: int, to: int, count: int, flags: int) -> int:
        return self.receive_from(number, to, count, flags, 0, 0)

    def receive_from(self, number: int, to: int, count: int, flags: int, at: int, size_at: int) -> int:
        self._c.kernel.preempt()
        data, source = self._any_socket(number).receive(count, flags)
        self._memory.poke(to, data[:count])
        write_place(self._memory, at, size_at, source)
        return len(data) if flags & MSG_TRUNC else min(len(data), count)

    def receive_checked(self, number: int, to: int, count: int, room: int, flags: int) -> int:
        return self.receive_from_checked(number, to, count, room, flags, 0, 0)

    def receive_from_checked(
        self, number: int, to: int, count: int, room: int, flags: int, at: int, size_at: int
    ) -> int:
        if count > room:
            raise CFault("buffer overflow detected")
        return self.receive_from(number, to, count, flags, at, size_at)

    def _vectors(self, at: int, count: int) -> list[tuple[int, int]]:
        return [IOVEC.unpack(self._memory.peek(at + n * IOVEC.size, IOVEC.size)) for n in range(count)]

    def send_message(self, number: int, message: int, flags: int) -> int:
        self._c.kernel.preempt()
        at, size, vectors, count, *_ = MSGHDR.unpack(self._memory.peek(message, MSGHDR.size))
        found = self._any_socket(number)
        target = self._target(found, at, size)
        pieces = (bytes(self._memory.peek(*each)) for each in self._vectors(vectors, count))
        return found.send(b"".join(pieces), flags, target)

    def receive_message(self, number: int, message: int, flags: int) -> int:
        self._c.kernel.preempt()
        at, _, vectors, count, *_ = MSGHDR.unpack(self._memory.peek(message, MSGHDR.size))
        places = self._vectors(vectors, count)
        room = sum(size for _, size in places)
        data, source = self._any_socket(number).receive(room, flags)
        rest = data[:room]
        for to, size in places:
            self._memory.poke(to, rest[:size])
            rest = rest[size:]
        write_place(self._memory, at, message + 8, source)
        self._memory.put_u64(message + 40, 0)  # no control data
        self._memory.put_u32(message + 48, MSG_TRUNC if len(data) > room else 0)
        return len(data) if flags & MSG_TRUNC else min(len(data), room)

    # -- options -----------------------------------------------------------------------------------------------------

    def set_option(self, number: int, level: int, name: int, at: int, size: int) -> int:
        descriptor = self._any_socket(number)
        value = bytes(self._memory.peek(at, size)) if at else b""
        if level == SOL_SOCKET and name in (SO_RCVTIMEO, SO_SNDTIMEO):
            self._set_timeout(descriptor, name, value)
            return 0
        if not isinstance(descriptor, PosixSocket):
            return descriptor.set_option(level, name, value)
        if level not in LEVELS:
            raise failure(errno.ENOPROTOOPT)
        if level == SOL_SOCKET and len(value) < 4:
            raise failure(errno.EINVAL)
        number_given = int.from_bytes(value[:4], "little")
        if level == SOL_SOCKET:
            if name in (SO_TYPE, SO_ERROR, SO_ACCEPTCONN, SO_PROTOCOL, SO_DOMAIN):
                raise failure(errno.ENOPROTOOPT)
            if name == SO_REUSEADDR:
                descriptor.reuses = bool(number_given)
            elif name == SO_BROADCAST:
                descriptor.broadcasts = bool(number_given)
            elif name in (SO_SNDBUF, SO_RCVBUF):
                value = (2 * min(number_given, BUFFER_BYTES)).to_bytes(4, "little")
        descriptor.options[level, name] = value
        return 0

    def _set_timeout(self, found: AnySocket, name: int, value: bytes) -> None:
        if len(value) < TIMEVAL.size:
            raise failure(errno.EINVAL)
        seconds, microseconds = TIMEVAL.unpack_from(value)
        if not 0 <= microseconds < 1_000_000:
            raise failure(errno.EDOM)
        wait_ns = max(seconds, 0) * NS_PER_S + microseconds * NS_PER_US or FOREVER
        if name == SO_RCVTIMEO:
            found.receive_ns = wait_ns
        else:
            found.send_ns = wait_ns

    def get_option(self, number: int, level: int, name: int, at: int, size_at: int) -> int:
        found = self._socket(number)
        room = self._memory.u32(size_at)
        value = self._option(found, level, name)[:room]
        self._memory.poke(at, value)
        self._memory.put_u32(size_at, len(value))
        return 0

    def _option(self, found: PosixSocket, level: int, name: int) -> bytes:
        if level not in LEVELS:
            raise failure(errno.EOPNOTSUPP)
        if level == SOL_SOCKET and name in (SO_RCVTIMEO, SO_SNDTIMEO):
            wait_ns = found.receive_ns if name == SO_RCVTIMEO else found.send_ns
            seconds, rest = divmod(0 if wait_ns == FOREVER else wait_ns, NS_PER_S)
            return TIMEVAL.pack(seconds, rest // NS_PER_US)
        if level == SOL_SOCKET and name == SO_ERROR:
            return found.take_error().to_bytes(4, "little")
        numbers = {
            SO_TYPE: found.kind,
            SO_REUSEADDR: int(found.reuses),
            SO_BROADCAST: int(found.broadcasts),
            SO_ACCEPTCONN: int(found.is_listening),
            SO_PROTOCOL: PROTOCOLS[found.kind],
            SO_DOMAIN: AF_INET6 if found.is_ip6 else AF_INET,
        }
        if level == SOL_SOCKET and name in numbers:
            return numbers[name].to_bytes(4, "little")
        first = BUFFER_BYTES if level == SOL_SOCKET and name in (SO_SNDBUF, SO_RCVBUF) else 0
        return found.options.get((level, name), first.to_bytes(4, "little"))


def declare(api: Declarations, c: CRuntime) -> None:
    calls, sockets = PosixCalls(api, c), PosixSocketCalls(c)
    calls.add("socket", "$iii", sockets.make)
    calls.add("if_nametoindex", "S", sockets.index_of, 0)
    calls.add("bind", "$ipI", sockets.bind)
    calls.add("connect", "$ipI", sockets.connect)
    calls.add("listen", "$ii", sockets.listen)
    calls.add("accept", "$ipp", sockets.accept)
    calls.add("accept4", "$ippi", sockets.accept_with)
    calls.add("getsockname", "iPP", sockets.own_name)
    calls.add("getpeername", "iPP", sockets.peer_name)
    calls.add("shutdown", "$ii", sockets.shut)
    calls.add("send", "$ipQi", sockets.send)
    calls.add("sendto", "$ipQipI", sockets.send_to)
    calls.add("sendmsg", "$iPi", sockets.send_message)
    calls.add("recv", "$ipQi", sockets.receive)
    calls.add("recvfrom", "$ipQipp", sockets.receive_from)
    calls.add("__recv_chk", "$ipQQi", sockets.receive_checked)
    calls.add("__recvfrom_chk", "$ipQQipp", sockets.receive_from_checked)
    calls.add("recvmsg", "$iPi", sockets.receive_message)
    calls.add("setsockopt", "$iiipI", sockets.set_option)
    calls.add("getsockopt", "$iiiPP", sockets.get_option)

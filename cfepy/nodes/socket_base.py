"""The part of a node's `socket.socket` that every socket has: its life, its settings, its waiting.

May import cfepy.osal and cfepy.rtos.
"""

from __future__ import annotations

import errno
import socket
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Self

from cfepy.nodes.locks import wait_ns
from cfepy.nodes.socket_names import address_of, failure
from cfepy.osal.endpoints import Endpoint, Listener, Mailbox, Place, Stream
from cfepy.rtos import FOREVER, TIMEOUT, WaitList

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe
    from cfepy.osal.network import Network

_OPTIONS_OF_TYPE = socket.SOCK_NONBLOCK | socket.SOCK_CLOEXEC
_BUFFER_BYTES = 212_992


def await_endpoints(
    universe: Universe,
    endpoints: Sequence[Endpoint],
    ready: Callable[[], bool],
    seconds: float | None,
    waits: WaitList | None = None,
) -> bool:
    """Wait until `ready` says so, which is asked again whenever an endpoint has changed.

    Args:
        universe: whose task waits.
        endpoints: what to look at.
        ready: whether the wait is over.
        seconds: the longest time; None for ever.
        waits: where to wait, if something else is to end the wait as well.

    Returns:
        False when the time was over first.
    """
    universe.charge()
    if ready() or (seconds is not None and seconds <= 0):
        return ready()
    kernel = universe.kernel
    waits = WaitList(f"a socket of {universe.name}") if waits is None else waits
    until = FOREVER if seconds is None else kernel.now + wait_ns(seconds)
    for endpoint in endpoints:
        endpoint.watch(kernel, waits)
    try:
        while not ready():
            left = FOREVER if until == FOREVER else until - kernel.now
            if left == 0 or (kernel.wait_on(waits, left) is TIMEOUT and not ready()):
                return False
    finally:
        for endpoint in endpoints:
            endpoint.unwatch(kernel, waits)
    return True


class SocketBase:
    """A socket; the methods are those of `socket.socket`, and so are the errors.

    Subclasses, one for each node, say which `universe` they belong to.

    Args:
        family: AF_INET or AF_INET6.
        type: SOCK_STREAM or SOCK_DGRAM.
        proto: any protocol.
        fileno: descriptors cannot be passed on; must be None.
    """

    universe: Universe

    def __init__(self, family: int = -1, type: int = -1, proto: int = -1, fileno: int | None = None) -> None:
        self._network = self.universe.sockets.network("socket.socket")
        if fileno is not None:
            raise failure(errno.EBADF)
        self._family = socket.AF_INET if family == -1 else family
        kind = socket.SOCK_STREAM if type == -1 else type
        self._kind = kind & ~_OPTIONS_OF_TYPE
        if self._family not in (socket.AF_INET, socket.AF_INET6):
            raise failure(errno.EAFNOSUPPORT)
        if self._kind not in (socket.SOCK_STREAM, socket.SOCK_DGRAM):
            raise failure(errno.EPERM)
        self.proto = max(proto, 0)
        self._timeout = 0.0 if kind & socket.SOCK_NONBLOCK else self.universe.sockets.default_timeout
        self._open(Mailbox() if self._kind == socket.SOCK_DGRAM else Endpoint())

    def _open(self, endpoint: Endpoint) -> None:
        self.endpoint: Endpoint = endpoint
        self._listener = Listener()  # holds the port of a stream socket
        self._options: dict[tuple[int, int], Any] = {}
        self._io_refs = 0  # files made by `makefile`, counted by socket.SocketIO
        self._closed = False
        self._fd = self._serial = self.universe.sockets.add(self)

    @classmethod
    def joined(cls, stream: Stream, network: Network, family: int) -> Self:
        """The socket of a connection that is there already."""
        made = cls.__new__(cls)
        made._network, made._family, made._kind, made.proto = network, family, socket.SOCK_STREAM, 0
        made._timeout = cls.universe.sockets.default_timeout
        made._open(stream)
        return made

    # -- the life of a socket ----------------------------------------------------------------------------------------

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def __hash__(self) -> int:
        return self._serial  # an address would show in the order of a set

    def __repr__(self) -> str:
        name = f"{type(self).__module__}.{type(self).__qualname__}"
        state = " [closed]" if self._fd < 0 else ""
        return f"<{name}{state} fd={self._fd}, family={self.family}, type={self.type}, proto={self.proto}>"

    makefile = socket.socket.makefile
    _decref_socketios = socket.socket._decref_socketios  # type: ignore[attr-defined]  # SocketIO calls it

    def close(self) -> None:
        """Close it, once the files made of it are closed too."""
        self._closed = True
        if self._io_refs <= 0:
            self._real_close()

    def detach(self) -> int:
        """Give the descriptor away; nothing can be done with it here."""
        fd, self._fd = self._fd, -1
        self._closed = True
        return fd

    def _real_close(self) -> None:
        if self._fd < 0:
            return
        self.universe.sockets.remove(self._fd)
        self._fd = -1
        endpoint = self.endpoint
        if isinstance(endpoint, Mailbox):
            self._network.datagrams.release(endpoint)
        self._network.streams.release(self._listener)
        self._listener.close()
        if isinstance(endpoint, Stream):
            endpoint.close()
        endpoint.changed()

    def shutdown(self, how: int) -> None:
        """Read or write no more."""
        stream = self._stream()
        if how not in (socket.SHUT_RD, socket.SHUT_WR, socket.SHUT_RDWR):
            raise failure(errno.EINVAL)
        stream.shut(how != socket.SHUT_WR, how != socket.SHUT_RD)

    # -- facts and settings ------------------------------------------------------------------------------------------

    @property
    def family(self) -> socket.AddressFamily:
        """AF_INET or AF_INET6."""
        return socket.AddressFamily(self._family)

    @property
    def type(self) -> socket.SocketKind:
        """SOCK_STREAM or SOCK_DGRAM."""
        return socket.SocketKind(self._kind)

    @property
    def timeout(self) -> float | None:
        """As `gettimeout`."""
        return self._timeout

    def fileno(self) -> int:
        """The descriptor, for `select`; -1 when it is closed."""
        return self._fd

    def gettimeout(self) -> float | None:
        """Seconds that a call waits; None for ever."""
        return self._timeout

    def settimeout(self, value: float | None) -> None:
        """Have calls wait so many seconds, None for ever, 0 not at all."""
        if value is not None and value < 0:
            raise ValueError("Timeout value out of range")
        self._timeout = None if value is None else float(value)

    def getblocking(self) -> bool:
        """Whether calls wait at all."""
        return self._timeout != 0

    def setblocking(self, flag: bool) -> None:
        """Have calls wait for ever, or not at all."""
        self._timeout = None if flag else 0.0

    def setsockopt(self, level: int, optname: int, value: Any, optlen: int | None = None) -> None:
        """Options are kept; none has an effect on this network."""
        self._alive()
        self._options[level, optname] = value

    def getsockopt(self, level: int, optname: int, buflen: int = 0) -> Any:
        """An option as it was set, or as it is at the start."""
        self._alive()
        if level == socket.SOL_SOCKET and optname == socket.SO_TYPE:
            return int(self._kind)
        first = _BUFFER_BYTES if optname in (socket.SO_RCVBUF, socket.SO_SNDBUF) else 0
        value = self._options.get((level, optname), first)
        return value if not buflen or isinstance(value, bytes) else int(value).to_bytes(4, "little")[:buflen]

    def getsockname(self) -> tuple[Any, ...]:
        """Its own address."""
        self._alive()
        place = self.endpoint.place or self._listener.place
        if place is not None and isinstance(self.endpoint, Mailbox) and self.endpoint.peer is not None:
            place = place.reached()  # to be connected is to have chosen a way, and with it an address
        return address_of(place or Place("::" if self._family == socket.AF_INET6 else "0.0.0.0", 0))

    def getpeername(self) -> tuple[Any, ...]:
        """The address of the other side."""
        endpoint = self.endpoint
        peer = endpoint.peer if isinstance(endpoint, Mailbox) else self._stream().remote
        if peer is None:
            raise failure(errno.ENOTCONN)
        return address_of(peer)

    # -- below -------------------------------------------------------------------------------------------------------

    def _alive(self) -> None:
        if self._fd < 0:
            raise failure(errno.EBADF)

    def _stream(self) -> Stream:
        self._alive()
        if not isinstance(self.endpoint, Stream):
            raise failure(errno.ENOTCONN)
        return self.endpoint

    def _wait(self, endpoints: Sequence[Endpoint], ready: Callable[[], bool], at_once: bool = False) -> None:
        timeout = 0.0 if at_once else self._timeout
        if not await_endpoints(self.universe, endpoints, lambda: self._fd < 0 or ready(), timeout):
            raise failure(errno.EAGAIN) if timeout == 0 else TimeoutError("timed out")
        self._alive()

"""`socket` of a node: sockets on the mission's virtual network (`cfepy.osal.network`), with virtual timeouts.

If no program of the mission listens at the address of a connection, the socket requests the connection from the bridge
to this computer. In virtual time no outside program could answer, so a mission in virtual time refuses sockets;
`--realtime` joins the networks. `socketpair` needs no network and is always available.
"""

from __future__ import annotations

import errno
import socket
from collections.abc import Callable, Sequence
from types import ModuleType
from typing import TYPE_CHECKING, Any, Self

from cfepy.nodes.made_modules import rebind
from cfepy.nodes.refused_modules import NETWORK, refusal
from cfepy.nodes.stdlib.locks import wait_ns
from cfepy.nodes.stdlib.socket_names import LOCAL, address_of, failure, name_functions, place_of, unreachable
from cfepy.osal import LONGEST_DATAGRAM, Datagram, Endpoint, Listener, Mailbox, Network, Place, Stream
from cfepy.rtos import FOREVER, TIMEOUT, WaitList

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe

_NONBLOCK = getattr(socket, "SOCK_NONBLOCK", 0)  # Windows and macOS do not define it
_OPTIONS_OF_TYPE = _NONBLOCK | getattr(socket, "SOCK_CLOEXEC", 0)
_DONT_WAIT = getattr(socket, "MSG_DONTWAIT", 0)  # Windows does not define it
_BUFFER_BYTES = 212_992
_REFUSED = ("fromfd", "fromshare", "send_fds", "recv_fds", "sethostname")
_REBOUND = ("create_connection", "create_server", "has_dualstack_ipv6")


def await_endpoints(
    universe: Universe,
    endpoints: Sequence[Endpoint],
    ready: Callable[[], bool],
    seconds: float | None,
    waits: WaitList | None = None,
) -> bool:
    """Wait until `ready` returns true; it is checked again whenever an endpoint has changed.

    Args:
        universe: universe of the waiting task.
        endpoints: endpoints to watch.
        ready: returns whether the wait is over.
        seconds: longest wait in seconds; None for no limit.
        waits: wait list to use, if something else, such as a key, can end the wait too.

    Returns:
        False if the time elapsed first.
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


class NodeSocket:
    """A socket, with the methods and errors of `socket.socket`.

    Each node has a subclass, which sets `universe` to the node's.

    Args:
        family: AF_INET or AF_INET6; -1 for AF_INET.
        type: SOCK_STREAM or SOCK_DGRAM; -1 for SOCK_STREAM.
        proto: any protocol.
        fileno: must be None, because descriptors cannot be passed on.
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
        self._timeout = 0.0 if kind & _NONBLOCK else self.universe.sockets.default_timeout
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
        """Return the socket of an existing connection."""
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
        return self._serial  # an address would make the order of a set vary

    def __repr__(self) -> str:
        name = f"{type(self).__module__}.{type(self).__qualname__}"
        state = " [closed]" if self._fd < 0 else ""
        return f"<{name}{state} fd={self._fd}, family={self.family}, type={self.type}, proto={self.proto}>"

    makefile = socket.socket.makefile
    _decref_socketios = socket.socket._decref_socketios  # type: ignore[attr-defined]  # SocketIO calls it

    def close(self) -> None:
        """Close it, once the files made from it are closed too."""
        self._closed = True
        if self._io_refs <= 0:
            self._real_close()

    def detach(self) -> int:
        """Give up the descriptor; a detached socket cannot be used here."""
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
        """Stop reading or writing."""
        stream = self._stream()
        if how not in (socket.SHUT_RD, socket.SHUT_WR, socket.SHUT_RDWR):
            raise failure(errno.EINVAL)
        if not stream.shut(how != socket.SHUT_WR, how != socket.SHUT_RD):
            raise failure(errno.ENOTCONN)

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
        """Return the descriptor, for `select`; -1 if it is closed."""
        return self._fd

    def gettimeout(self) -> float | None:
        """Return the seconds that a call waits; None for no limit."""
        return self._timeout

    def settimeout(self, value: float | None) -> None:
        """Set the seconds that calls wait: None for no limit, 0 for no waiting."""
        if value is not None and value < 0:
            raise ValueError("Timeout value out of range")
        self._timeout = None if value is None else float(value)

    def getblocking(self) -> bool:
        """Return whether calls wait at all."""
        return self._timeout != 0

    def setblocking(self, flag: bool) -> None:
        """Make calls wait without limit, or not at all."""
        self._timeout = None if flag else 0.0

    def setsockopt(self, level: int, optname: int, value: Any, optlen: int | None = None) -> None:
        """Store an option for `getsockopt`; it has no effect on this network."""
        self._alive()
        self._options[level, optname] = value

    def getsockopt(self, level: int, optname: int, buflen: int = 0) -> Any:
        """Return an option as it was set, or its initial value."""
        self._alive()
        if level == socket.SOL_SOCKET and optname == socket.SO_TYPE:
            return int(self._kind)
        first = _BUFFER_BYTES if optname in (socket.SO_RCVBUF, socket.SO_SNDBUF) else 0
        value = self._options.get((level, optname), first)
        return value if not buflen or isinstance(value, bytes) else int(value).to_bytes(4, "little")[:buflen]

    def getsockname(self) -> tuple[Any, ...]:
        """Return its own address."""
        self._alive()
        place = self.endpoint.place or self._listener.place
        if place is not None and isinstance(self.endpoint, Mailbox) and self.endpoint.peer is not None:
            place = place.reached()  # connecting chooses a route, and thus an address
        return address_of(place or Place("::" if self._family == socket.AF_INET6 else "0.0.0.0", 0))

    def getpeername(self) -> tuple[Any, ...]:
        """Return the address of the other side."""
        endpoint = self.endpoint
        peer = endpoint.peer if isinstance(endpoint, Mailbox) else self._stream().remote
        if peer is None:
            raise failure(errno.ENOTCONN)
        return address_of(peer)

    # -- connections -------------------------------------------------------------------------------------------------

    def bind(self, address: Any) -> None:
        """Set the own address."""
        self._alive()
        place = place_of(address, self._family, self.universe.host_name, "bind")
        if self.endpoint.place is not None or self._listener.place is not None:
            raise failure(errno.EINVAL)
        if not place.is_here:
            raise failure(errno.EADDRNOTAVAIL)
        self._take(place)

    def _take(self, place: Place) -> Place:
        endpoint = self.endpoint
        if isinstance(endpoint, Mailbox):
            taken = self._network.datagrams.bind(endpoint, place)
        else:
            taken = self._network.streams.bind(self._listener, place)
        if taken is None:
            raise failure(errno.EADDRINUSE)
        return taken

    def _own_place(self, place: Place | None) -> Place:
        any_host = "::" if self._family == socket.AF_INET6 else "0.0.0.0"
        return place or self._take(Place(any_host, 0))

    def listen(self, backlog: int = 0) -> None:
        """Listen for connections."""
        self._alive()
        if isinstance(self.endpoint, (Mailbox, Stream)):
            raise failure(errno.EOPNOTSUPP if isinstance(self.endpoint, Mailbox) else errno.EINVAL)
        self._own_place(self._listener.place)
        self._listener.listening = True
        self.endpoint = self._listener

    def accept(self) -> tuple[NodeSocket, tuple[Any, ...]]:
        """Wait for a connection; returns its socket and the address of the other side."""
        self._alive()
        server = self.endpoint
        if not isinstance(server, Listener):
            raise failure(errno.EINVAL)
        self._wait([server], lambda: server.readable)
        stream = server.accept()
        return self.joined(stream, self._network, self._family), address_of(stream.remote)

    def connect(self, address: Any) -> None:
        """Connect a stream, or set the peer of datagrams."""
        self._alive()
        place = place_of(address, self._family, self.universe.host_name, "connect")
        endpoint = self.endpoint
        if isinstance(endpoint, Mailbox):
            self._own_place(endpoint.place)
            endpoint.peer = place.reached()
            return
        if isinstance(endpoint, Stream):
            raise failure(errno.EISCONN)
        if not place.is_here:
            raise unreachable()
        self.endpoint = self._connected(place.reached())

    def _connected(self, target: Place) -> Stream:
        server = self._network.streams.find(target)
        if server is not None and server.listening:
            self._wait([server], lambda: server.has_room or not server.listening)
        source = self._own_place(self._listener.place).reached()
        if server is not None and server.listening:
            return server.connect(source, target)
        outside = self._network.dial(source, target) if self._network.dial is not None else None
        if outside is None:
            raise failure(errno.ECONNREFUSED)
        return outside

    def connect_ex(self, address: Any) -> int:
        """As `connect`, returning the errno instead of raising an error."""
        try:
            self.connect(address)
        except socket.gaierror:
            raise
        except TimeoutError:
            return errno.EAGAIN
        except OSError as error:
            return error.errno or errno.EIO
        return 0

    # -- bytes -------------------------------------------------------------------------------------------------------

    def recv(self, bufsize: int, flags: int = 0) -> bytes:
        """Wait for bytes; returns b"" at the end of a stream."""
        return self.recvfrom(bufsize, flags)[0]

    def recvfrom(self, bufsize: int, flags: int = 0) -> tuple[bytes, Any]:
        """Wait for bytes; returns them and the sender's address."""
        self._alive()
        if bufsize < 0:
            raise ValueError("negative buffersize in recvfrom")
        endpoint = self.endpoint
        if not isinstance(endpoint, Mailbox):
            endpoint = self._stream()
        self._wait([endpoint], lambda: endpoint.readable, bool(flags & _DONT_WAIT))
        if isinstance(endpoint, Mailbox):
            if endpoint.take_refusal():
                raise failure(errno.ECONNREFUSED)
            datagram = endpoint.peek() if flags & socket.MSG_PEEK else endpoint.take()
            return datagram.data[:bufsize], address_of(datagram.source)
        return self._read(endpoint, bufsize, flags), None

    def _read(self, stream: Stream, bufsize: int, flags: int) -> bytes:
        if stream.take_reset():
            raise failure(errno.ECONNRESET)
        if flags & socket.MSG_PEEK:
            return stream.peek(bufsize)
        data = stream.read(bufsize)
        while flags & socket.MSG_WAITALL and data and len(data) < bufsize:
            self._wait([stream], lambda: stream.readable)
            more = stream.read(bufsize - len(data))
            if not more:
                break
            data += more
        return data

    def recv_into(self, buffer: Any, nbytes: int = 0, flags: int = 0) -> int:
        """As `recv`, into a buffer; returns the number of bytes."""
        return self.recvfrom_into(buffer, nbytes, flags)[0]

    def recvfrom_into(self, buffer: Any, nbytes: int = 0, flags: int = 0) -> tuple[int, Any]:
        """As `recvfrom`, into a buffer."""
        view = memoryview(buffer).cast("B")
        data, source = self.recvfrom(nbytes or len(view), flags)
        view[: len(data)] = data
        return len(data), source

    def send(self, data: Any, flags: int = 0) -> int:
        """Send as much as there is room for; returns the number of bytes."""
        self._alive()
        raw = bytes(memoryview(data).cast("B"))
        if isinstance(self.endpoint, Mailbox):
            if self.endpoint.peer is None:
                raise failure(errno.EDESTADDRREQ)
            return self._send_datagram(self.endpoint, raw, self.endpoint.peer)
        stream = self._stream()
        self._wait([stream], lambda: stream.writable, bool(flags & _DONT_WAIT))
        count = stream.write(raw)
        if count is None:
            raise failure(errno.EPIPE)
        return count

    def sendall(self, data: Any, flags: int = 0) -> None:
        """Send everything."""
        raw = memoryview(data).cast("B")
        sent = self.send(raw, flags)
        while sent < len(raw):
            sent += self.send(raw[sent:], flags)

    def sendto(self, data: Any, *flags_and_address: Any) -> int:
        """Send a datagram to an address."""
        self._alive()
        place = place_of(flags_and_address[-1], self._family, self.universe.host_name, "sendto")
        if not isinstance(self.endpoint, Mailbox):
            raise failure(errno.EISCONN if isinstance(self.endpoint, Stream) else errno.ENOTCONN)
        return self._send_datagram(self.endpoint, bytes(memoryview(data).cast("B")), place)

    def _send_datagram(self, mailbox: Mailbox, data: bytes, target: Place) -> int:
        if len(data) > LONGEST_DATAGRAM:
            raise failure(errno.EMSGSIZE)
        source = self._own_place(mailbox.place).reached()
        self.universe.charge()
        if mailbox.take_refusal():
            raise failure(errno.ECONNREFUSED)
        if mailbox.peer is not None and self._network.refuses(target):
            mailbox.refused = True
        else:
            self._network.send(Datagram(source, target.reached(), data))
        return len(data)

    def sendfile(self, file: Any, offset: int = 0, count: int | None = None) -> int:
        """Send the contents of a file."""
        file.seek(offset)
        data = file.read() if count is None else file.read(count)
        self.sendall(data)
        return len(data)

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


def socket_module(universe: Universe) -> ModuleType:
    """Return the modules `socket` and `_socket` of a universe."""
    known = universe.importer.modules.get("socket")
    if known is not None:
        return known
    table = universe.sockets
    own = type("socket", (NodeSocket,), {"universe": universe, "__module__": "socket"})

    def set_default(timeout: float | None) -> None:
        table.default_timeout = timeout

    def socketpair(family: Any = None, type: int = socket.SOCK_STREAM, proto: int = 0) -> tuple[Any, Any]:
        near, far = _pair()
        return tuple(own.joined(end, Network(), socket.AF_INET) for end in (near, far))  # type: ignore[attr-defined]

    return rebind(
        socket,
        only=_REBOUND,
        **name_functions(universe.host_name),
        **{name: refusal(universe, f"socket.{name}", NETWORK) for name in _REFUSED if hasattr(socket, name)},
        SocketType=own,
        getdefaulttimeout=lambda: table.default_timeout,
        if_nameindex=lambda: [(1, "lo")],
        setdefaulttimeout=set_default,
        socket=own,
        socketpair=socketpair,
    )


def _pair() -> tuple[Stream, Stream]:
    """Two streams that are connected with each other."""
    place = Place(LOCAL, 0)
    near, far = Stream(place, place, is_tcp=False), Stream(place, place, is_tcp=False)
    near.other, far.other = far, near
    return near, far

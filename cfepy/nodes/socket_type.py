"""`socket.socket` of a node, on the mission's virtual network (`cfepy.osal.endpoints`).

Its time-outs are virtual time. A connection to a place where nobody of the mission listens is asked of the bridge to
this computer. May import cfepy.osal.
"""

from __future__ import annotations

import errno
import socket
from typing import Any

from cfepy.nodes.socket_base import SocketBase
from cfepy.nodes.socket_names import address_of, failure, place_of, unreachable
from cfepy.osal.endpoints import LONGEST_DATAGRAM, Datagram, Listener, Mailbox, Place, Stream


class NodeSocket(SocketBase):
    """A socket; the methods are those of `socket.socket`, and so are the errors."""

    # -- connections -------------------------------------------------------------------------------------------------

    def bind(self, address: Any) -> None:
        """Take an address."""
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
        """Take connections."""
        self._alive()
        if isinstance(self.endpoint, (Mailbox, Stream)):
            raise failure(errno.EOPNOTSUPP if isinstance(self.endpoint, Mailbox) else errno.EINVAL)
        self._own_place(self._listener.place)
        self._listener.listening = True
        self.endpoint = self._listener

    def accept(self) -> tuple[NodeSocket, tuple[Any, ...]]:
        """Wait for a connection; its socket and the address of the other side."""
        self._alive()
        server = self.endpoint
        if not isinstance(server, Listener):
            raise failure(errno.EINVAL)
        self._wait([server], lambda: server.readable)
        stream = server.accept()
        return self.joined(stream, self._network, self._family), address_of(stream.remote)

    def connect(self, address: Any) -> None:
        """Connect a stream, or say whom to exchange datagrams with."""
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
        """As `connect`, with the errno in place of an error."""
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
        """Wait for bytes; b"" at the end of a stream."""
        return self.recvfrom(bufsize, flags)[0]

    def recvfrom(self, bufsize: int, flags: int = 0) -> tuple[bytes, Any]:
        """Wait for bytes, and from whom they are."""
        self._alive()
        if bufsize < 0:
            raise ValueError("negative buffersize in recvfrom")
        endpoint = self.endpoint
        if not isinstance(endpoint, Mailbox):
            endpoint = self._stream()
        self._wait([endpoint], lambda: endpoint.readable, bool(flags & socket.MSG_DONTWAIT))
        if isinstance(endpoint, Mailbox):
            datagram = endpoint.peek() if flags & socket.MSG_PEEK else endpoint.take()
            return datagram.data[:bufsize], address_of(datagram.source)
        return self._read(endpoint, bufsize, flags), None

    def _read(self, stream: Stream, bufsize: int, flags: int) -> bytes:
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
        """As `recv`, into a buffer; how many bytes."""
        return self.recvfrom_into(buffer, nbytes, flags)[0]

    def recvfrom_into(self, buffer: Any, nbytes: int = 0, flags: int = 0) -> tuple[int, Any]:
        """As `recvfrom`, into a buffer."""
        view = memoryview(buffer).cast("B")
        data, source = self.recvfrom(nbytes or len(view), flags)
        view[: len(data)] = data
        return len(data), source

    def send(self, data: Any, flags: int = 0) -> int:
        """Send what there is room for; how many bytes."""
        self._alive()
        raw = bytes(memoryview(data).cast("B"))
        if isinstance(self.endpoint, Mailbox):
            if self.endpoint.peer is None:
                raise failure(errno.EDESTADDRREQ)
            return self._send_datagram(self.endpoint, raw, self.endpoint.peer)
        stream = self._stream()
        self._wait([stream], lambda: stream.writable, bool(flags & socket.MSG_DONTWAIT))
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
        """Send a datagram somewhere."""
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
        self._network.send(Datagram(source, target.reached(), data))
        return len(data)

    def sendfile(self, file: Any, offset: int = 0, count: int | None = None) -> int:
        """Send what is in a file."""
        file.seek(offset)
        data = file.read() if count is None else file.read(count)
        self.sendall(data)
        return len(data)

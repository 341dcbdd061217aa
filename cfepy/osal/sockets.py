"""OSAL's sockets and select (osapi-sockets.h, osapi-select.h) on the virtual network: IPv4 and IPv6, in virtual time.

A socket is a descriptor. Stream sockets send and receive with `read` and `write` (`cfepy.osal.streams`), datagram
sockets with their own functions. Select waits until one of several descriptors can be read or written. A file always
can.
"""

from __future__ import annotations

from typing import NamedTuple

from cfepy.ids import OS_STREAM_BASE, get_base
from cfepy.osal import sockaddr
from cfepy.osal.clock import OsTime
from cfepy.osal.core import check_size
from cfepy.osal.files import OsStream
from cfepy.osal.limits import OS_MAX_API_NAME, OS_PEND
from cfepy.osal.network import Place, Stream
from cfepy.osal.sockaddr import SockAddr, check_address, check_given, check_target, from_place
from cfepy.osal.streams import OS_SocketType_DATAGRAM, OS_SocketType_STREAM, OsSocket, StreamApi, ns_of
from cfepy.status import (
    OS_ERR_INCORRECT_OBJ_STATE,
    OS_ERR_INVALID_ARGUMENT,
    OS_ERR_INVALID_ID,
    OS_ERR_NAME_NOT_FOUND,
    OS_ERR_NOT_IMPLEMENTED,
    OS_ERROR,
    OS_INVALID_POINTER,
    OsalError,
)

OS_SocketShutdownMode_SHUT_READ = 1
OS_SocketShutdownMode_SHUT_WRITE = 2
OS_SocketShutdownMode_SHUT_READWRITE = 3
OS_socket_option_UNDEFINED = 0
OS_socket_option_IP_DSCP = 1
DSCP_BITS = 0x3F
OS_STREAM_STATE_BOUND = 0x01
OS_STREAM_STATE_CONNECTED = 0x02
OS_STREAM_STATE_READABLE = 0x04
OS_STREAM_STATE_WRITABLE = 0x08
OS_STREAM_STATE_LISTENING = 0x10


class DatagramApi(StreamApi):
    """The functions that only datagram sockets have."""

    def socket_send_to(self, sock_id: int, buffer: bytes | bytearray | memoryview, remote_addr: SockAddr) -> int:
        """Send a datagram; never waits (OS_SocketSendTo). Without a receiver it is lost, as with UDP.

        Args:
            sock_id: a datagram socket.
            buffer: the data, at least a byte.
            remote_addr: target address.

        Returns:
            The number of bytes.

        Raises:
            OsalError: OS_ERR_INVALID_SIZE, OS_INVALID_POINTER, OS_ERR_INVALID_ID, OS_ERR_INCORRECT_OBJ_TYPE,
                OS_ERR_BAD_ADDRESS; OS_ERROR for an address of another domain or without one, or for more data than UDP
                carries.
        """
        check_size(len(buffer), "datagram")
        check_given(remote_addr)
        record = self._socket(sock_id, OS_SocketType_DATAGRAM)
        check_target(remote_addr)
        if remote_addr.domain != record.domain:
            raise record.error(f"cannot send to {remote_addr!r}, an address of another domain")
        return self._send(record, bytes(buffer), remote_addr.place)

    def socket_recv_from(self, sock_id: int, buflen: int, timeout_ms: int = OS_PEND) -> tuple[bytes, SockAddr] | None:
        """Receive a datagram (OS_SocketRecvFrom).

        Args:
            sock_id: a bound datagram socket.
            buflen: buffer size in bytes; a longer datagram is truncated.
            timeout_ms: OS_PEND (-1) waits without limit, OS_CHECK (0) does not wait.

        Returns:
            The data and the sender's address, or None after the timeout.

        Raises:
            OsalError: OS_ERR_INVALID_SIZE, OS_ERR_INVALID_ID, OS_ERR_INCORRECT_OBJ_TYPE if it is not a datagram socket,
                OS_ERR_INCORRECT_OBJ_STATE if it is not bound.
        """
        return self._recv_from(sock_id, buflen, ns_of(timeout_ms))

    def socket_recv_from_abs(self, sock_id: int, buflen: int, abs_timeout: OsTime) -> tuple[bytes, SockAddr] | None:
        """Receive a datagram, waiting until a local time; see `socket_recv_from` (OS_SocketRecvFromAbs)."""
        return self._recv_from(sock_id, buflen, self._ns_until(abs_timeout))

    def _recv_from(self, sock_id: int, buflen: int, timeout_ns: int) -> tuple[bytes, SockAddr] | None:
        check_size(buflen, "receive buffer")
        record = self._socket(sock_id, OS_SocketType_DATAGRAM)
        if not record.bound:
            raise OsalError(OS_ERR_INCORRECT_OBJ_STATE, f"socket {record.name} is not bound")
        if not self._wait_readable(record, timeout_ns):
            return None
        datagram = self._next_datagram(record)
        data = datagram.data[:buflen]
        self._charge_bytes(len(data))
        return data, from_place(datagram.source)


class NoName(Exception):
    """A read of the name of a socket that has none: on Linux, SIGSEGV.

    Attributes:
        ends_process: SIGSEGV ends NASA's process on Linux.
    """

    ends_process = True


class SocketInfo(NamedTuple):
    """The result of `socket_get_info` (OS_socket_prop_t)."""

    name: str
    creator: int


class SocketApi(DatagramApi):
    """The OS_Socket* functions."""

    socket_addr_init = staticmethod(sockaddr.socket_addr_init)
    socket_addr_to_string = staticmethod(sockaddr.socket_addr_to_string)
    socket_addr_from_string = staticmethod(sockaddr.socket_addr_from_string)
    socket_addr_get_port = staticmethod(sockaddr.socket_addr_get_port)
    socket_addr_set_port = staticmethod(sockaddr.socket_addr_set_port)

    # -- opening and binding -----------------------------------------------------------------------------------------

    def socket_open(self, domain: int, kind: int) -> int:
        """Make a socket (OS_SocketOpen).

        Args:
            domain: OS_SocketDomain_INET or OS_SocketDomain_INET6.
            kind: OS_SocketType_DATAGRAM or OS_SocketType_STREAM.

        Returns:
            Its id, also valid for `read`, `write` and `close`.

        Raises:
            OsalError: OS_ERR_NOT_IMPLEMENTED for another domain or kind; OS_ERR_NO_FREE_IDS.
        """
        if kind not in (OS_SocketType_DATAGRAM, OS_SocketType_STREAM) or domain not in sockaddr.ANY_HOST:
            raise OsalError(OS_ERR_NOT_IMPLEMENTED, f"unknown socket domain {domain} and type {kind}")
        return self._register(self._streams, OsSocket(self._next_name(), domain, kind), "socket", 0)

    def socket_bind_address(self, sock_id: int, addr: SockAddr) -> None:
        """Give a socket its local address (OS_SocketBindAddress).

        Args:
            sock_id: the socket.
            addr: the local address; port 0 takes any free port.

        Raises:
            OsalError: OS_INVALID_POINTER, OS_ERR_INVALID_ID, OS_ERR_INCORRECT_OBJ_TYPE for a file,
                OS_ERR_INCORRECT_OBJ_STATE if it is bound or connected, OS_ERR_BAD_ADDRESS; OS_ERROR if the address is
                taken, is not on this network, or is of another domain.
        """
        check_given(addr)
        record = self._socket(sock_id)
        if record.bound or record.connected:
            raise OsalError(OS_ERR_INCORRECT_OBJ_STATE, f"socket {record.name} is bound or connected")
        check_address(addr)
        if addr.domain != record.domain:
            raise record.error(f"cannot be bound to {addr!r}, an address of another domain")
        self._take_place(record, addr.place)
        self._entitle(record, addr.place)
        record.bound = True

    def socket_listen(self, sock_id: int) -> None:
        """Make a stream socket accept connections (OS_SocketListen).

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERR_INCORRECT_OBJ_TYPE if it is not a stream socket,
                OS_ERR_INCORRECT_OBJ_STATE if it is not bound, already listens or is connected.
        """
        record = self._socket(sock_id, OS_SocketType_STREAM)
        if not record.bound or record.connected or record.listener.listening:
            raise OsalError(OS_ERR_INCORRECT_OBJ_STATE, f"socket {record.name} cannot listen now")
        record.listener.listening = True
        record.endpoint = record.listener

    def socket_bind(self, sock_id: int, addr: SockAddr) -> None:
        """Bind a socket, and make a stream socket listen (OS_SocketBind); see the two functions above for the
        errors.
        """
        self.socket_bind_address(sock_id, addr)
        if self._socket(sock_id).kind == OS_SocketType_STREAM:
            self.socket_listen(sock_id)

    # -- connections -------------------------------------------------------------------------------------------------

    def socket_connect(self, sock_id: int, addr: SockAddr, timeout_ms: int = OS_PEND) -> bool:
        """Connect a stream socket, or set the peer of a datagram socket (OS_SocketConnect).

        Args:
            sock_id: the socket.
            addr: the peer.
            timeout_ms: longest time in ms to wait while the peer has no room; OS_PEND for no limit.

        Returns:
            False after the timeout.

        Raises:
            OsalError: OS_INVALID_POINTER, OS_ERR_INVALID_ID, OS_ERR_INCORRECT_OBJ_TYPE for a file,
                OS_ERR_INCORRECT_OBJ_STATE for a connected stream socket, OS_ERR_BAD_ADDRESS; OS_ERROR if no socket
                listens there, or for an address of another domain or without one.
        """
        return self._connect(sock_id, addr, ns_of(timeout_ms))

    def socket_connect_abs(self, sock_id: int, addr: SockAddr, abs_timeout: OsTime) -> bool:
        """Connect a socket, waiting until a local time; see `socket_connect` (OS_SocketConnectAbs)."""
        return self._connect(sock_id, addr, self._ns_until(abs_timeout))

    def _connect(self, sock_id: int, addr: SockAddr, timeout_ns: int) -> bool:
        check_given(addr)
        record = self._socket(sock_id)
        if record.connected and record.kind == OS_SocketType_STREAM:
            raise OsalError(OS_ERR_INCORRECT_OBJ_STATE, f"socket {record.name} is connected")
        check_target(addr)
        if addr.domain != record.domain:
            raise record.error(f"cannot be connected to {addr!r}, an address of another domain")
        if record.kind == OS_SocketType_DATAGRAM:
            record.mailbox.peer = addr.place
        elif not self._connect_stream(record, addr.place.reached(), timeout_ns):
            return False
        record.connected = True
        return True

    def _connect_stream(self, record: OsSocket, target: Place, timeout_ns: int) -> bool:
        server = self.network.streams.find(target)
        if record.refused:
            record.refused = False
            raise record.error("cannot be connected at once after a refusal")
        if server is None or not server.listening or record.listener.listening:
            record.refused = not record.listener.listening
            raise record.error(f"cannot be connected to {target.host}:{target.port}")

        def decided() -> bool:
            return server.has_room or not server.listening or record.deleted

        if not self._await([record], [record.endpoint, server], decided, timeout_ns):
            return False
        self._check_alive(record)
        if not server.listening:
            record.refused = True
            raise record.error(f"has lost its peer at {target.host}:{target.port}")
        source = record.listener.place or self._take_place(record, SockAddr(record.domain).place)
        record.endpoint = server.connect(source.reached(), target)
        return True

    def socket_accept(self, sock_id: int, timeout_ms: int = OS_PEND) -> tuple[int, SockAddr] | None:
        """Wait for a connection (OS_SocketAccept).

        Args:
            sock_id: a listening socket.
            timeout_ms: OS_PEND (-1) waits without limit, OS_CHECK (0) does not wait.

        Returns:
            The socket of the connection and the peer's address, or None after the timeout.

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERR_INCORRECT_OBJ_TYPE if it is not a stream socket,
                OS_ERR_INCORRECT_OBJ_STATE if it is not bound, OS_ERROR if it does not listen, OS_ERR_NO_FREE_IDS.
        """
        return self._accept(sock_id, ns_of(timeout_ms))

    def socket_accept_abs(self, sock_id: int, abs_timeout: OsTime) -> tuple[int, SockAddr] | None:
        """Wait for a connection until a local time; see `socket_accept` (OS_SocketAcceptAbs)."""
        return self._accept(sock_id, self._ns_until(abs_timeout))

    def _accept(self, sock_id: int, timeout_ns: int) -> tuple[int, SockAddr] | None:
        record = self._socket(sock_id, OS_SocketType_STREAM)
        if not record.bound or record.connected:
            raise OsalError(OS_ERR_INCORRECT_OBJ_STATE, f"socket {record.name} is not bound, or is connected")
        server = record.listener
        if not server.listening:
            raise record.error("is not listening")
        if not self._await([record], [server], lambda: server.readable or record.deleted, timeout_ns):
            return None
        self._check_alive(record)
        accepted = OsSocket(self._next_name(), record.domain, record.kind)
        self._register(self._streams, accepted, "socket", 0)
        stream = server.accept()
        accepted.endpoint, accepted.connected = stream, True
        self._entitle(accepted, stream.remote, f"-{record.name}")
        return accepted.id, from_place(stream.remote)

    def socket_shutdown(self, sock_id: int, mode: int) -> None:
        """Shut a connection down for reading or writing, and notify the peer (OS_SocketShutdown).

        Args:
            sock_id: a connected socket.
            mode: OS_SocketShutdownMode_SHUT_READ, _SHUT_WRITE or _SHUT_READWRITE.

        Raises:
            OsalError: OS_ERR_INVALID_ARGUMENT, OS_ERR_INVALID_ID, OS_ERR_INCORRECT_OBJ_TYPE for a file,
                OS_ERR_INCORRECT_OBJ_STATE for a stream socket without connection; OS_ERROR if the connection is over,
                and for a datagram socket without peer, which is shut down nevertheless.
        """
        if mode not in (1, 2, 3):
            raise OsalError(OS_ERR_INVALID_ARGUMENT, f"unknown shutdown mode {mode}")
        record = self._socket(sock_id)
        endpoint, read, write = record.endpoint, bool(mode & 1), bool(mode & 2)
        if isinstance(endpoint, Stream):
            if not endpoint.shut(read, write):
                raise record.error("has lost its connection")
        elif record.kind == OS_SocketType_STREAM:
            raise OsalError(OS_ERR_INCORRECT_OBJ_STATE, f"{record.name} is not connected")
        else:
            record.mailbox.read_shut |= read
            record.mailbox.write_shut |= write
            record.mailbox.changed()
            if not record.connected:
                raise record.error("has no peer")

    # -- facts and options -------------------------------------------------------------------------------------------

    def socket_get_id_by_name(self, sock_name: str) -> int:
        """Return the id of a socket by its name (OS_SocketGetIdByName).

        The name is its address, such as "localhost:1234", or "REMOTE-LOCAL" for a connection.

        Raises:
            OsalError: OS_ERR_NAME_NOT_FOUND, or OS_ERR_NAME_TOO_LONG for 20 characters and more.
        """
        self._streams.check_name(sock_name)
        for sock_id, record in self._streams.items():
            if isinstance(record, OsSocket) and record.name == sock_name:
                return sock_id
        raise OsalError(OS_ERR_NAME_NOT_FOUND, f"unknown socket {sock_name!r}")

    def socket_get_info(self, sock_id: int) -> SocketInfo:
        """Return facts about a socket (OS_SocketGetInfo).

        Args:
            sock_id: the socket, or a file.

        Returns:
            The name, cut to 19 characters, and the creator. A safe mission gives a socket without address a name.

        Raises:
            OsalError: OS_ERR_INVALID_ID.
            NoName: the socket has no address, and the mission is not safe.
        """
        record = self._stream(sock_id)
        if not record.path and self._is_strict:
            raise NoName("OS_SocketGetInfo of a socket without address; bind it first (SIGSEGV in strncpy)")
        return SocketInfo((record.path or record.name)[: OS_MAX_API_NAME - 1], record.creator)

    def socket_get_option(self, sock_id: int, opt_id: int) -> int:
        """Return an option of a socket (OS_SocketGetOption).

        Args:
            sock_id: the socket.
            opt_id: OS_socket_option_IP_DSCP; OS_socket_option_UNDEFINED always reads 0.

        Raises:
            OsalError: OS_ERR_INVALID_ARGUMENT, OS_ERR_INVALID_ID; OS_ERROR for a file.
        """
        record = self._with_option(sock_id, opt_id)
        return record.dscp if record is not None else 0

    def socket_set_option(self, sock_id: int, opt_id: int, optval: int) -> None:
        """Set an option of a socket (OS_SocketSetOption); the network ignores it.

        Args:
            sock_id: the socket.
            opt_id: OS_socket_option_IP_DSCP; OS_socket_option_UNDEFINED does nothing.
            optval: the new value; 6 bits of it count.

        Raises:
            OsalError: OS_ERR_INVALID_ARGUMENT, OS_ERR_INVALID_ID; OS_ERROR for a file.
        """
        record = self._with_option(sock_id, opt_id)
        if record is not None:
            record.dscp = optval & DSCP_BITS

    def _with_option(self, sock_id: int, opt_id: int) -> OsSocket | None:
        """Return the socket for an option, or None for OS_socket_option_UNDEFINED."""
        if opt_id not in (OS_socket_option_UNDEFINED, OS_socket_option_IP_DSCP):
            raise OsalError(OS_ERR_INVALID_ARGUMENT, f"unknown socket option {opt_id}")
        record = self._stream(sock_id)
        if opt_id == OS_socket_option_UNDEFINED:
            return None
        if not isinstance(record, OsSocket):
            raise OsalError(OS_ERROR, f"descriptor {sock_id:#x} is a file")
        return record

    def _entitle(self, record: OsSocket, place: Place, more: str = "") -> None:
        """Name a socket after its address, like OS_CreateSocketName."""
        self._streams.names.pop(record.name, None)
        record.name = record.path = f"{sockaddr.host_name(place.host)}:{place.port}{more}"


class FdSet:
    """A set of descriptors (OS_FdSet); filled by `select_fd_add` and changed by `select_multiple`.

    Attributes:
        slots: slots in the table of descriptors, ascending.
    """

    __slots__ = ("slots",)

    def __init__(self) -> None:
        self.slots: list[int] = []


class SelectApi(SocketApi):
    """The OS_Select* functions."""

    def select_single(self, objid: int, state_flags: int, msecs: int = OS_PEND) -> int | None:
        """Wait until a descriptor can be read or written (OS_SelectSingle).

        Args:
            objid: a socket or a file.
            state_flags: the states to wait for: OS_STREAM_STATE_READABLE, OS_STREAM_STATE_WRITABLE or both; 0 never
                waits.
            msecs: OS_PEND (-1) waits without limit, OS_CHECK (0) does not wait.

        Returns:
            The flags that are true, or None after the timeout.

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        return self._select_single(objid, state_flags, ns_of(msecs))

    def select_single_abs(self, objid: int, state_flags: int, abs_timeout: OsTime) -> int | None:
        """Wait for a descriptor until a local time; see `select_single` (OS_SelectSingleAbs)."""
        return self._select_single(objid, state_flags, self._ns_until(abs_timeout))

    def select_multiple(self, read_set: FdSet | None, write_set: FdSet | None, msecs: int = OS_PEND) -> bool:
        """Wait until a descriptor of `read_set` can be read or one of `write_set` can be written (OS_SelectMultiple).

        Args:
            read_set: descriptors to read from; afterwards only the readable ones are left in it. None for no
                descriptor.
            write_set: the same for writing.
            msecs: OS_PEND (-1) waits without limit, OS_CHECK (0) does not wait.

        Returns:
            False after the timeout; the sets are unchanged then.

        Raises:
            OsalError: OS_ERR_INVALID_ID if there is no open descriptor in the sets.
        """
        return self._select_multiple(read_set, write_set, ns_of(msecs))

    def select_multiple_abs(self, read_set: FdSet | None, write_set: FdSet | None, abs_timeout: OsTime) -> bool:
        """Wait for descriptors until a local time; see `select_multiple` (OS_SelectMultipleAbs)."""
        return self._select_multiple(read_set, write_set, self._ns_until(abs_timeout))

    def select_fd_zero(self, fd_set: FdSet) -> None:
        """Empty a set (OS_SelectFdZero); raises OS_INVALID_POINTER."""
        _given(fd_set).slots.clear()

    def select_fd_add(self, fd_set: FdSet, objid: int) -> None:
        """Add a descriptor (OS_SelectFdAdd); raises OS_INVALID_POINTER, OS_ERR_INVALID_ID."""
        slots, slot = _given(fd_set).slots, self._slot(objid)
        if slot not in slots:
            slots.append(slot)
            slots.sort()

    def select_fd_clear(self, fd_set: FdSet, objid: int) -> None:
        """Remove a descriptor, if it is in the set (OS_SelectFdClear); raises OS_INVALID_POINTER, OS_ERR_INVALID_ID."""
        slots, slot = _given(fd_set).slots, self._slot(objid)
        if slot in slots:
            slots.remove(slot)

    def select_fd_is_set(self, fd_set: FdSet, objid: int) -> bool:
        """Return whether a descriptor is in a set (OS_SelectFdIsSet)."""
        return get_base(objid) == OS_STREAM_BASE and self._streams.index(objid) in fd_set.slots

    def _select_single(self, objid: int, wanted: int, timeout_ns: int) -> int | None:
        record = self._stream(objid)
        if not wanted:
            return 0
        sockets = [record] if isinstance(record, OsSocket) else []
        endpoints = [each.endpoint for each in sockets]
        if not self._await(sockets, endpoints, lambda: record.deleted or _state(record) & wanted != 0, timeout_ns):
            return None
        if record.deleted:
            raise self._streams.gone(record)
        return _state(record) & wanted

    def _select_multiple(self, read_set: FdSet | None, write_set: FdSet | None, timeout_ns: int) -> bool:
        readers, writers = self._open_of(read_set), self._open_of(write_set)
        if not readers and not writers:
            raise OsalError(OS_ERR_INVALID_ID, "missing descriptor to wait for")

        def ready() -> bool:
            return any(_can(record, OS_STREAM_STATE_READABLE) for record in readers) or any(
                _can(record, OS_STREAM_STATE_WRITABLE) for record in writers
            )

        sockets = [record for record in (*readers, *writers) if isinstance(record, OsSocket)]
        if not self._await(sockets, [record.endpoint for record in sockets], ready, timeout_ns):
            return False
        self._keep(read_set, readers, OS_STREAM_STATE_READABLE)
        self._keep(write_set, writers, OS_STREAM_STATE_WRITABLE)
        return True

    def _open_of(self, fd_set: FdSet | None) -> list[OsStream]:
        found = [self._streams.at(slot) for slot in fd_set.slots] if fd_set is not None else []
        return [record for record in found if record is not None]

    def _keep(self, fd_set: FdSet | None, records: list[OsStream], flag: int) -> None:
        if fd_set is not None:
            fd_set.slots = [self._streams.index(record.id) for record in records if _can(record, flag)]

    def _slot(self, objid: int) -> int:
        if get_base(objid) != OS_STREAM_BASE:
            raise OsalError(OS_ERR_INVALID_ID, f"{objid:#x} is not a descriptor")
        return self._streams.index(objid)


def _state(record: OsStream) -> int:
    """Return the flags OS_STREAM_STATE_READABLE and OS_STREAM_STATE_WRITABLE that are true now."""
    if not isinstance(record, OsSocket):
        return OS_STREAM_STATE_READABLE | OS_STREAM_STATE_WRITABLE
    endpoint = record.endpoint
    return OS_STREAM_STATE_READABLE * endpoint.readable | OS_STREAM_STATE_WRITABLE * endpoint.writable


def _can(record: OsStream, flag: int) -> bool:
    return not record.deleted and _state(record) & flag != 0


def _given(fd_set: FdSet | None) -> FdSet:
    if fd_set is None:
        raise OsalError(OS_INVALID_POINTER, "missing set of descriptors")
    return fd_set

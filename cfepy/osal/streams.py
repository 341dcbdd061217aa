"""Descriptors that may be sockets: read, write, close, and waiting for them.

On a file these are the functions of `cfepy.osal.files`, which never wait.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from cfepy.osal.clock import OS_TIME_MAX, OS_TIME_TICK_RESOLUTION_NS, ClockApi, OsTime
from cfepy.osal.core import Setup, check_size
from cfepy.osal.files import FileApi, OsStream
from cfepy.osal.limits import OS_PEND
from cfepy.osal.network import LONGEST_DATAGRAM, Datagram, Endpoint, Listener, Mailbox, Place, Stream
from cfepy.osal.sockaddr import ANY_HOST
from cfepy.rtos import FOREVER, WaitList
from cfepy.status import OS_ERR_INCORRECT_OBJ_TYPE, OS_ERR_OBJECT_IN_USE, OS_ERROR, OsalError
from cfepy.units import NS_PER_MS

OS_SocketType_DATAGRAM = 1
OS_SocketType_STREAM = 2
RELEASE_ATTEMPTS = 5
RELEASE_STEP_NS = 10_000_000
"""OSAL waits 10, 40, 90 and 160 ms for the release of an object (OS_WaitForStateChange_Impl)."""


class OsSocket(OsStream):
    """The record of a socket; its name is its address, once it has one.

    Args:
        name: its name until it has an address.
        domain: OS_SocketDomain_INET or OS_SocketDomain_INET6.
        kind: OS_SocketType_DATAGRAM or OS_SocketType_STREAM.

    Attributes:
        endpoint: its present end of the network.
        mailbox: the receiver of a datagram socket.
        listener: the owner of the TCP port of a stream socket.
        dscp: the option IP_DSCP.
        users_waiting: number of calls that wait at it. A task that is deleted in such a call counts forever, as the
            reference count of NASA's OSAL does.
        refused: whether the last attempt to connect failed, so that the next one fails at once, as on Linux.
    """

    __slots__ = (
        *("bound", "connected", "domain", "dscp", "endpoint", "kind", "listener", "mailbox", "refused"),
        "users_waiting",
    )

    def __init__(self, name: str, domain: int, kind: int) -> None:
        super().__init__(name)
        self.domain = domain
        self.kind = kind
        self.mailbox = Mailbox()
        self.listener = Listener()
        self.endpoint: Endpoint = self.mailbox if kind == OS_SocketType_DATAGRAM else Endpoint()
        self.bound = self.connected = self.refused = False
        self.dscp = 0
        self.users_waiting = 0

    def error(self, what: str) -> OsalError:
        """Return the error for a call that the host's network code would refuse."""
        return OsalError(OS_ERROR, f"socket {self.name} {what}")


class StreamApi(ClockApi, FileApi):
    """`read`, `write` and `close` for sockets and files, with timeouts."""

    def __init__(self, setup: Setup) -> None:
        super().__init__(setup)
        self.network = setup.network

    def read(self, filedes: int, nbytes: int) -> bytes:
        """Read from a file, or wait for bytes from a socket (OS_read); b"" at the end.

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERR_INVALID_SIZE, OS_ERROR if it is not open for reading or connected.
        """
        return self._timed_read(filedes, nbytes, FOREVER) or b""

    def timed_read(self, filedes: int, nbytes: int, timeout_ms: int = OS_PEND) -> bytes | None:
        """Read like `read`, waiting at most `timeout_ms`; return None after the timeout (OS_TimedRead)."""
        return self._timed_read(filedes, nbytes, ns_of(timeout_ms))

    def timed_read_abs(self, filedes: int, nbytes: int, abstime: OsTime) -> bytes | None:
        """Read like `read`, waiting until a local time; return None after it (OS_TimedReadAbs)."""
        return self._timed_read(filedes, nbytes, self._ns_until(abstime))

    def write(self, filedes: int, data: bytes | bytearray | memoryview) -> int:
        """Write to a file, or wait for room at a socket and write the bytes that fit (OS_write); return their number.

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERR_INVALID_SIZE, OS_ERROR if it is not open for writing, the disk is full,
                or no reader is left.
        """
        return self._timed_write(filedes, data, FOREVER) or 0

    def timed_write(self, filedes: int, data: bytes | bytearray | memoryview, timeout_ms: int = OS_PEND) -> int | None:
        """Write like `write`, waiting at most `timeout_ms`; return None after the timeout (OS_TimedWrite)."""
        return self._timed_write(filedes, data, ns_of(timeout_ms))

    def timed_write_abs(self, filedes: int, data: bytes | bytearray | memoryview, abstime: OsTime) -> int | None:
        """Write like `write`, waiting until a local time; return None after it (OS_TimedWriteAbs)."""
        return self._timed_write(filedes, data, self._ns_until(abstime))

    def close(self, filedes: int) -> None:
        """Close a file or a socket (OS_close).

        While a task waits at the socket, the call tries for 300 ms, and then fails. In a safe mission that task gets
        OS_ERR_INVALID_ID.

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERR_OBJECT_IN_USE.
        """
        stream = self._streams.lookup(filedes)
        if isinstance(stream, OsSocket) and stream.users_waiting and self._is_strict:
            self._await_release(stream)
        super().close(filedes)
        if isinstance(stream, OsSocket):
            self._unplug(stream)

    def _timed_read(self, filedes: int, nbytes: int, timeout_ns: int) -> bytes | None:
        check_size(nbytes, "read")
        record = self._streams.lookup(filedes)
        if not isinstance(record, OsSocket):
            return super().read(filedes, nbytes)
        self._stream(filedes)  # the call costs as much as on a file
        if record.refused:
            return b""
        is_idle = record.kind == OS_SocketType_STREAM and not isinstance(record.endpoint, Stream)
        if not (is_idle and not record.listener.listening) and not self._wait_readable(record, timeout_ns):
            return None
        if is_idle:
            raise record.error("is not connected")
        endpoint = record.endpoint
        if isinstance(endpoint, Stream):
            if endpoint.take_reset():
                raise record.error("was reset by its peer")
            data = endpoint.read(nbytes)
        else:
            data = self._next_datagram(record).data[:nbytes]
        self._charge_bytes(len(data))
        return data

    def _next_datagram(self, record: OsSocket) -> Datagram:
        mailbox = record.mailbox
        if mailbox.take_refusal():
            raise record.error("has no peer")
        if mailbox.is_empty:
            raise record.error("was shut down for reading")
        return mailbox.take()

    def _timed_write(self, filedes: int, data: bytes | bytearray | memoryview, timeout_ns: int) -> int | None:
        check_size(len(data), "write")
        record = self._streams.lookup(filedes)
        if not isinstance(record, OsSocket):
            return super().write(filedes, data)
        self._stream(filedes)
        peer = record.mailbox.peer
        if peer is not None:
            return self._send(record, bytes(data), peer)
        stream = record.endpoint
        if not isinstance(stream, Stream):
            if record.listener.listening and not self._await([record], [stream], lambda: record.deleted, timeout_ns):
                return None
            raise record.error("is not connected")
        if not self._await([record], [stream], lambda: record.deleted or stream.writable, timeout_ns):
            return None
        self._check_alive(record)
        count = stream.write(bytes(data))
        if count is None:
            raise record.error("has no peer")
        self._charge_bytes(count)
        return count

    def _send(self, record: OsSocket, data: bytes, target: Place) -> int:
        """Send a datagram."""
        if len(data) > LONGEST_DATAGRAM:
            raise record.error(f"cannot send {len(data)} bytes at once")
        self._charge_bytes(len(data))
        self._check_alive(record)  # a more urgent task may have closed it, and a port taken now would never be released
        mailbox = record.mailbox
        if mailbox.write_shut:
            raise record.error("was shut down for writing")
        if mailbox.take_refusal():
            raise record.error("has no peer")
        source = mailbox.place or self._take_place(record, Place(ANY_HOST[record.domain], 0))
        if mailbox.peer is not None and self.network.refuses(target):
            mailbox.refused = True
        else:
            self.network.send(Datagram(source.reached(), target, data))
        return len(data)

    # -- plugging in and out -----------------------------------------------------------------------------------------

    def _take_place(self, record: OsSocket, place: Place) -> Place:
        """Bind a socket on the network and return its address."""
        if record.kind == OS_SocketType_DATAGRAM:
            taken = self.network.datagrams.bind(record.mailbox, place)
        else:
            taken = self.network.streams.bind(record.listener, place)
        if taken is None:
            raise record.error(f"cannot be bound to {place.host}:{place.port}")
        return taken

    def _await_release(self, record: OsSocket) -> None:
        """Wait until no call waits at a socket, which has no id meanwhile (OS_ObjectIdConvertToken).

        Raises:
            OsalError: OS_ERR_OBJECT_IN_USE after 300 ms.
        """
        del self._streams.records[record.id]
        try:
            for attempt in range(1, RELEASE_ATTEMPTS):
                self.kernel.delay(attempt * attempt * RELEASE_STEP_NS)
                if not record.users_waiting:
                    return
        finally:
            self._streams.records[record.id] = record
        raise OsalError(OS_ERR_OBJECT_IN_USE, f"a task waits at socket {record.name}")

    def _unplug(self, record: OsSocket) -> None:
        """Take a closed socket off the network; a waiting task finds it deleted."""
        self.network.datagrams.release(record.mailbox)
        self.network.streams.release(record.listener)
        record.listener.close()
        if isinstance(record.endpoint, Stream):
            record.endpoint.close()
        record.endpoint.changed()

    # -- waiting -----------------------------------------------------------------------------------------------------

    def _wait_readable(self, record: OsSocket, timeout_ns: int) -> bool:
        endpoint = record.endpoint
        if not self._await([record], [endpoint], lambda: record.deleted or endpoint.readable, timeout_ns):
            return False
        self._check_alive(record)
        return True

    def _await(
        self, records: Sequence[OsSocket], endpoints: Sequence[Endpoint], ready: Callable[[], bool], timeout_ns: int
    ) -> bool:
        """Wait at sockets until `ready` returns true; it is called again after each change of an endpoint.

        Returns:
            False after the timeout.
        """
        kernel = self.kernel
        until = kernel.now + timeout_ns
        waits = WaitList("socket")
        for endpoint in endpoints:
            endpoint.watch(kernel, waits)
        for record in records:
            record.users_waiting += 1
        is_ready = True
        try:
            while not ready():
                if timeout_ns != FOREVER and kernel.now >= until:
                    is_ready = False
                    break
                kernel.wait_on(waits, FOREVER if timeout_ns == FOREVER else until - kernel.now)
        finally:
            for endpoint in endpoints:
                endpoint.unwatch(kernel, waits)
        for record in records:
            record.users_waiting -= 1
        return is_ready

    def _check_alive(self, record: OsSocket) -> None:
        if record.deleted:
            raise self._streams.gone(record)

    def _ns_until(self, abs_timeout: OsTime) -> int:
        """Return the ns until a local time, or FOREVER for OS_TIME_MAX."""
        if abs_timeout == OS_TIME_MAX:
            return FOREVER
        return max(0, abs_timeout - self.get_local_time()) * OS_TIME_TICK_RESOLUTION_NS

    def _socket(self, sock_id: int, kind: int | None = None) -> OsSocket:
        """Return the record of a socket of a given kind; any other descriptor raises OS_ERR_INCORRECT_OBJ_TYPE."""
        record = self._stream(sock_id)
        if not isinstance(record, OsSocket) or kind not in (None, record.kind):
            raise OsalError(OS_ERR_INCORRECT_OBJ_TYPE, f"descriptor {sock_id:#x} is not a socket of this type")
        return record


def ns_of(timeout_ms: int) -> int:
    """Return a timeout in ns; OS_PEND and all negative values give FOREVER."""
    return timeout_ms * NS_PER_MS if timeout_ms >= 0 else FOREVER

"""Datagram sockets (OS_SocketSendTo, OS_SocketRecvFrom): packets of bytes to and from anybody on the virtual network.

May import its neighbours in cfepy.osal and cfepy.status.
"""

from __future__ import annotations

from cfepy.osal.clock import OsTime
from cfepy.osal.core import check_size
from cfepy.osal.limits import OS_PEND
from cfepy.osal.sockaddr import SockAddr, check_address, from_place
from cfepy.osal.streams import OS_SocketType_DATAGRAM, StreamApi, ns_of
from cfepy.status import OS_ERR_INCORRECT_OBJ_STATE, OsalError


class DatagramApi(StreamApi):
    """The functions that only datagram sockets have."""

    def socket_send_to(self, sock_id: int, buffer: bytes | bytearray | memoryview, remote_addr: SockAddr) -> int:
        """Send a datagram; never waits (OS_SocketSendTo). What nobody is there for is lost, as with UDP.

        Args:
            sock_id: a datagram socket.
            buffer: the data, at least a byte.
            remote_addr: where to.

        Returns:
            The number of bytes.

        Raises:
            OsalError: OS_ERR_INVALID_SIZE, OS_INVALID_POINTER, OS_ERR_INVALID_ID, OS_ERR_INCORRECT_OBJ_TYPE,
                OS_ERR_BAD_ADDRESS; OS_ERROR for an address of another domain or for more than UDP carries.
        """
        check_size(len(buffer), "datagram")
        check_address(remote_addr)
        record = self._socket(sock_id, OS_SocketType_DATAGRAM)
        if remote_addr.domain != record.domain:
            raise record.error(f"cannot send to {remote_addr!r}: that is another domain")
        return self._send(record, bytes(buffer), remote_addr.place)

    def socket_recv_from(self, sock_id: int, buflen: int, timeout_ms: int = OS_PEND) -> tuple[bytes, SockAddr] | None:
        """Receive a datagram (OS_SocketRecvFrom).

        Args:
            sock_id: a bound datagram socket.
            buflen: bytes; what is longer is cut off.
            timeout_ms: OS_PEND (-1) waits without limit, OS_CHECK (0) not at all.

        Returns:
            The data and the sender's address; None when there was nothing in that time.

        Raises:
            OsalError: OS_ERR_INVALID_SIZE, OS_ERR_INVALID_ID, OS_ERR_INCORRECT_OBJ_TYPE for what is no datagram
                socket, OS_ERR_INCORRECT_OBJ_STATE when it is not bound.
        """
        return self._recv_from(sock_id, buflen, ns_of(timeout_ms))

    def socket_recv_from_abs(self, sock_id: int, buflen: int, abs_timeout: OsTime) -> tuple[bytes, SockAddr] | None:
        """As `socket_recv_from`, until a local time (OS_SocketRecvFromAbs)."""
        return self._recv_from(sock_id, buflen, self._ns_until(abs_timeout))

    def _recv_from(self, sock_id: int, buflen: int, timeout_ns: int) -> tuple[bytes, SockAddr] | None:
        check_size(buflen, "receive buffer")
        record = self._socket(sock_id, OS_SocketType_DATAGRAM)
        if not record.bound:
            raise OsalError(OS_ERR_INCORRECT_OBJ_STATE, f"socket {record.name} is not bound")
        if not self._wait_readable(record, timeout_ns):
            return None
        datagram = record.mailbox.take()
        data = datagram.data[:buflen]
        self._charge_bytes(len(data))
        return data, from_place(datagram.source)

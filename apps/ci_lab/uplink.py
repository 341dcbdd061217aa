"""CI_LAB's socket: read datagrams, check them, send them on (ci_lab_app.c, ci_lab_passthru_decode.c)."""

from __future__ import annotations

from contextlib import suppress

from cfepy.app import Cfe
from cfepy.msg import CMD_HEADER_SIZE, get_size
from cfepy.osal import OS_CHECK, OS_SocketDomain_INET, OS_SocketType_DATAGRAM
from cfepy.status import CFE_STATUS_WRONG_MSG_LENGTH, CfeError, OsalError

from . import events as ev

MAX_INGEST = 768  # bytes of a datagram; the rest is cut off
MAX_PACKETS = 11  # in one go
SOCKET_RCV_PERF_ID = 33


class Uplink:
    """The socket that receives commands.

    Attributes:
        is_open: whether it is bound.
        packets, errors: datagrams that were accepted as packets, and those that were not.
    """

    def __init__(self, cfe: Cfe) -> None:
        self._cfe = cfe
        self._socket = 0
        self.is_open = False
        self.packets = self.errors = 0

    def open(self, port: int) -> None:
        """Bind the socket, or report why that is impossible."""
        cfe = self._cfe
        try:
            self._socket = cfe.os.socket_open(OS_SocketDomain_INET, OS_SocketType_DATAGRAM)
        except OsalError as error:
            cfe.evs.send_err(ev.SOCKETCREATE_ERR_EID, f"CI: create socket failed = {error.status}")
            return
        address = cfe.os.socket_addr_init(OS_SocketDomain_INET)
        cfe.os.socket_addr_set_port(address, port)
        try:
            cfe.os.socket_bind(self._socket, address)
        except OsalError as error:
            cfe.evs.send_err(ev.SOCKETBIND_ERR_EID, f"CI: bind socket failed = {error.status}")
            return
        self.is_open = True
        cfe.es.write_to_sys_log(f"CI_LAB listening on UDP port: {port}")

    def close(self) -> None:
        """Close the socket when the app's task is deleted."""
        self._cfe.os.printf("CI delete callback -- Closing CI Network socket.\n")
        with suppress(OsalError):  # it may never have been opened
            self._cfe.os.close(self._socket)

    def read(self) -> None:
        """Send on the received datagrams, eleven at most."""
        for _ in range(MAX_PACKETS):
            received = self._cfe.os.socket_recv_from(self._socket, MAX_INGEST, OS_CHECK)
            if received is None or not received[0]:  # an empty datagram ends this round, as in NASA's code
                return
            self._cfe.es.perf_log_entry(SOCKET_RCV_PERF_ID)
            status = self._ingest(received[0])
            self._cfe.es.perf_log_exit(SOCKET_RCV_PERF_ID)
            if status is not None:
                self._cfe.evs.send_err(ev.INGEST_SEND_ERR_EID, f"CI_LAB: Ingest failed, status={status}\n")

    def _ingest(self, data: bytes) -> int | None:
        """Check a datagram and put it on the bus unchanged. Returns a status if that failed."""
        size = self._size_of(data)
        if size is None:
            self.errors += 1
            return CFE_STATUS_WRONG_MSG_LENGTH
        self.packets += 1
        try:
            self._cfe.sb.transmit_msg(data[:size], is_origination=False)
        except CfeError as error:
            return error.status
        return None

    def _size_of(self, data: bytes) -> int | None:
        """Return the packet size in bytes according to its header, or None if the datagram is too short for that."""
        size = get_size(data) if len(data) >= CMD_HEADER_SIZE else None
        if size is None:
            text = f"CI: cmd dropped, bad packet length={len(data)}\n"
        elif size > len(data):
            text = f"CI: cmd dropped - length mismatch, {size} (hdr) / {len(data)} (packet)\n"
            size = None
        else:
            return size
        self._cfe.evs.send_err(ev.INGEST_LEN_ERR_EID, text)
        return None

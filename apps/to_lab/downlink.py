"""TO_LAB's socket: sends packets to the ground (to_lab_app.c, to_lab_passthru_encode.c)."""

from __future__ import annotations

from contextlib import suppress

from cfepy.app import Cfe
from cfepy.osal import OS_SocketDomain_INET, OS_SocketType_DATAGRAM
from cfepy.sb import POLL
from cfepy.status import OsalError

from . import events as ev

TLM_PORT = 1235
MAX_PACKETS = 50  # in one round
SOCKET_SEND_PERF_ID = 35


class Downlink:
    """The socket that sends packets. It sends nothing before it is enabled."""

    def __init__(self, cfe: Cfe) -> None:
        self._cfe = cfe
        self._socket = 0
        self._is_on = False
        self._suppressed = False
        self._address = cfe.os.socket_addr_init(OS_SocketDomain_INET)
        cfe.os.socket_addr_set_port(self._address, TLM_PORT)

    def enable(self, host: str) -> None:
        """Send to a host from now on. An invalid address stands for this computer, as in NASA's code."""
        self._address = self._cfe.os.socket_addr_init(OS_SocketDomain_INET)
        self._cfe.os.socket_addr_set_port(self._address, TLM_PORT)
        with suppress(OsalError):
            self._cfe.os.socket_addr_from_string(self._address, host)
        self._suppressed = False
        if not self._is_on:
            self._open()
            self._is_on = True

    def close(self) -> None:
        """Close the socket when the app's task is deleted."""
        self._cfe.os.printf("TO delete callback -- Closing TO Network socket.\n")
        if self._is_on:
            with suppress(OsalError):  # it could not be opened
                self._cfe.os.close(self._socket)

    def forward(self, pipe: int) -> None:
        """Send the packets that wait in a pipe, fifty at most."""
        for _ in range(MAX_PACKETS):
            packet = self._cfe.sb.receive_buffer(pipe, POLL)
            if packet is None:
                return
            if self._is_on and not self._suppressed:
                self._send(packet)

    def _send(self, packet: bytes) -> None:
        self._cfe.es.perf_log_entry(SOCKET_SEND_PERF_ID)
        status = 0
        try:
            self._cfe.os.socket_send_to(self._socket, packet, self._address)
        except OsalError as error:
            status = error.status
        self._cfe.es.perf_log_exit(SOCKET_SEND_PERF_ID)
        if status:
            self._suppressed = True
            text = f"L{ev.SEND_LINE} TO sendto error {status}. Tlm output suppressed\n"
            self._cfe.evs.send_err(ev.TLMOUTSTOP_ERR_EID, text)

    def _open(self) -> None:
        try:
            self._socket = self._cfe.os.socket_open(OS_SocketDomain_INET, OS_SocketType_DATAGRAM)
        except OsalError as error:
            text = f"L{ev.SOCKET_LINE}, TO TLM socket error: {error.status}"
            self._cfe.evs.send_err(ev.TLMOUTSOCKET_ERR_EID, text)

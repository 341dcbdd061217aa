"""The protocol module UDP: each datagram is a message; announcements, heartbeats and disconnects (sbn_udp_if.c)."""

from __future__ import annotations

from contextlib import suppress

from cfepy.app import Cfe
from cfepy.osal import (
    OS_CHECK,
    OS_PEND,
    OS_SocketDomain_INET,
    OS_SocketType_DATAGRAM,
    OsTime,
    SockAddr,
)
from cfepy.status import OsalError

from . import events as ev
from . import protocol as pr
from .network import Net, Nets, Peer

HEARTBEAT_MSG, ANNOUNCE_MSG, DISCONN_MSG = 0xA0, 0xA1, 0xA2
PEER_HEARTBEAT_S = 5
PEER_TIMEOUT_S = 10
ANNOUNCE_TIMEOUT_S = 10


class Udp:
    """The module.

    Args:
        cfe: the app's handle.
        network: the nets and peers.
        base_eid: base of its event ids.

    Attributes:
        rejected: datagrams that are not messages of a peer.
    """

    def __init__(self, cfe: Cfe, network: Nets, base_eid: int) -> None:
        self._cfe = cfe
        self._network = network
        self._base_eid = base_eid
        self.rejected = 0

    # -- opening and closing -----------------------------------------------------------------------------------------

    def init_net(self, net: Net) -> None:
        """Bind the port of this processor."""
        os = self._cfe.os
        self._info(ev.UDP_SOCK_EID, f"creating socket (Address={net.address})")
        here = self._address(net.address)
        if here is None:
            return
        local = os.socket_addr_init(OS_SocketDomain_INET)
        os.socket_addr_set_port(local, os.socket_addr_get_port(here))
        try:
            net.socket = os.socket_open(OS_SocketDomain_INET, OS_SocketType_DATAGRAM)
        except OsalError:
            self._error(ev.UDP_SOCK_EID, "socket open call failed")
            return
        try:
            os.socket_bind(net.socket, local)
        except OsalError:
            self._error(ev.UDP_SOCK_EID, f"bind call failed (Address={net.address})")

    def unload_net(self, net: Net) -> None:
        for peer in net.peers:
            if peer.connected:
                self._info(ev.UDP_DEBUG_EID, f"peer {peer.name} - sending disconnect")
                self._network.send(peer, DISCONN_MSG)
                self._network.disconnected(peer)
        if net.socket:
            with suppress(OsalError):  # the task that waits at it may have closed it
                self._cfe.os.close(net.socket)
            net.socket = 0

    def _address(self, text: str) -> SockAddr | None:
        """Return the address "HOST:PORT". If it is invalid, send an event and return None."""
        os = self._cfe.os
        host, _, port = text.partition(":")
        address = os.socket_addr_init(OS_SocketDomain_INET)
        try:
            os.socket_addr_from_string(address, host)
            os.socket_addr_set_port(address, int(port, 0))
        except (OsalError, ValueError):
            self._error(ev.UDP_CONFIG_EID, f"invalid address (Address={text})")
            return None
        return address

    # -- peers -------------------------------------------------------------------------------------------------------

    def poll_peer(self, peer: Peer) -> None:
        now = self._cfe.os.get_local_time()
        silent_s = self._seconds(now, peer.last_send)
        if not peer.connected:
            if silent_s > ANNOUNCE_TIMEOUT_S:
                self._info(ev.UDP_DEBUG_EID, f"announce to peer {peer.name}")
                self._network.send(peer, ANNOUNCE_MSG)
        elif self._seconds(now, peer.last_recv) > PEER_TIMEOUT_S:
            self._info(ev.UDP_DEBUG_EID, f"disconnected peer {peer.name}")
            self._network.disconnected(peer)
        elif silent_s > PEER_HEARTBEAT_S:
            self._network.send(peer, HEARTBEAT_MSG)

    def send(self, peer: Peer, message: pr.NetMsg) -> None:
        address = self._address(peer.address)
        if address is None:
            return
        data = pr.pack(message)
        try:
            self._cfe.os.socket_send_to(peer.net.socket, data, address)
        except OsalError as error:
            text = f"incomplete socket send, tried to send {len(data)} bytes, returned {error.status}"
            self._error(ev.UDP_SOCK_EID, text)
            raise

    def recv(self, net: Net, pend: bool) -> pr.NetMsg | None:
        received = self._cfe.os.socket_recv_from(net.socket, self._network.longest, OS_PEND if pend else OS_CHECK)
        if received is None:
            return None
        try:
            message = pr.unpack(received[0], self._network.longest)
        except pr.Malformed:
            self._reject("ERROR: could not unpack message")
            raise
        peer = net.peer(message.processor_id, message.spacecraft_id)
        if peer is None:
            who = f"{message.spacecraft_id}:{message.processor_id}"
            self._reject(f"ERROR: unknown peer {who}")
            raise pr.Malformed(f"unknown peer {who}")
        if not peer.connected:
            self._info(ev.UDP_DEBUG_EID, f"connecting to peer {peer.name}")
            self._network.connected(peer)
        if message.kind == DISCONN_MSG and peer.connected:
            self._network.disconnected(peer)
        return message

    def _reject(self, text: str) -> None:
        self.rejected += 1
        self._error(ev.UDP_DEBUG_EID, text)

    def _seconds(self, now: OsTime, then: OsTime) -> int:
        """Return whole seconds between two times."""
        return self._cfe.os.time_get_total_seconds(OsTime(now - then))

    def _info(self, event_id: int, text: str) -> None:
        self._cfe.evs.send_info(self._base_eid + event_id, text)

    def _error(self, event_id: int, text: str) -> None:
        self._cfe.evs.send_err(self._base_eid + event_id, text)

"""The nets and peers of an SBN, and the messages between them (SBN_NetInterface_t, SBN_PeerInterface_t).

A peer is connected when its first message arrives. It gets its own pipe, which receives the messages that it subscribes
to. SBN sends it the protocol's version and this processor's subscriptions. The protocol module handles the transport.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

from cfepy.app import Cfe
from cfepy.msg import PRIMARY_HEADER_SIZE, get_size
from cfepy.osal import OS_TIME_ZERO, OsTime
from cfepy.sb import PIPEOPTS_IGNOREMINE
from cfepy.status import CfeError

from . import events as ev
from . import protocol as pr
from .remap import Remap
from .subscriptions import Subscriptions

PEER_PIPE_DEPTH = 32


class Module(Protocol):
    """A protocol module (SBN_IfOps_t)."""

    def init_net(self, net: Net) -> None:
        """Open the net's socket."""

    def poll_peer(self, peer: Peer) -> None:
        """Do pending work for a peer: announce this processor, and detect the loss of the peer."""

    def send(self, peer: Peer, message: pr.NetMsg) -> None:
        """Send a message. Raises OsalError if that fails."""

    def recv(self, net: Net, pend: bool) -> pr.NetMsg | None:
        """Return the next message of a net, or None if there is none now.

        Its sender is a peer, which is then connected.

        Args:
            net: the net.
            pend: wait for a message.

        Raises:
            Malformed: the datagram is not a message. The module has reported it.
        """

    def unload_net(self, net: Net) -> None:
        """Say good-bye to its peers, and close it."""


@dataclass(eq=False)
class Peer:
    """Another processor (SBN_PeerInterface_t).

    Attributes:
        processor_id, spacecraft_id, address, task_flags: as in the configuration table.
        net: its net.
        filters: filters of its messages.
        subs: the MsgIds on this processor's bus that it subscribes to.
        pipe: for messages that it subscribes to; 0 if it is not connected.
        is_new: it was connected by the current message.
        last_send, last_recv: local times.
        send_cnt, recv_cnt, send_err_cnt, recv_err_cnt: messages since it was connected.
        send_task: id of the task that sends to it; 0 without one.
    """

    processor_id: int
    spacecraft_id: int
    address: str
    task_flags: int
    net: Net
    filters: list[Remap] = field(default_factory=list)
    subs: dict[int, None] = field(default_factory=dict)
    pipe: int = 0
    connected: bool = False
    is_new: bool = False
    last_send: OsTime = OS_TIME_ZERO
    last_recv: OsTime = OS_TIME_ZERO
    send_cnt: int = 0
    recv_cnt: int = 0
    send_err_cnt: int = 0
    recv_err_cnt: int = 0
    send_task: int = 0

    @property
    def name(self) -> str:
        """Spacecraft and processor, as events have them."""
        return f"{self.spacecraft_id}:{self.processor_id}"

    def reset_counts(self) -> None:
        """Set the counters to zero."""
        self.send_cnt = self.recv_cnt = self.send_err_cnt = self.recv_err_cnt = 0


@dataclass(eq=False)
class Net:
    """Processors that reach each other by one protocol (SBN_NetInterface_t).

    Attributes:
        index: its number in the configuration table.
        module, protocol_idx: the protocol module; None until the table gives this processor's own entry.
        address, task_flags: of this processor.
        peers: the others.
        socket: the socket that the module opened; 0 for none.
        recv_task: id of the task that receives; 0 without one.
    """

    index: int
    module: Module | None = None
    protocol_idx: int = 0
    address: str = ""
    task_flags: int = 0
    peers: list[Peer] = field(default_factory=list)
    socket: int = 0
    recv_task: int = 0

    def peer(self, processor_id: int, spacecraft_id: int) -> Peer | None:
        """Return the peer with these ids (SBN_GetPeer)."""
        for peer in self.peers:
            if (peer.processor_id, peer.spacecraft_id) == (processor_id, spacecraft_id):
                return peer
        return None


class Nets:
    """All nets, and the transfer from and to the Software Bus.

    Args:
        cfe: the app's handle.
        subscriptions: subscriptions of this processor.

    Attributes:
        nets: by number; a net that is not in the table has no module.
        longest: bytes of the longest message.
    """

    def __init__(self, cfe: Cfe, subscriptions: Subscriptions) -> None:
        self._cfe = cfe
        self._subscriptions = subscriptions
        self.nets: list[Net] = []
        self.longest = cfe.sb.config.sb_max_msg_size
        self._send_mutex = cfe.os.mut_sem_create("sbn_send_mutex")

    @property
    def peers(self) -> list[Peer]:
        """The peers of all nets."""
        return [peer for net in self.nets for peer in net.peers]

    # -- connections -------------------------------------------------------------------------------------------------

    def connected(self, peer: Peer) -> None:
        """Connect a peer: make its pipe, send it the version and this processor's subscriptions (SBN_Connected)."""
        cfe = self._cfe
        name = f"SBN_{peer.processor_id}_{peer.spacecraft_id}_Pipe"
        try:
            peer.pipe = cfe.sb.create_pipe(PEER_PIPE_DEPTH, name)
        except CfeError:
            cfe.evs.send_err(ev.PEER_EID, f"ERROR: could not connect peer: could not create peer pipe '{name}'")
            return
        cfe.evs.send_info(ev.PEER_EID, f"Created peer pipe '{name}'")
        cfe.sb.set_pipe_opts(peer.pipe, PIPEOPTS_IGNOREMINE)
        cfe.evs.send_info(ev.PEER_EID, f"Peer {peer.name} connected.")
        peer.last_recv = cfe.os.get_local_time()
        peer.connected = peer.is_new = True
        if self.send(peer, pr.PROTO_MSG, bytes([pr.PROTO_VER])):
            self.send(peer, pr.SUB_MSG, self._subscriptions.all())

    def disconnected(self, peer: Peer) -> None:
        """Disconnect a peer: remove its pipe and subscriptions (SBN_Disconnected)."""
        cfe = self._cfe
        pipe, peer.pipe, peer.connected = peer.pipe, 0, False
        peer.subs.clear()
        peer.reset_counts()
        try:
            cfe.sb.delete_pipe(pipe)
        except CfeError as error:
            text = f"could not delete pipe when disconnecting peer {peer.name}: {error.hex}"
            cfe.evs.send_err(ev.PEER_EID, f"ERROR: could not disconnect peer: {text}")
        cfe.evs.send_info(ev.PEER_EID, f"Disconnected from peer {peer.name}.")

    # -- out ---------------------------------------------------------------------------------------------------------

    def send(self, peer: Peer, kind: int, payload: bytes = b"") -> bool:
        """Send a message to a peer. Returns whether that was possible (SBN_SendNetMsg)."""
        cfe = self._cfe
        module = peer.net.module
        if module is None:
            return False
        if len(payload) > pr.LONGEST:
            peer.send_err_cnt += 1
            text = f"a message of {len(payload)} bytes cannot be sent to peer {peer.name}, at most {pr.LONGEST}"
            cfe.evs.send_err(ev.PEER_EID, text)
            return False
        message = pr.NetMsg(kind, cfe.psp.get_processor_id(), cfe.psp.get_spacecraft_id(), payload)
        if peer.send_task:
            cfe.os.mut_sem_take(self._send_mutex)
        try:
            module.send(peer, message)
            peer.send_cnt += 1
        except CfeError:  # the module has reported it
            peer.send_err_cnt += 1
            return False
        finally:
            peer.last_send = cfe.os.get_local_time()  # also when it failed, so that it is not tried at once again
            if peer.send_task:
                cfe.os.mut_sem_give(self._send_mutex)
        return True

    def send_packet(self, peer: Peer, packet: bytes) -> None:
        """Send a message of the Software Bus to a peer, if the filters let it pass."""
        filtered = through(peer, packet)
        if filtered is not None:
            self.send(peer, pr.APP_MSG, filtered)

    # -- in ----------------------------------------------------------------------------------------------------------

    def process(self, net: Net, message: pr.NetMsg) -> None:
        """Handle a message of a connected peer (SBN_ProcessNetMsg)."""
        peer = net.peer(message.processor_id, message.spacecraft_id)
        if peer is None:
            return
        peer.last_recv = self._cfe.os.get_local_time()
        if message.kind & pr.MODULE_SPECIFIC:
            peer.is_new = False
            return
        peer.recv_cnt += 1
        try:
            self._process(peer, message)
        except CfeError as error:
            peer.recv_err_cnt += 1
            text = f"(Status={error.status} MsgType=0x{message.kind:x}): {error}"
            self._cfe.evs.send_err(ev.SB_EID, f"ERROR: could not process peer message: {text}")
        finally:
            peer.is_new = False

    def _process(self, peer: Peer, message: pr.NetMsg) -> None:
        if message.kind == pr.APP_MSG:
            self._publish(peer, message.payload)
        elif message.kind == pr.SUB_MSG:
            self._subscriptions.from_peer(peer, message.payload)
        elif message.kind == pr.UNSUB_MSG:
            self._subscriptions.unsub_from_peer(peer, message.payload)
        elif message.kind == pr.PROTO_MSG:
            self._compare_versions(peer, message.payload)
        elif message.kind != pr.NO_MSG:
            raise pr.Malformed("unknown message type")

    def _publish(self, peer: Peer, packet: bytes) -> None:
        """Put a message of a peer on the bus unchanged."""
        size = get_size(packet) if len(packet) > PRIMARY_HEADER_SIZE else self.longest + 1
        if size > len(packet):
            raise pr.Malformed(f"the header of a packet of {len(packet)} bytes states {size}")
        filtered = through(peer, packet[:size])
        if filtered is not None:
            self._cfe.sb.transmit_msg(filtered, is_origination=False)

    def _compare_versions(self, peer: Peer, payload: bytes) -> None:
        """Report whether a peer has the same version.

        The peer sends its version when it connects to this processor. It may connect again: after a reset it has lost
        this processor's subscriptions.
        """
        if not payload:
            raise pr.Malformed("a protocol version of no bytes")
        if not peer.is_new:
            self.send(peer, pr.SUB_MSG, self._subscriptions.all())
        if payload[0] == pr.PROTO_VER:
            self._cfe.evs.send_info(ev.SB_EID, f"SBN protocol version match with peer {peer.name}")
            return
        versions = f"my version={pr.PROTO_VER}, peer version {payload[0]}"
        text = f"SBN protocol version mismatch with peer {peer.name}, {versions}"
        self._cfe.evs.send_err(ev.SB_EID, f"ERROR: could not process peer message: {text}")


def through(peer: Peer, packet: bytes) -> bytes | None:
    """Pass a packet through the filters of a peer. Returns the result, or None if a filter drops it."""
    passed: bytes | None = packet
    for each in peer.filters:
        if passed is None:
            return None
        passed = each.filter(passed, peer.processor_id, peer.spacecraft_id)
    return passed

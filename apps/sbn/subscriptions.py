"""This processor's subscriptions, as sent to peers, and the subscriptions of the peers (sbn_subs.c)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Protocol

from cfepy.app import Cfe
from cfepy.evs import packets as evs
from cfepy.msg import get_msg_id
from cfepy.sb import POLL
from cfepy.sb import packets as sb
from cfepy.status import CfeError

from . import events as ev
from . import packets as pk
from . import protocol as pr
from .remap import Remap

SUB_PIPE_DEPTH = 32
MAX_ALLSUBS_ON_PIPE, MAX_ONESUB_ON_PIPE = 64, 16
DEFAULT_MSG_LIM = 8
OWN = (evs.LONG_EVENT_MSG_MID, pk.CMD_MID, pk.TLM_MID)
"""MsgIds that peers are never told of."""


class SubscribedPeer(Protocol):
    """A subscribing peer: its identity, its filters, its subscriptions, and the pipe for its messages."""

    processor_id: int
    spacecraft_id: int
    filters: list[Remap]
    subs: dict[int, None]
    pipe: int
    recv_err_cnt: int


class Subscriptions:
    """The subscriptions.

    Args:
        cfe: the app's handle.
        ident: the source that this SBN claims to be built from; subscriptions of peers with another ident are ignored.

    Attributes:
        mine: subscriptions of this processor, with the number of its applications that have each.
        tell: called with the type of a message and its payload, for all peers.
    """

    def __init__(self, cfe: Cfe, ident: str) -> None:
        self._cfe = cfe
        self._ident = ident
        self._pipe = 0
        self.mine: dict[int, tuple[pr.Sub, int]] = {}
        self.tell: Callable[[int, bytes], object] = lambda kind, payload: None

    # -- of this processor -------------------------------------------------------------------------------------------

    def open(self) -> None:
        """Create the pipe to which the Software Bus reports."""
        sb_api = self._cfe.sb
        self._pipe = sb_api.create_pipe(SUB_PIPE_DEPTH, "SBNSubPipe")
        sb_api.subscribe_local(sb.ALLSUBS_TLM_MID, self._pipe, MAX_ALLSUBS_ON_PIPE)
        sb_api.subscribe_local(sb.ONESUB_TLM_MID, self._pipe, MAX_ONESUB_ON_PIPE)

    def close(self) -> None:
        """Delete the pipe, and forget everything."""
        self._cfe.sb.delete_pipe(self._pipe)
        self.mine.clear()

    def ask(self) -> None:
        """Have the Software Bus report all subscriptions, and each new one (SBN_SendSubsRequests)."""
        for command in (sb.ENABLE_SUB_REPORTING, sb.SEND_PREV_SUBS):
            self._cfe.sb.transmit_msg(command.packet())

    def check_pipe(self) -> None:
        """Take a report of the Software Bus, if there is one (SBN_CheckSubscriptionPipe)."""
        packet = self._cfe.sb.receive_buffer(self._pipe, POLL)
        if packet is None:
            return
        if get_msg_id(packet) == sb.ALLSUBS_TLM_MID:
            self._cfe.evs.send_info(ev.SUB_EID, "Processing all subscriptions...")
            told = sb.ALLSUBS_TLM.read(packet)
            for entry in told["Entry"][: told["Entries"]]:
                self._add(_subscription(entry))
            return
        report = sb.ONESUB_TLM.read(packet)
        if report["SubType"] == sb.SUBSCRIPTION:
            self._add(_subscription(report))
        else:
            self._remove(report["MsgId"])

    def all(self) -> bytes:
        """Return the payload with all subscriptions for a peer."""
        return pr.pack_subscriptions([each for each, _ in self.mine.values()], self._ident)

    def _add(self, new: pr.Sub) -> None:
        if new.msg_id in OWN:
            return
        known, users = self.mine.get(new.msg_id, (new, 0))
        if not users and len(self.mine) >= pr.MAX_SUBS:
            text = f"local subscription ignored for MsgID 0x{new.msg_id:04X}, max ({pr.MAX_SUBS}) met"
            self._cfe.evs.send_err(ev.SUB_EID, text)
            return
        self.mine[new.msg_id] = known, users + 1
        if not users:
            self.tell(pr.SUB_MSG, pr.pack_subscriptions([new], self._ident))

    def _remove(self, msg_id: int) -> None:
        known, users = self.mine.get(msg_id, (pr.Sub(msg_id), 0))
        if users > 1:
            self.mine[msg_id] = known, users - 1
        elif users:
            del self.mine[msg_id]
            self.tell(pr.UNSUB_MSG, pr.pack_subscriptions([known], self._ident))

    # -- of peers ----------------------------------------------------------------------------------------------------

    def from_peer(self, peer: SubscribedPeer, payload: bytes) -> None:
        """Add a peer's subscriptions (SBN_ProcessSubsFromPeer).

        Raises:
            Malformed: if the payload is too short for its subscriptions.
            CfeError: if the Software Bus has no room for a subscription.
        """
        for each in self._read(peer, payload):
            self._subscribe(peer, _wanted(peer, each.msg_id))

    def _subscribe(self, peer: SubscribedPeer, msg_id: int) -> None:
        if msg_id in peer.subs:
            return
        if len(peer.subs) >= pr.MAX_SUBS:
            text = f"cannot process subscription from ProcessorID {peer.processor_id}, max ({pr.MAX_SUBS}) met"
            self._cfe.evs.send_err(ev.SUB_EID, text)
            return
        try:
            self._cfe.sb.subscribe_local(msg_id, peer.pipe, DEFAULT_MSG_LIM)
        except CfeError:
            self._cfe.evs.send_err(ev.SUB_EID, f"unable to subscribe to MID 0x{msg_id:04X}")
            raise
        peer.subs[msg_id] = None

    def unsub_from_peer(self, peer: SubscribedPeer, payload: bytes) -> None:
        """Remove a peer's subscriptions (SBN_ProcessUnsubsFromPeer).

        Raises:
            Malformed: if the payload is too short for its subscriptions.
        """
        for each in self._read(peer, payload):
            msg_id = _wanted(peer, each.msg_id)
            if msg_id in peer.subs:
                del peer.subs[msg_id]
                self._cfe.sb.unsubscribe_local(msg_id, peer.pipe)
            else:
                text = f"unsubscription from ProcessorID {peer.processor_id}, msg 0x{msg_id:04X} not found"
                self._cfe.evs.send_info(ev.SUB_EID, f"cannot process {text}")

    def _read(self, peer: SubscribedPeer, payload: bytes) -> list[pr.Sub]:
        ident, told = pr.unpack_subscriptions(payload)
        if ident == self._ident:
            return told
        text = f"version number mismatch with peer CpuID {peer.processor_id}"
        self._cfe.evs.send_err(ev.PROTO_EID, text)
        peer.recv_err_cnt += 1
        return []


def _subscription(entry: Mapping[str, Any]) -> pr.Sub:
    """Return a subscription out of a report of the Software Bus."""
    return pr.Sub(entry["MsgId"], entry["Qos"]["Priority"], entry["Qos"]["Reliability"])


def _wanted(peer: SubscribedPeer, msg_id: int) -> int:
    """Return the MsgId on this processor's bus that becomes one that a peer subscribes to."""
    for each in peer.filters:
        msg_id = each.wanted(msg_id, peer.processor_id, peer.spacecraft_id)
    return msg_id

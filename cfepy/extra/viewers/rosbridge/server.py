"""`RosbridgeServer`: clients of rosbridge take part in a mission while it runs."""

from __future__ import annotations

import time
from http import HTTPStatus
from typing import TYPE_CHECKING, Any

from cfepy.extra.viewers.listen import Admission, ListenPlace
from cfepy.extra.viewers.rosbridge.bridge_node import BridgeNode
from cfepy.extra.viewers.rosbridge.rosapi import Rosapi
from cfepy.extra.viewers.rosbridge.rosauth import MacCheck
from cfepy.extra.viewers.rosbridge.rosbridge_client import RosbridgeClient
from cfepy.extra.viewers.websocket_listener import CONNECTIONS, TABLE, Refusal, WebSocketListener, token_of
from cfepy.ground import ShownPackets
from cfepy.io import INTO, OUT_OF, PeerCounts
from cfepy.mission import PacketWatch

if TYPE_CHECKING:
    from websockets.http11 import Request

OPTION, EXTRA = "--rosbridge", "web"
OUTSIDE = "rosbridge"


class RosbridgeServer(PacketWatch):
    """The server: an attachment of the mission, and a guest at its bridge to the outside.

    Args:
        place: the address that it listens at.
        admission: decides which clients may connect.
        counts: counts messages and connections.

    Attributes:
        place: the address that it listens at, with the actual port.

    Raises:
        UsageError: the port is taken, or the package websockets is missing.
    """

    def __init__(self, place: ListenPlace, admission: Admission, counts: PeerCounts) -> None:
        super().__init__(lambda seen: self._node.show(seen.packet), lambda msg_id: msg_id in self._shown)
        self._shown: frozenset[int] = frozenset()
        self._admission = admission
        self._counts = counts
        self._node: BridgeNode
        self._rosapi: Rosapi
        self._mac = MacCheck(admission.token)
        self._listener = WebSocketListener(place, OPTION, EXTRA, self._client, self._refusal, self._refused)
        self.place = self._listener.place

    def begin(self, mission: Any) -> None:
        uri = f"http://{self.place}/"
        packets = ShownPackets(mission).packets
        self._shown = frozenset(each.msg_id for each in packets.values())
        self._node = BridgeNode(mission, uri, self._lost, packets)
        self._rosapi = Rosapi(self._node, uri)
        mission.record.tables[TABLE] = self._counts.rows

    def fileno(self) -> int:
        """Return the descriptor that becomes readable when input arrives."""
        return self._listener.fileno()

    def exchange(self) -> None:
        """Pass on the mission's output to clients, and take their messages."""
        self._node.exchange(time.monotonic())
        self._listener.exchange()

    def finish(self) -> None:
        """Stop all input."""
        self._node.close()
        self._listener.finish()

    def close(self) -> None:
        """Close the server. You may call it more than once."""
        self._listener.close()

    def _client(self, address: str) -> RosbridgeClient:
        return RosbridgeClient(self._node, self._rosapi, self._counts, _peer(address), self._mac)

    def _refusal(self, client: RosbridgeClient, request: Request) -> Refusal | None:
        """Check a request. Returns the refusal, or None to accept it.

        A client that shows the token is admitted from anywhere. Without it, a page of a browser must come from this
        computer. If there is a token, every such client must then prove with `auth` that it knows it.
        """
        has_token = self._admission.knows(token_of(request))
        if not has_token and not self._admission.welcomes(request.headers.get("Origin")):
            why = (
                f"pages of {request.headers.get('Origin')} are not permitted; allow "
                "them with --viewer-origin, or use a token"
            )
            return HTTPStatus.FORBIDDEN, f"{why}\n"
        if has_token or not self._admission.token:
            client.is_admitted()
        return None

    def _lost(self, topic: str, why: str) -> None:
        count = self._counts.of(topic, OUTSIDE, OUT_OF)
        count.dropped += 1
        count.why = why

    def _refused(self, address: str, why: str) -> None:
        count = self._counts.of(CONNECTIONS, _peer(address), INTO)
        count.refused += 1
        count.why = why


def _peer(address: str) -> str:
    """Return the name of a client in the report."""
    return f"{OUTSIDE} {address}"

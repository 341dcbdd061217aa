"""`RosbridgeServer`: listens for clients of rosbridge while a mission runs.

Everything happens between two pieces of the run, on sockets that nobody waits for: a client that is slow loses
messages, one that sends nonsense is told so or loses its connection, and the mission goes on.
"""

from __future__ import annotations

import socket
import time
from http import HTTPStatus
from selectors import EVENT_READ, DefaultSelector
from typing import TYPE_CHECKING, Any
from urllib.parse import parse_qs, urlsplit

from cfepy.ground import ShownPackets
from cfepy.io import INTO, OUT_OF, Listening, PeerCounts, listening_socket
from cfepy.mission import PacketWatch
from cfepy.status import UsageError
from cfepy.viewers.listen import Admission, ListenPlace
from cfepy.viewers.rosbridge.bridge_node import BridgeNode
from cfepy.viewers.rosbridge.client import CONNECTION, RosbridgeClient
from cfepy.viewers.rosbridge.rosapi import Rosapi
from cfepy.viewers.rosbridge.rosauth import MacCheck
from cfepy.viewers.rosbridge.websocket import WebSocket, protocols

if TYPE_CHECKING:
    from websockets.http11 import Request

MOST_CLIENTS = 64
HANDSHAKE_S = 10.0  # wall time that a client has for asking for the connection
FAREWELL_S = 2.0  # and for reading what was sent to it last
GOING_AWAY, INTERNAL = 1001, 1011  # RFC 6455, 7.4.1
LONGEST_REASON = 40  # characters; in UTF-8 there is room for 123 bytes
OPTION = "--rosbridge"
TABLE = "viewer_peers"  # of the report
OUTSIDE = "rosbridge"


class RosbridgeServer(PacketWatch):
    """The server: an attachment of the mission, and a guest at its bridge to the outside.

    Args:
        place: where it listens.
        admission: whom it lets in.
        counts: gets what passes.

    Attributes:
        place: where it listens, with the port that it has.

    Raises:
        UsageError: the port is taken, or the package websockets is missing.
    """

    def __init__(self, place: ListenPlace, admission: Admission, counts: PeerCounts) -> None:
        protocols()  # before anything is open
        super().__init__(lambda seen: self._node.show(seen.packet), lambda msg_id: msg_id in self._shown)
        self._shown: frozenset[int] = frozenset()
        self._admission = admission
        self._counts = counts
        self._selector = DefaultSelector()
        if not hasattr(self._selector, "fileno"):
            raise UsageError("needs epoll or kqueue, which this system does not have", field=OPTION)
        try:
            opened = listening_socket(place.host, place.port)
        except OSError as error:
            self._selector.close()
            raise UsageError(f"{place} cannot be opened: {error.strerror or error}", field=OPTION) from None
        self._listening = Listening(self._selector, opened, self._accept)
        self.place = ListenPlace(place.host, self._listening.port)
        self._node: BridgeNode
        self._rosapi: Rosapi
        self._clients: dict[WebSocket, RosbridgeClient] = {}
        self._since: dict[WebSocket, float] = {}  # those that have not asked for the connection
        self._ending: dict[WebSocket, float] = {}
        self._mac = MacCheck(admission.token)
        self._is_over = False
        self._near, self._far = socket.socketpair()
        for each in (self._near, self._far):
            each.setblocking(False)
        self._selector.register(self._near, EVENT_READ, self._nudged)

    def begin(self, mission: Any) -> None:
        """See `Attachment.begin`."""
        uri = f"http://{self.place}/"
        packets = ShownPackets(mission.spec).packets
        self._shown = frozenset(each.msg_id for each in packets.values())
        self._node = BridgeNode(mission, uri, self._lost, packets)
        self._rosapi = Rosapi(self._node, uri)
        mission.record.tables[TABLE] = self._counts.rows

    def fileno(self) -> int:
        """What can be read when something wants to come in."""
        return self._selector.fileno()

    def exchange(self) -> None:
        """Hand out what the mission has for clients, and bring in what they have sent."""
        now_s = time.monotonic()
        self._node.exchange(now_s)
        for made, client in list(self._clients.items()):
            try:
                client.go_on(now_s)
            except Exception as error:  # whatever a stranger's ops lead to ends this connection alone
                made.close(INTERNAL, f"{type(error).__name__}: {error}"[:LONGEST_REASON])
        for key, events in self._selector.select(0):
            key.data(events)
        if any(client.is_behind for client in self._clients.values()):
            self._nudge()
        for each in [each for each, since_s in self._since.items() if now_s - since_s > HANDSHAKE_S]:
            each.abort()
        for each in [each for each, since_s in self._ending.items() if each.has_ended or now_s - since_s > FAREWELL_S]:
            del self._ending[each]
            each.abort()

    def finish(self) -> None:
        """See `Attachment.finish`: nothing enters any more."""
        self._node.close()
        for each in list(self._clients):
            each.close(GOING_AWAY, "the run is over")

    def close(self) -> None:
        """See `Attachment.close`: nobody is served any more; may be called more than once."""
        if self._is_over:
            return
        self._is_over = True
        self._listening.close()
        for each in [*self._clients, *self._ending]:
            each.abort()
        self._near.close()
        self._far.close()
        self._selector.close()

    def _accept(self, connected: socket.socket) -> None:
        try:
            peer = f"{OUTSIDE} {connected.getpeername()[0]}"
            connected.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
        except OSError:  # it is gone again
            connected.close()
            return
        if len(self._clients) >= MOST_CLIENTS:
            connected.close()
            self._refused(peer, "too many clients")
            return
        client = RosbridgeClient(self._node, self._rosapi, self._counts, peer, self._mac)
        client.socket = made = WebSocket(
            self._selector,
            connected,
            lambda request: self._refusal(client, made, peer, request),
            client.take,
            lambda why: self._gone(made, why),
        )
        self._clients[made] = client
        self._since[made] = time.monotonic()

    def _refusal(
        self, client: RosbridgeClient, made: WebSocket, peer: str, request: Request
    ) -> tuple[HTTPStatus, str] | None:
        """Why a request is refused; None takes it.

        Who shows the token is let in, wherever it comes from. Without it a page of a browser must be of this computer,
        and if there is a token, whoever it is must show with `auth` that it knows it.
        """
        self._since.pop(made, None)
        has_token = self._admission.knows(_token_of(request))
        if not has_token and not self._admission.welcomes(request.headers.get("Origin")):
            why = f"pages of {request.headers.get('Origin')} are not welcome (--viewer-origin, or a token)"
            self._refused(peer, why)
            return HTTPStatus.FORBIDDEN, f"{why}\n"
        if has_token or not self._admission.token:
            client.is_admitted()
        self._counts.of(CONNECTION, peer, INTO).connections += 1
        return None

    def _nudge(self) -> None:
        """The run is not to sleep after its next piece: there is something to do."""
        try:
            self._far.send(b"!")
        except BlockingIOError:
            pass  # it is nudged already

    def _nudged(self, events: int) -> None:
        try:
            self._near.recv(4096)
        except BlockingIOError:
            pass  # nobody has nudged

    def _lost(self, topic: str, why: str) -> None:
        count = self._counts.of(topic, OUTSIDE, OUT_OF)
        count.dropped += 1
        count.why = why

    def _refused(self, peer: str, why: str) -> None:
        count = self._counts.of(CONNECTION, peer, INTO)
        count.refused += 1
        count.why = why

    def _gone(self, made: WebSocket, why: str) -> None:
        self._since.pop(made, None)
        client = self._clients.pop(made, None)
        if client is not None:
            client.gone(why)
        self._ending[made] = time.monotonic()


def _token_of(request: Request) -> str:
    """The token that a request shows: ?token=TOKEN, or Authorization: Bearer TOKEN (RFC 6750)."""
    given = parse_qs(urlsplit(request.path).query).get("token", [])
    if given:
        return given[0]
    kind, _, token = request.headers.get("Authorization", "").partition(" ")
    return token.strip() if kind.lower() == "bearer" else ""

"""`WebSocketListener`: takes clients that speak a protocol over WebSocket (RFC 6455) while a mission runs.

What comes in is taken between two pieces of the run, and nobody waits for a socket: a client that is slow loses
messages, one that sends nonsense is told so or loses its connection, and the mission goes on.
"""

from __future__ import annotations

import socket
import time
from collections import deque
from collections.abc import Callable, Sequence
from http import HTTPStatus
from operator import itemgetter
from selectors import EVENT_READ, DefaultSelector
from typing import TYPE_CHECKING, Generic, Protocol, TypeVar
from urllib.parse import parse_qs, urlsplit

from cfepy.extra.viewers.listen import ListenPlace
from cfepy.extra.viewers.websocket import WebSocket, protocols
from cfepy.io import InputRoom, InputTurn, Listening, listening_socket
from cfepy.status import UsageError

if TYPE_CHECKING:
    from websockets.http11 import Request

TABLE = "viewer_peers"  # of the report
CONNECTIONS = "(connections)"  # its row of all that is no message
MOST_CLIENTS = 64
MOST_MESSAGES = 256  # of a client between two pieces of the run; the others wait
HANDSHAKE_S = 10.0  # wall time that a client has for asking for the connection
IDLE_S = 30.0  # of silence after which a client that takes part in nothing gives way to another
SILENCE_S = 20.0  # after which a client is asked for a sign of life, and then has for it, when places are few
FAREWELL_S = 2.0  # and for reading what was sent to it last
LAST_S, LOOK_S = 1.0, 0.05  # wall time that the end of a run waits for all of them together; between two looks
GOING_AWAY, INTERNAL = 1001, 1011  # RFC 6455, 7.4.1
LONGEST_REASON = 40  # characters; in UTF-8 there is room for 123 bytes
OVER = "the run is over"
NO_REQUEST = "not a WebSocket request"

Refusal = tuple[HTTPStatus, str]


class ConnectedClient(Protocol):
    """What the owner of a listener has for each connection."""

    @property
    def is_ready(self) -> bool:
        """Whether it takes a message now; if not, the client has to wait."""

    @property
    def unfinished(self) -> int:
        """Bytes that it keeps of messages that are not whole."""

    @property
    def takes_part(self) -> bool:
        """Whether it hears, publishes or offers something, or waits for an answer."""

    def begin(self, connection: WebSocket) -> None:
        """The connection is there, for both sides."""

    def take(self, message: str | bytes) -> None:
        """A message of the client's."""

    @property
    def has_more(self) -> bool:
        """Whether it has messages for the client that wait for room on the way out."""

    def go_on(self, now_s: float) -> None:
        """Another piece of the run is over, or there is room again."""

    def gone(self, why: str) -> None:
        """The connection is over; of those that began alone."""


C = TypeVar("C", bound=ConnectedClient)
T = TypeVar("T")


class _Connection(Generic[C]):
    """A connection with what came over it and has not been taken."""

    def __init__(self, client: C, peer: str) -> None:
        self.client = client
        self.peer = peer
        self.since_s = time.monotonic()  # that it was accepted, or that it ends
        self.heard_s = self.since_s  # that something came from it
        self.pinged_s = self.since_s
        self.has_asked = self.has_begun = False
        self.coming: deque[str | bytes] = deque()
        self.left = MOST_MESSAGES


class WebSocketListener(Generic[C]):
    """Listens, lets clients in, and brings in what they send.

    Args:
        place: where.
        option: of the command line that asks for it.
        extra: of cfepy, that installs what it needs.
        make: makes what its owner has for a connection; takes the address of the other side.
        refusal: says why a client's request is refused, with the HTTP status; None lets it in.
        refused: is told of a connection that came to nothing: the address, and why.
        subprotocols: one of which a client has to ask for, the best first; none if it need not.

    Attributes:
        place: where it listens, with the port that it has.

    Raises:
        UsageError: the port is taken, or the package websockets is missing.
    """

    def __init__(
        self,
        place: ListenPlace,
        option: str,
        extra: str,
        make: Callable[[str], C],
        refusal: Callable[[C, Request], Refusal | None],
        refused: Callable[[str, str], object],
        subprotocols: Sequence[str] = (),
    ) -> None:
        try:
            protocols()  # before anything is open
        except ImportError:
            raise UsageError(f"requires the package websockets: pip install 'cfepy[{extra}]'", field=option) from None
        self._make = make
        self._refusal = refusal
        self._refused = refused
        self._subprotocols = subprotocols
        self._selector = DefaultSelector()
        if not hasattr(self._selector, "fileno"):
            raise UsageError("requires epoll or kqueue, which this system does not have", field=option)
        try:
            opened = listening_socket(place.host, place.port)
        except OSError as error:
            self._selector.close()
            remedy = "another program may have it; give another port"
            why = f"{place} cannot be opened: {error.strerror or error}; {remedy}"
            raise UsageError(why, field=option) from None
        self._listening = Listening(self._selector, opened, self._accept)
        self.place = ListenPlace(place.host, self._listening.port)
        self._connections: dict[WebSocket, _Connection[C]] = {}
        self._ending: dict[WebSocket, float] = {}
        self._room = InputRoom()
        self._turn = InputTurn()
        self._turns = 0
        self._is_over = False
        self._near, self._far = socket.socketpair()
        for each in (self._near, self._far):
            each.setblocking(False)
        self._selector.register(self._near, EVENT_READ, self._nudged)

    @property
    def clients(self) -> list[C]:
        """Those that are connected now."""
        return [each.client for each in self._connections.values() if each.has_begun]

    def fileno(self) -> int:
        """What can be read when something wants to come in."""
        return self._selector.fileno()

    def exchange(self) -> None:
        """Bring in what clients have sent, and go on with what they did not take."""
        now_s = self._go_on()
        self._turn.begin()
        connections = list(self._connections.items())
        first = self._turns = (self._turns + 1) % max(1, len(connections))
        for made, connection in connections[first:] + connections[:first]:  # another one begins each time
            connection.left = MOST_MESSAGES
            self._work(made, connection)
        self._look(0)
        if any(each.coming and each.client.is_ready for each in self._connections.values()) or self._turn.is_over:
            self._nudge()
        self._look_for_life(now_s)
        for made, connection in list(self._connections.items()):
            if not connection.has_asked and now_s - connection.since_s > HANDSHAKE_S:
                made.abort()
        for made in [each for each, since_s in self._ending.items() if each.has_ended or now_s - since_s > FAREWELL_S]:
            del self._ending[made]
            made.abort()

    def _look_for_life(self, now_s: float) -> None:
        """When places are few, end connections from which no sign of life comes."""
        if len(self._connections) <= MOST_CLIENTS // 2:
            return
        for made, connection in list(self._connections.items()):
            if made.has_pinged and now_s - connection.pinged_s > SILENCE_S:
                made.close(GOING_AWAY, "no sign of life")
            elif not made.has_pinged and connection.has_begun and now_s - connection.heard_s > SILENCE_S:
                connection.pinged_s = now_s
                made.ping()

    def _go_on(self) -> float:
        now_s = time.monotonic()
        for made, connection in list(self._connections.items()):
            if connection.has_begun:
                self._guarded(made, connection.client.go_on, now_s)
        return now_s

    def _look(self, timeout_s: float) -> None:
        for key, events in self._selector.select(timeout_s):
            key.data(events)

    def finish(self) -> None:
        """Nothing comes in any more: take leave of all clients."""
        for made in list(self._connections):
            made.close(GOING_AWAY, OVER)

    def close(self) -> None:
        """Let the last messages out, for a second at most, and end all connections; may be called more than once."""
        if self._is_over:
            return
        self._is_over = True
        self._listening.close()
        end_s = time.monotonic() + LAST_S
        while any(each.has_more for each in self.clients) and time.monotonic() < end_s:
            self._look(LOOK_S)
            self._go_on()
        self.finish()
        while not all(each.has_ended for each in self._ending) and time.monotonic() < end_s:
            self._look(LOOK_S)
        for made in [*self._connections, *self._ending]:
            made.abort()
        self._near.close()
        self._far.close()
        self._selector.close()

    # -- one connection ----------------------------------------------------------------------------------------------

    def _accept(self, connected: socket.socket) -> None:
        try:
            peer = str(connected.getpeername()[0])
            connected.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
        except OSError:  # it is gone again
            connected.close()
            return
        if not self._has_place():
            connected.close()
            self._refused(peer, "too many clients")
            return
        connection = _Connection(self._make(peer), peer)
        made = WebSocket(
            self._selector,
            connected,
            lambda request: self._ask(connection, request),
            lambda: self._begin(made, connection),
            lambda message: self._take(made, connection, message),
            lambda why: self._gone(made, why),
            self._subprotocols,
            lambda: self._was_read(made, connection),
        )
        self._connections[made] = connection

    def _has_place(self) -> bool:
        """Whether there is a place for another client, if need be that of one which is of no use."""
        if len(self._connections) < MOST_CLIENTS:
            return True
        now_s = time.monotonic()
        for made, connection in self._connections.items():  # the oldest first
            if not connection.has_asked:
                made.abort()
                return True
        idle = [
            (connection.heard_s, made)
            for made, connection in self._connections.items()
            if not connection.client.takes_part and now_s - connection.heard_s > IDLE_S
        ]
        if idle:
            min(idle, key=itemgetter(0))[1].fail("closed to make room for another client")
        return bool(idle)

    def _was_read(self, made: WebSocket, connection: _Connection[C]) -> None:
        connection.heard_s = time.monotonic()
        if made in self._connections:
            self._room.hold(made, made.unfinished + sum(map(len, connection.coming)) + connection.client.unfinished)
            if self._turn.is_over and not self._is_over:
                made.pause()  # until the next one begins

    def _ask(self, connection: _Connection[C], request: Request) -> Refusal | None:
        connection.has_asked = True
        return self._refusal(connection.client, request)

    def _begin(self, made: WebSocket, connection: _Connection[C]) -> None:
        connection.has_begun = True
        self._guarded(made, connection.client.begin, made)

    def _take(self, made: WebSocket, connection: _Connection[C], message: str | bytes) -> None:
        if not self._is_over:
            connection.coming.append(message)
            self._work(made, connection)

    def _work(self, made: WebSocket, connection: _Connection[C]) -> None:
        """Hand on what came, as long as the client is ready for it and it is not too much for once."""
        client, coming = connection.client, connection.coming
        while coming and connection.left and client.is_ready and made.is_open and not self._turn.is_over:
            connection.left -= 1
            self._guarded(made, client.take, coming.popleft())
        if coming or not client.is_ready:
            made.pause()
        else:
            made.resume()

    def _guarded(self, made: WebSocket, step: Callable[[T], object], argument: T) -> None:
        try:
            step(argument)
        except Exception as error:  # whatever a stranger's messages lead to ends this connection alone
            made.close(INTERNAL, f"{type(error).__name__}: {error}"[:LONGEST_REASON])

    def _gone(self, made: WebSocket, why: str) -> None:
        self._ending[made] = time.monotonic()
        self._room.release(made)
        connection = self._connections.pop(made, None)
        if connection is None:
            return
        connection.coming.clear()
        if connection.has_begun:
            connection.client.gone(why)
        else:
            self._refused(connection.peer, why if connection.has_asked else NO_REQUEST)

    # -- the run is not to sleep ---------------------------------------------------------------------------------------

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


def token_of(request: Request) -> str:
    """The token that a request shows: ?token=TOKEN, or Authorization: Bearer TOKEN (RFC 6750)."""
    try:
        given = parse_qs(urlsplit(request.path).query).get("token", [])
    except ValueError:  # a path that is none
        given = []
    if given:
        return given[0]
    kind, _, token = request.headers.get("Authorization", "").partition(" ")
    return token.strip() if kind.lower() == "bearer" else ""

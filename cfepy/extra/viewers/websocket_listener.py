"""`WebSocketListener`: serves clients of a protocol over WebSocket (RFC 6455) while a mission runs.

Input is taken between two steps of the run, and no socket blocks it. A slow client loses messages. A client that sends
invalid data gets an error or loses its connection, and the mission goes on.
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
CONNECTIONS = "(connections)"  # its row for everything except messages
MOST_CLIENTS = 64
MOST_MESSAGES = 256  # of a client between two steps of the run; the others wait
HANDSHAKE_S = 10.0  # wall time in which a client must send its request
IDLE_S = 30.0  # of silence after which a client without subscriptions, publications or calls gives way to another
SILENCE_S = 20.0  # of silence after which a client gets a ping, and then for its answer, when places are few
FAREWELL_S = 2.0  # and for reading the last messages to it
LAST_S, LOOK_S = 1.0, 0.05  # wall time that the end of a run waits for all of them together; between two looks
GOING_AWAY, INTERNAL = 1001, 1011  # RFC 6455, 7.4.1
LONGEST_REASON = 40  # characters; in UTF-8 there is room for 123 bytes
OVER = "the run is over"
NO_REQUEST = "not a WebSocket request"

Refusal = tuple[HTTPStatus, str]


class ConnectedClient(Protocol):
    """The listener's owner provides such an object for each connection."""

    @property
    def is_ready(self) -> bool:
        """True if it takes a message now; if not, the client has to wait."""

    @property
    def unfinished(self) -> int:
        """The bytes that it keeps of incomplete messages."""

    @property
    def takes_part(self) -> bool:
        """True if it subscribes, publishes or offers something, or waits for an answer."""

    def begin(self, connection: WebSocket) -> None:
        """Begin: the connection is ready for both sides."""

    def take(self, message: str | bytes) -> None:
        """Take a message of the client."""

    @property
    def has_more(self) -> bool:
        """True if it has messages for the client that wait for room."""

    def go_on(self, now_s: float) -> None:
        """Go on after a step of the run, or when there is room again."""

    def gone(self, why: str) -> None:
        """Clean up at the end of the connection; called only after `begin`."""


C = TypeVar("C", bound=ConnectedClient)
T = TypeVar("T")


class _Connection(Generic[C]):
    """A connection with its received messages that wait."""

    def __init__(self, client: C, peer: str) -> None:
        self.client = client
        self.peer = peer
        self.since_s = time.monotonic()  # since it was accepted, or since it ends
        self.heard_s = self.since_s  # when it was last heard from
        self.pinged_s = self.since_s
        self.has_asked = self.has_begun = False
        self.coming: deque[str | bytes] = deque()
        self.left = MOST_MESSAGES


class WebSocketListener(Generic[C]):
    """Listens, admits clients, and takes their messages.

    Args:
        place: the address.
        option: the command line option that asks for it, for errors.
        extra: the extra of cfepy that installs its dependencies.
        make: makes the owner's object for a connection from the address of the other side.
        refusal: returns the HTTP status and the reason for a refused request, or None to admit the client.
        refused: called with the address and the reason for a connection that failed.
        subprotocols: the client must ask for one of them, the best first; empty if it need not.

    Attributes:
        place: the address that it listens at, with the actual port.

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
        """The clients that are connected now."""
        return [each.client for each in self._connections.values() if each.has_begun]

    def fileno(self) -> int:
        """Return the descriptor that becomes readable when input arrives."""
        return self._selector.fileno()

    def exchange(self) -> None:
        """Take the messages of clients, and go on with waiting ones."""
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
        """If places are few, end connections that do not answer a ping."""
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
        """Stop all input: close the connections of all clients."""
        for made in list(self._connections):
            made.close(GOING_AWAY, OVER)

    def close(self) -> None:
        """Send the last messages, for a second at most, and end all connections. You may call it more than once."""
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
        """Return True if there is a place for another client. If necessary, close a connection that is not in use."""
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
        """Pass on received messages, as long as the client is ready and its limit for this turn is not reached."""
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
        except Exception as error:  # an error in the handling of a client's messages only ends its connection
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

    # -- waking the run ------------------------------------------------------------------------------------------------

    def _nudge(self) -> None:
        """Wake the run: it must not sleep after its next step, because messages wait."""
        try:
            self._far.send(b"!")
        except BlockingIOError:
            pass  # it is nudged already

    def _nudged(self, events: int) -> None:
        try:
            self._near.recv(4096)
        except BlockingIOError:
            pass  # there was no nudge


def token_of(request: Request) -> str:
    """Return the token of a request: ?token=TOKEN, or Authorization: Bearer TOKEN (RFC 6750)."""
    try:
        given = parse_qs(urlsplit(request.path).query).get("token", [])
    except ValueError:  # an invalid path
        given = []
    if given:
        return given[0]
    kind, _, token = request.headers.get("Authorization", "").partition(" ")
    return token.strip() if kind.lower() == "bearer" else ""

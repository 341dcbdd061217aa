"""One viewer: its subscriptions, the messages to it, and its requests.

Messages of channels are dropped if a viewer does not keep up, the oldest first, so that it shows current data. All
other messages arrive completely; a viewer that leaves too many of them unread is disconnected.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from cfepy.extra.viewers.foxglove.protocol import (
    ERROR,
    FrameError,
    Op,
    Subscribed,
    Unsubscribed,
    message_head,
    ops_of,
    status,
)
from cfepy.extra.viewers.websocket_listener import CONNECTIONS
from cfepy.io import INTO, OUT_OF, PeerCount, PeerCounts

if TYPE_CHECKING:
    from cfepy.extra.viewers.websocket import WebSocket

PEER = "foxglove"
MOST_WAITING = 1024  # messages of channels for one viewer
MOST_BYTES = 1 << 26  # of them; one message may be longer
MOST_UNREAD = 900  # of messages that must not be dropped; the socket keeps a few more
TOO_MUCH = 1008  # RFC 6455, 7.4.1
LOST = "lost on the way to viewers that are too slow, or left"
LONGEST_TROUBLE = 200  # characters


class ViewerChannel(Protocol):
    """A channel that viewers may subscribe to.

    Attributes:
        number: unique number of the channel.
        topic: its name.
        viewers: the subscribed viewers, with the numbers of their subscriptions.
    """

    number: int
    topic: str
    viewers: dict[Viewer, int]

    @property
    def description(self) -> dict[str, Any]:
        """The channel as it is advertised."""

    def greet(self, viewer: Viewer) -> None:
        """Take a new subscriber."""


class _Waiting(NamedTuple):
    """A message that waits for room."""

    channel: int
    frame: bytes
    size: int
    row: PeerCount


class Viewer:
    """A viewer.

    Args:
        counts: counts for the run's report.
        channel: returns the channel of a number, or None.
        welcome: called when the viewer has connected.
        do: carries out requests to the mission or the server.
        farewell: called when it is gone.

    Attributes:
        watched: names of parameters whose changes it has subscribed to.
        watches_graph: True if it has subscribed to changes of the graph.
    """

    def __init__(
        self,
        counts: PeerCounts,
        channel: Callable[[int], ViewerChannel | None],
        welcome: Callable[[Viewer], object],
        do: Callable[[Viewer, Op], object],
        farewell: Callable[[Viewer], object],
    ) -> None:
        self.watched: set[str] = set()
        self.watches_graph = False
        self._counts = counts
        self._channel = channel
        self._welcome = welcome
        self._do = do
        self._farewell = farewell
        self._connection: WebSocket
        self._subscribed: dict[int, ViewerChannel] = {}  # by the viewer's own number
        self._waiting: deque[_Waiting] = deque()
        self._size = 0

    # -- input ---------------------------------------------------------------------------------------------------------

    @property
    def is_ready(self) -> bool:
        """Always True: its publications wait elsewhere for room."""
        return True

    @property
    def unfinished(self) -> int:
        return 0

    @property
    def takes_part(self) -> bool:
        """True if it has a subscription. The server also hears from a viewer that publishes."""
        return bool(self._subscribed or self.watched or self.watches_graph)

    def begin(self, connection: WebSocket) -> None:
        self._connection = connection
        self._counts.of(CONNECTIONS, PEER, OUT_OF).connections += 1
        self._welcome(self)

    def take(self, message: str | bytes) -> None:
        try:
            ops = ops_of(message)
        except FrameError as error:
            self.complain(f"Invalid message: {error}")
            return
        for op in ops:
            if isinstance(op, Subscribed):
                for number, channel in op.pairs:
                    self._subscribe(number, channel)
            elif isinstance(op, Unsubscribed):
                for number in op.numbers:
                    self._unsubscribe(number)
            else:
                self._do(self, op)

    def complain(self, what: str) -> None:
        """Report an error in a message of the viewer, to it and in the run's report."""
        row = self._counts.of(CONNECTIONS, PEER, INTO)
        row.dropped += 1
        row.why = what = what[:LONGEST_TROUBLE]
        self.tell(status(ERROR, what))

    def gone(self, why: str) -> None:
        for number in list(self._subscribed):
            self._unsubscribe(number)
        row = self._counts.of(CONNECTIONS, PEER, OUT_OF)
        row.ended += 1
        row.why = why or row.why
        self._farewell(self)

    # -- channels ----------------------------------------------------------------------------------------------------

    def _subscribe(self, number: int, channel: int) -> None:
        wanted = self._channel(channel)
        if wanted is None:
            self.complain(f"unknown channel {channel}")
        elif number in self._subscribed or self in wanted.viewers:
            self.complain(f"subscription {number}, or one to {wanted.topic}, already exists")
        else:
            self._subscribed[number] = wanted
            wanted.viewers[self] = number
            wanted.greet(self)

    def _unsubscribe(self, number: int) -> None:
        channel = self._subscribed.pop(number, None)
        if channel is not None:
            del channel.viewers[self]
            self._forget(channel.number)

    def ends(self, channel: ViewerChannel) -> None:
        """Drop the subscription to a removed channel."""
        number = channel.viewers.get(self)
        if number is not None:
            self._unsubscribe(number)

    def _forget(self, channel: int) -> None:
        """Drop the waiting messages of a channel."""
        kept = deque(each for each in self._waiting if each.channel != channel)
        for each in self._waiting:
            if each.channel == channel:
                self._lose(each)
        self._waiting = kept

    # -- output --------------------------------------------------------------------------------------------------------

    def tell(self, message: str | bytes) -> None:
        """Send a message that must not be dropped."""
        self._connection.send(message)

    def tell_if_idle(self, message: bytes) -> None:
        """Send a message unless the viewer is behind."""
        if not self._connection.is_slow:
            self._connection.send(message)

    def show(self, channel: ViewerChannel, number: int, data: bytes, time_ns: int, row: PeerCount) -> None:
        """Send a message of a channel, or let it wait; `number` is the number of the subscription."""
        message = _Waiting(channel.number, message_head(number, time_ns) + data, len(data), row)
        if not self._waiting and not self._connection.is_slow:
            self._send(message)
            return
        self._waiting.append(message)
        self._size += message.size
        self._send_on()
        while len(self._waiting) > MOST_WAITING or (self._size > MOST_BYTES and len(self._waiting) > 1):
            self._lose(self._waiting.popleft())

    @property
    def has_more(self) -> bool:
        return bool(self._waiting)

    def go_on(self, now_s: float) -> None:
        connection = self._connection
        if connection.unread >= MOST_UNREAD or connection.dropped:
            connection.close(TOO_MUCH, "too much is unread")
        else:
            self._send_on()

    def _send_on(self) -> None:
        waiting, connection = self._waiting, self._connection
        if waiting and connection.is_slow:
            connection.flush()
        while waiting and not connection.is_slow:
            message = waiting.popleft()
            self._size -= message.size
            self._send(message)

    def _send(self, message: _Waiting) -> None:
        self._connection.send(message.frame)
        message.row.messages += 1
        message.row.size += message.size

    def _lose(self, message: _Waiting) -> None:
        self._size -= message.size
        message.row.dropped += 1
        message.row.why = LOST

"""One viewer: what it has subscribed to, what it gets of it, and what it wants from the mission.

Messages of channels are lost when a viewer does not keep up, the oldest first, so that what it shows is of now. All
else it gets whole; one that leaves too much of that unread is sent away.
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
MOST_UNREAD = 900  # of what is not to be lost; the socket keeps few more
TOO_MUCH = 1008  # RFC 6455, 7.4.1
LOST = "lost on the way to viewers that are too slow, or left"
LONGEST_TROUBLE = 200  # characters


class ViewerChannel(Protocol):
    """What a viewer may subscribe to.

    Attributes:
        number: of the channel, no other's.
        topic: its name.
        viewers: those that have subscribed, with the numbers of their subscriptions.
    """

    number: int
    topic: str
    viewers: dict[Viewer, int]

    @property
    def description(self) -> dict[str, Any]:
        """The channel as it is advertised."""

    def greet(self, viewer: Viewer) -> None:
        """A viewer has subscribed."""


class _Waiting(NamedTuple):
    """A message that waits for room."""

    channel: int
    frame: bytes
    size: int
    row: PeerCount


class Viewer:
    """A viewer.

    Args:
        counts: of the run's report.
        channel: the channel of a number, if there is one.
        welcome: called when the viewer is there.
        do: does what it asks of the mission, or of the server.
        farewell: called when it is gone.

    Attributes:
        watched: names of parameters of whose changes it wants to hear.
        watches_graph: whether it wants to hear of those of the graph.
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

    # -- what comes --------------------------------------------------------------------------------------------------

    @property
    def is_ready(self) -> bool:
        """What it publishes waits elsewhere for room."""
        return True

    @property
    def unfinished(self) -> int:
        return 0

    @property
    def takes_part(self) -> bool:
        """One that publishes is heard now and then."""
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
        """Tell the viewer, and the report, what is wrong with something that it has sent."""
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
        """There is no such channel any more."""
        number = channel.viewers.get(self)
        if number is not None:
            self._unsubscribe(number)

    def _forget(self, channel: int) -> None:
        """Messages of a channel are not wanted any more."""
        kept = deque(each for each in self._waiting if each.channel != channel)
        for each in self._waiting:
            if each.channel == channel:
                self._lose(each)
        self._waiting = kept

    # -- what goes ---------------------------------------------------------------------------------------------------

    def tell(self, message: str | bytes) -> None:
        """Send what is not to be lost."""
        self._connection.send(message)

    def tell_if_idle(self, message: bytes) -> None:
        """Send what a viewer that is behind does not need."""
        if not self._connection.is_slow:
            self._connection.send(message)

    def show(self, channel: ViewerChannel, number: int, data: bytes, time_ns: int, row: PeerCount) -> None:
        """Send a message of a channel, or let it wait; `number` is that of the subscription."""
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

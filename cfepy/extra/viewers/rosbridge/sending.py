"""Delivery of a topic's messages to a client: its subscriptions, rates and queues (ROSBRIDGE_PROTOCOL.md 3.4.4).

A client may subscribe to a topic more than once, under several ids. It gets each message once, at the highest of the
rates, with the shortest of the queues and the strongest of the compressions.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

NONE, PNG, CBOR, CBOR_RAW = "none", "png", "cbor", "cbor-raw"
COMPRESSIONS = (NONE, PNG, CBOR, CBOR_RAW)
"""Compressions, from the weakest."""
LONGEST_QUEUE = 10_000
MOST_QUEUED_BYTES = 8 << 20  # of the messages of a topic that wait for a client

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Wish:
    """The options of one `subscribe`.

    Attributes:
        throttle_ms: minimum wall time in ms between two messages; 0 for none.
        queue_length: maximum number of messages that wait; 0 drops messages that come too early.
        compression: one of `COMPRESSIONS`; other values mean none.
    """

    throttle_ms: int = 0
    queue_length: int = 0
    compression: str = NONE


class Pacing(Generic[T]):
    """Schedules the messages of one topic to a client.

    Args:
        size_of: returns the bytes of a message.

    Attributes:
        compression: the compression of the messages.
        dropped: messages dropped because the queue was full. Messages that the rate leaves out do not count.
    """

    def __init__(self, size_of: Callable[[T], int] = lambda message: 0) -> None:
        self._size_of = size_of
        self.compression = NONE
        self.dropped = 0
        self._wishes: dict[object, Wish] = {}
        self._throttle_s = 0.0
        self._length = 0
        self._queue: deque[T] = deque()
        self._size = 0  # of the waiting messages
        self._last_s = float("-inf")

    @property
    def wishes(self) -> int:
        """The number of subscriptions."""
        return len(self._wishes)

    def want(self, name: object, wish: Wish) -> None:
        """Add a subscription under an id, or replace it."""
        self._wishes[name] = wish
        self._settle()

    def want_no_more(self, name: object) -> bool:
        """Remove a subscription, or all of them if `name` is None. Returns True if no subscription is left."""
        if name is None:
            self._wishes.clear()
        self._wishes.pop(name, None)
        self._settle()
        return not self._wishes

    def _settle(self) -> None:
        wishes = self._wishes.values()
        self._throttle_s = min((each.throttle_ms for each in wishes), default=0) / 1000
        self._length = min((each.queue_length for each in wishes), default=0)
        ranks = [COMPRESSIONS.index(each.compression) for each in wishes if each.compression in COMPRESSIONS]
        self.compression = COMPRESSIONS[max(ranks, default=0)]

    def add(self, message: T, now_s: float) -> T | None:
        """Accept a message.

        Args:
            message: the message.
            now_s: wall time in s since an arbitrary instant.

        Returns:
            The message if it may be sent now, otherwise None.
        """
        is_time = now_s >= self._last_s + self._throttle_s
        if is_time and not self._queue:
            self._last_s = now_s
            return message
        if self._length:
            self._queue.append(message)
            self._size += self._size_of(message)
            while len(self._queue) > self._length or self._size > MOST_QUEUED_BYTES:
                self._size -= self._size_of(self._queue.popleft())
                self.dropped += 1
        return None

    def due(self, now_s: float) -> T | None:
        """Return the next waiting message that is due, or None."""
        if not self._queue or now_s < self._last_s + self._throttle_s:
            return None
        self._last_s = now_s
        message = self._queue.popleft()
        self._size -= self._size_of(message)
        return message

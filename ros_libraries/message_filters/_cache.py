"""`Cache`: the last messages of a filter, looked up by time."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ._filters import SimpleFilter, stamp_of


class Cache(SimpleFilter):
    """Keeps the last messages that arrived, and passes them on.

    Args:
        f: the filter that sends them.
        cache_size: how many are kept.
        allow_headerless: use the time of arrival for messages without a header.
    """

    def __init__(self, f: SimpleFilter, cache_size: int = 1, allow_headerless: bool = False) -> None:
        super().__init__()
        self.cache_size = cache_size
        self.cache_msgs: list[Any] = []
        self.cache_times: list[Any] = []
        self.allow_headerless = allow_headerless
        self.connectInput(f)

    def connectInput(self, f: SimpleFilter) -> None:
        """Take the messages of a filter."""
        self.incoming_connection = f.registerCallback(self.add)

    def add(self, msg: Any) -> None:
        """A message came."""
        stamp = stamp_of(msg, self.allow_headerless)
        if stamp is None:
            return
        self.cache_times.append(stamp)
        self.cache_msgs.append(msg)
        if len(self.cache_msgs) > self.cache_size:
            del self.cache_msgs[0], self.cache_times[0]
        self.signalMessage(msg)

    def __pairs(self) -> Iterator[tuple[Any, Any]]:
        return zip(self.cache_times, self.cache_msgs, strict=True)

    def getInterval(self, from_stamp: Any, to_stamp: Any) -> list[Any]:
        """Return the messages between two times, both included, in the order of arrival.

        Raises:
            AssertionError: the first time is after the second.
        """
        assert from_stamp <= to_stamp
        return [msg for stamp, msg in self.__pairs() if from_stamp <= stamp <= to_stamp]

    def getElemAfterTime(self, stamp: Any) -> Any:
        """Return the first message that came with this stamp or a later one, or None."""
        return next((msg for time, msg in self.__pairs() if time >= stamp), None)

    def getElemBeforeTime(self, stamp: Any) -> Any:
        """Return the last message that came with this stamp or an earlier one, or None."""
        older = [msg for time, msg in self.__pairs() if time <= stamp]
        return older[-1] if older else None

    def getLatestTime(self) -> Any:
        """Return the stamp of the message that came last, or None."""
        return self.cache_times[-1] if self.cache_times else None

    getLastestTime = getLatestTime  # the misspelt name is part of ROS's interface

    def getOldestTime(self) -> Any:
        """Return the stamp of the kept message that arrived first, or None."""
        return self.cache_times[0] if self.cache_times else None

    def getLast(self) -> Any:
        """Return the first message that came with the last stamp, or None."""
        latest = self.getLatestTime()
        return None if latest is None else self.getElemAfterTime(latest)

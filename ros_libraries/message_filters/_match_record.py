"""Numbers of synchronizers, with which a run explains why one never called back.

cfepy reads `records` at the end of a run. A record looks for the nearest match only until there is one, so it costs
nothing afterwards.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from typing import Any

REMEMBERED = 100  # stamps of dropped messages that are remembered for each input

records: list[MatchRecord] = []
"""The record of each synchronizer of the node."""


class MatchRecord:
    """Numbers of one synchronizer.

    Args:
        synchronizer: the synchronizer, for its name and its callbacks.
        inputs: its filters.

    Attributes:
        inputs: the topics of the filters.
        counts: messages of each input.
        unstamped: messages of each input that have no stamp.
        matches: sets that were passed on.
        nearest_ns: smallest difference of stamps among waiting messages of all inputs; None before there was a set.
        late_ns: the same, with messages that were dropped because the queue was full.
    """

    def __init__(self, synchronizer: Any, inputs: Sequence[Any]) -> None:
        self._synchronizer = synchronizer
        self._dropped: list[deque[int]] = [deque(maxlen=REMEMBERED) for _ in inputs]
        self.inputs = [_name(each) for each in inputs]
        self.counts = [0] * len(inputs)
        self.unstamped = [0] * len(inputs)
        self.matches = 0
        self.nearest_ns: int | None = None
        self.late_ns: int | None = None
        records.append(self)

    @property
    def kind(self) -> str:
        """The name of the synchronizer's class."""
        return type(self._synchronizer).__name__

    @property
    def has_callback(self) -> bool:
        """Whether a callback is registered."""
        return bool(self._synchronizer.callbacks)

    @property
    def queue_size(self) -> int:
        """The number of messages of each input that wait."""
        return int(self._synchronizer.queue_size)

    @property
    def slop_ns(self) -> int | None:
        """The permitted difference of stamps; None if they must be equal."""
        slop = getattr(self._synchronizer, "slop", None)
        return None if slop is None else int(slop.to_nsec())

    def count(self, index: int | None, stamp: Any, queues: Sequence[Mapping[Any, Any]]) -> None:
        """Count a message, and measure how near the other inputs are."""
        if index is None:
            return
        self.counts[index] += 1
        if self.matches:
            return
        others = [number for number in range(len(queues)) if number != index]
        waiting = [[each.to_nsec() for each in queues[number]] for number in others]
        with_dropped = [[*each, *self._dropped[number]] for number, each in zip(others, waiting, strict=True)]
        self.nearest_ns = _smaller(self.nearest_ns, _spread(stamp.to_nsec(), waiting))
        self.late_ns = _smaller(self.late_ns, _spread(stamp.to_nsec(), with_dropped))

    def refuse(self, index: int | None) -> None:
        """Count a message without a stamp."""
        if index is not None:
            self.unstamped[index] += 1

    def drop(self, index: int | None, stamp: Any) -> None:
        """Remember the stamp of a message that was dropped from a full queue."""
        if index is not None and not self.matches:
            self._dropped[index].append(stamp.to_nsec())


def _name(source: Any) -> str:
    """Return the topic of a filter, or its class if it has none."""
    sub = getattr(source, "sub", None)
    return str(getattr(sub, "resolved_name", "") or type(source).__name__)


def _spread(stamp: int, others: Sequence[Sequence[int]]) -> int | None:
    """Return the time in ns between the earliest and the latest stamp of the nearest set."""
    if not all(others):
        return None
    stamps = [stamp, *(min(each, key=lambda other: abs(other - stamp)) for each in others)]
    return max(stamps) - min(stamps)


def _smaller(one: int | None, other: int | None) -> int | None:
    return other if one is None else one if other is None else min(one, other)

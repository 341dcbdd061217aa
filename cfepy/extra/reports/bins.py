"""Numbers of a run that are collected while it goes on, in memory that does not grow with it.

The bins of a long run are wider than a race. So `ExactActivity` always has the last activities. At each mark, and at
the end of the run, these become part of a window that also gets the next ones. A short run is one window.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from itertools import islice
from typing import NamedTuple

MOST_BINS = 16_384
FINEST_NS = 1_000
EXACT_BITS = 6  # of a time in a histogram: shares of 1 in 64, so that a percentile is at most 1.6 % too low
BEFORE, AFTER = 1_000, 500
MOST_ACTIVITIES = 12_000
"""Activities in all windows; the window at the end of the run comes on top."""


class Bins:
    """Amounts by time. If there are too many bins, pairs of bins are merged.

    Attributes:
        width_ns: width of a bin.
        counts: the amount in each bin.
    """

    __slots__ = ("counts", "width_ns")

    def __init__(self) -> None:
        self.width_ns = FINEST_NS
        self.counts: list[int] = []

    def add(self, at_ns: int, amount: int = 1) -> None:
        """Add an amount at a virtual time."""
        index = at_ns // self.width_ns
        while index >= MOST_BINS:
            self.fold()
            index = at_ns // self.width_ns
        counts = self.counts
        if index >= len(counts):
            counts.extend([0] * (index + 1 - len(counts)))
        counts[index] += amount

    def add_span(self, start_ns: int, end_ns: int) -> None:
        """Add a span: every bin gets the ns of the span that lie in it."""
        while start_ns < end_ns:
            until = min(end_ns, (start_ns // self.width_ns + 1) * self.width_ns)
            self.add(start_ns, until - start_ns)
            start_ns = until

    def fold(self) -> None:
        """Merge pairs of bins to bins of twice the width."""
        counts = self.counts
        self.width_ns *= 2
        self.counts = [sum(counts[index : index + 2]) for index in range(0, len(counts), 2)]

    def runs(self, width_ns: int) -> list[int]:
        """Return the counts, run-length coded as value, number, value, number, ..., with bins at least `width_ns`
        wide.
        """
        while self.width_ns < width_ns:
            self.fold()
        found: list[int] = []
        for count in self.counts:
            if found and found[-2] == count:
                found[-1] += 1
            else:
                found += [count, 1]
        return found


class Histogram:
    """Times in ns, by size.

    Attributes:
        count: number of times.
        most_ns: the longest.
    """

    __slots__ = ("_by_size", "count", "most_ns")

    def __init__(self) -> None:
        self._by_size: dict[int, int] = {}
        self.count = 0
        self.most_ns = 0

    def add(self, time_ns: int) -> None:
        """Add a time."""
        self.count += 1
        self.most_ns = max(self.most_ns, time_ns)
        excess = max(0, time_ns.bit_length() - EXACT_BITS - 1)
        size = time_ns >> excess << excess
        self._by_size[size] = self._by_size.get(size, 0) + 1

    def percentiles(self, shares: Sequence[float]) -> list[int]:
        """Return the times in ns that these shares of all times, in rising order, do not exceed; [] if there are
        none.
        """
        found: list[int] = []
        passed = 0
        for size, count in sorted(self._by_size.items()):
            passed += count
            while len(found) < len(shares) and passed >= shares[len(found)] * self.count:
                found.append(size)
        return found

    def octaves(self) -> dict[int, int]:
        """Return the number of times by their number of bits, for a picture: 0 is 0 ns, 10 is 512 to 1023 ns."""
        found: dict[int, int] = {}
        for size, count in sorted(self._by_size.items()):
            bits = size.bit_length()
            found[bits] = found.get(bits, 0) + count
        return found


class Activity(NamedTuple):
    """A task that ran for some time, or a message that was sent at an instant.

    Attributes:
        lane: name of the application, or the MsgId.
        begin_ns, end_ns: its virtual times; equal for a message.
    """

    lane: str | int
    begin_ns: int
    end_ns: int


class ExactWindow(NamedTuple):
    """All activities of a time range.

    Attributes:
        from_ns, to_ns: the range; all activities in it are known.
        activities: in the order in which they ended.
    """

    from_ns: int
    to_ns: int
    activities: list[Activity]


class ExactActivity:
    """Keeps activities; see the module.

    Attributes:
        windows: the windows, in the order of time.
    """

    def __init__(self) -> None:
        self.windows: list[ExactWindow] = []
        self._ring: deque[Activity] = deque(maxlen=BEFORE + 1)  # the oldest one only tells where the others begin
        self._number = 0  # of the last activity, from 1
        self._kept = 0  # number of the last activity in a window
        self._left = 0  # activities that the current window still gets
        self._count = 0

    def add(self, lane: str | int, begin_ns: int, end_ns: int) -> None:
        """Add an activity that has ended."""
        self._number += 1
        self._ring.append(Activity(lane, begin_ns, end_ns))
        if self._left:
            self._left -= 1
            self._take(1)

    def keep(self) -> None:
        """Keep the last activities, and the next ones, because something happened now."""
        if self._count < MOST_ACTIVITIES:
            self._take(BEFORE)
            self._left = AFTER

    def conclude(self, end_ns: int) -> None:
        """Keep the last activities of the run, which ends at `end_ns`."""
        self._take(BEFORE)
        if self.windows and self._kept == self._number:
            self.windows[-1] = self.windows[-1]._replace(to_ns=max(end_ns, self.windows[-1].to_ns))

    def _take(self, most: int) -> None:
        """Move at most this number of activities, the last ones, from the ring to a window."""
        count = min(most, self._number - self._kept, len(self._ring))
        if not count:
            return
        first = len(self._ring) - count
        taken = list(islice(self._ring, first, None))
        if self.windows and self._number - self._kept == count:
            window = self.windows[-1]
            window.activities.extend(taken)
            self.windows[-1] = window._replace(to_ns=taken[-1].end_ns)
        else:
            begins_ns = 0 if self._number == count else self._ring[first - 1].end_ns if first else taken[0].end_ns
            self.windows.append(ExactWindow(begins_ns, taken[-1].end_ns, taken))
        self._kept = self._number
        self._count += count

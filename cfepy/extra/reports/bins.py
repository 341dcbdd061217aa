"""Numbers of a run that are collected while it goes on, in memory that does not grow with it."""

from __future__ import annotations

from collections.abc import Sequence

MOST_BINS = 16_384
FINEST_NS = 1_000
EXACT_BITS = 6  # of a time in a histogram: shares of 1 in 64, so that a percentile is at most 1.6 % too low


class Bins:
    """How much of something there was, by time; two bins become one when they are too many.

    Attributes:
        width_ns: of a bin.
        counts: what is in each.
    """

    __slots__ = ("counts", "width_ns")

    def __init__(self) -> None:
        self.width_ns = FINEST_NS
        self.counts: list[int] = []

    def add(self, at_ns: int, amount: int = 1) -> None:
        """Something happened at a virtual time."""
        index = at_ns // self.width_ns
        while index >= MOST_BINS:
            self.fold()
            index = at_ns // self.width_ns
        counts = self.counts
        if index >= len(counts):
            counts.extend([0] * (index + 1 - len(counts)))
        counts[index] += amount

    def add_span(self, start_ns: int, end_ns: int) -> None:
        """Something lasted: every bin gets the ns that lie in it."""
        while start_ns < end_ns:
            until = min(end_ns, (start_ns // self.width_ns + 1) * self.width_ns)
            self.add(start_ns, until - start_ns)
            start_ns = until

    def fold(self) -> None:
        """Bins of twice the width."""
        counts = self.counts
        self.width_ns *= 2
        self.counts = [sum(counts[index : index + 2]) for index in range(0, len(counts), 2)]

    def runs(self, width_ns: int) -> list[int]:
        """The counts with bins of a width that is no smaller, as value, number of times, value, number, ..."""
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
        count: how many.
        most_ns: the longest.
    """

    __slots__ = ("_by_size", "count", "most_ns")

    def __init__(self) -> None:
        self._by_size: dict[int, int] = {}
        self.count = 0
        self.most_ns = 0

    def add(self, time_ns: int) -> None:
        """Take one."""
        self.count += 1
        self.most_ns = max(self.most_ns, time_ns)
        excess = max(0, time_ns.bit_length() - EXACT_BITS - 1)
        size = time_ns >> excess << excess
        self._by_size[size] = self._by_size.get(size, 0) + 1

    def percentiles(self, shares: Sequence[float]) -> list[int]:
        """The times that these shares of all, in rising order, do not exceed, in ns; [] when there is nothing."""
        found: list[int] = []
        passed = 0
        for size, count in sorted(self._by_size.items()):
            passed += count
            while len(found) < len(shares) and passed >= shares[len(found)] * self.count:
                found.append(size)
        return found

    def octaves(self) -> dict[int, int]:
        """How many there were by the number of bits of the time, for a picture: 0 is 0 ns, 10 is 512 to 1023 ns."""
        found: dict[int, int] = {}
        for size, count in sorted(self._by_size.items()):
            bits = size.bit_length()
            found[bits] = found.get(bits, 0) + count
        return found

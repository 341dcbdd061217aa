"""The samples of one frame's transform to its parent: over time (tf2::TimeCache), or forever (tf2::StaticCache).

Times are ints in ns. Imports tf2_py._rotation only.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right

from tf2_py._rotation import Sample, between

OLD_DATA = (
    "TF_OLD_DATA ignoring data from the past (Possible reasons are listed at http://wiki.ros.org/tf/Errors%20explained)"
)
REPEATED_DATA = "TF_REPEATED_DATA ignoring data with redundant timestamp"


def seconds(time_ns: int) -> float:
    """Return a time in ns as ROS's C++ code gives it in seconds."""
    whole, part = divmod(time_ns, 1_000_000_000)
    return whole + 1e-9 * part


class TimeCache:
    """Samples in the order of their stamps. Samples older than the newest by more than the cache time are removed.

    Args:
        keep_ns: the cache time.
    """

    __slots__ = ("_keep_ns", "_samples", "_stamps")

    def __init__(self, keep_ns: int) -> None:
        self._keep_ns = keep_ns
        self._stamps: list[int] = []
        self._samples: list[Sample] = []

    def insert(self, stamp: int, sample: Sample) -> str:
        """Take in a sample.

        Returns:
            why it was not taken, or "".
        """
        stamps = self._stamps
        if stamps and stamps[-1] > stamp + self._keep_ns:
            return OLD_DATA
        at = bisect_left(stamps, stamp)
        if at < len(stamps) and stamps[at] == stamp:
            return REPEATED_DATA
        stamps.insert(at, stamp)
        self._samples.insert(at, sample)
        outdated = bisect_left(stamps, stamps[-1] - self._keep_ns)
        if outdated:
            del stamps[:outdated], self._samples[:outdated]
        return ""

    def sample(self, time: int) -> Sample | None:
        """Return the interpolated sample at a time, or the newest for time 0; None if the time is not covered."""
        stamps = self._stamps
        if not stamps:
            return None
        if not time:
            return self._samples[-1]
        at = bisect_right(stamps, time) - 1
        if at < 0:
            return None
        before = stamps[at]
        older = self._samples[at]
        if before == time:
            return older
        if at + 1 == len(stamps):
            return None
        newer = self._samples[at + 1]
        if newer[0] != older[0]:
            return older  # the frame got another parent in between
        return between(older, newer, (time - before) / (stamps[at + 1] - before))

    def complaint(self, time: int) -> str:
        """Return the reason why there is no sample at a time."""
        if not self._stamps:
            return ""
        first, last, asked = self._stamps[0], self._stamps[-1], f"{seconds(time):.9f}"
        if first == last:
            only = f"but only time {seconds(last):.9f} is in the buffer"
            return f"Lookup would require extrapolation at time {asked}, {only}"
        way, end, edge, distance = (
            ("future", "latest", last, time - last) if time > last else ("past", "earliest", first, first - time)
        )
        return (
            f"Lookup would require extrapolation {seconds(distance):.9f}s into the {way}.  "
            f"Requested time {asked} but the {end} data is at time {seconds(edge):.9f}"
        )

    def latest(self) -> tuple[int, str]:
        """Return the stamp and the parent of the newest sample, or 0 and "" if there is none."""
        return (self._stamps[-1], self._samples[-1][0]) if self._stamps else (0, "")

    def oldest_stamp(self) -> int:
        """Return the stamp of the oldest sample, or 0 if there is none."""
        return self._stamps[0] if self._stamps else 0

    def clear(self) -> None:
        """Forget all samples."""
        self._stamps.clear()
        self._samples.clear()

    def __len__(self) -> int:
        return len(self._stamps)


class StaticCache:
    """One sample that holds at all times."""

    __slots__ = ("_sample",)

    def __init__(self) -> None:
        self._sample: Sample | None = None

    def insert(self, stamp: int, sample: Sample) -> str:
        """Replace the sample."""
        self._sample = sample
        return ""

    def sample(self, time: int) -> Sample | None:
        """Return the sample."""
        return self._sample

    def complaint(self, time: int) -> str:
        """Nothing: there is a sample at any time."""
        return ""

    def latest(self) -> tuple[int, str]:
        """Return stamp 0, which stands for all times, and the parent."""
        return 0, "" if self._sample is None else self._sample[0]

    def oldest_stamp(self) -> int:
        """0, as `latest`."""
        return 0

    def clear(self) -> None:
        """Do nothing: a static sample survives a reset of the clock."""

    def __len__(self) -> int:
        return 1

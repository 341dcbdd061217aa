"""The progress of a campaign: counts, rate and remaining time, for a terminal or for a log."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol, TextIO

from cfepy.rtos import Stopwatch
from cfepy.units import NS_PER_S
from cfepy.writing.escapes import keep_output_safe, rich_console

EVERY_NS = 10 * NS_PER_S  # wall time between two lines in a log
SETTLE_NS = NS_PER_S  # wall time after which a rate is meaningful


class Progress(Protocol):
    """Shows the progress of a campaign."""

    def arrived(self, failed: bool) -> None:
        """Count a verdict, in any order."""

    def close(self) -> None:
        """End the display when the campaign is over. Only finished lines may stay on the screen."""


class NoProgress:
    """Shows nothing."""

    def arrived(self, failed: bool) -> None:
        """Do nothing."""

    def close(self) -> None:
        """Do nothing."""


class CampaignMeter:
    """Counts verdicts against the wall clock.

    Args:
        total: the most schedules; None for any number.
        resumed: schedules that an earlier run has done; these do not count for the rate.
        elapsed_ns: wall time since the start, in ns.
        budget_s: wall time after which no further schedule begins; None for no limit.

    Attributes:
        done, failed: so far.
    """

    def __init__(
        self,
        total: int | None,
        resumed: int = 0,
        elapsed_ns: Callable[[], int] | None = None,
        budget_s: float | None = None,
    ) -> None:
        self.total = total
        self.done = self.failed = 0
        self._budget_s = budget_s
        self._resumed = resumed if total is None else min(resumed, total)
        self.elapsed_ns = Stopwatch().elapsed_ns if elapsed_ns is None else elapsed_ns

    def arrived(self, failed: bool) -> None:
        """Count a verdict."""
        self.done += 1
        self.failed += failed

    @property
    def rate(self) -> float:
        """Schedules per second of wall time; 0 until it can be estimated."""
        fresh, elapsed = self.done - self._resumed, self.elapsed_ns()
        return fresh * NS_PER_S / elapsed if fresh > 0 and elapsed >= SETTLE_NS else 0.0

    @property
    def left_s(self) -> float | None:
        """Seconds of wall time until all schedules are done, or no more begin; None until it can be estimated."""
        budget_s = None if self._budget_s is None else max(0.0, self._budget_s - self.elapsed_ns() / NS_PER_S)
        by_rate_s = (self.total - self.done) / self.rate if self.rate and self.total is not None else None
        return min((each for each in (budget_s, by_rate_s) if each is not None), default=None)

    @property
    def share(self) -> float:
        """The finished share, 0 to 1: of the schedules or of the wall time, whichever is nearer to its end."""
        by_count = 0.0 if not self.total else self.done / self.total
        by_time = 0.0 if not self._budget_s else self.elapsed_ns() / NS_PER_S / self._budget_s
        return min(1.0, max(by_count, by_time))

    def text(self) -> str:
        """Return the progress in a line: `1200 of 5000 schedules, 3 failed, 85.0/s, 0:00:44 left`."""
        count = f"{self.done}" if self.total is None else f"{self.done} of {self.total}"
        parts = [f"{count} schedules", f"{self.failed} failed"]
        if self.rate:
            parts.append(f"{self.rate:.1f}/s")
        if self.left_s is not None and self.done != self.total:
            parts.append(f"{duration(self.left_s)} left")
        return ", ".join(parts)


def duration(seconds: float) -> str:
    """Return hours, minutes and seconds: `0:01:30`."""
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes // 60}:{minutes % 60:02}:{rest:02}"


class PlainProgress:
    """A line every ten seconds, for logs.

    Args:
        meter: counts.
        stream: the output.
    """

    def __init__(self, meter: CampaignMeter, stream: TextIO) -> None:
        self._meter = meter
        self._stream = stream
        self._due_ns = EVERY_NS

    def arrived(self, failed: bool) -> None:
        self._meter.arrived(failed)
        if self._meter.elapsed_ns() >= self._due_ns:
            print(self._meter.text(), file=self._stream, flush=True)
            self._due_ns = self._meter.elapsed_ns() + EVERY_NS

    def close(self) -> None:
        """Do nothing: all written lines are finished."""


class BarProgress:
    """A bar on a terminal; lines that are printed meanwhile appear above it.

    Args:
        meter: counts.
        stream: the terminal.
    """

    def __init__(self, meter: CampaignMeter, stream: TextIO) -> None:
        from rich.progress import BarColumn, TextColumn
        from rich.progress import Progress as RichProgress

        self._meter = meter
        columns: tuple[Any, ...] = (BarColumn(), TextColumn("{task.description}"))
        self._bar = RichProgress(*columns, console=rich_console(stream), transient=True)
        self._task = self._bar.add_task(meter.text(), total=1.0)
        self._bar.start()
        keep_output_safe()

    def arrived(self, failed: bool) -> None:
        self._meter.arrived(failed)
        self._bar.update(self._task, completed=self._meter.share, description=self._meter.text())

    def close(self) -> None:
        self._bar.stop()


def make_progress(
    stream: TextIO | None, total: int | None, resumed: int = 0, budget_s: float | None = None
) -> Progress:
    """Return a bar for a terminal, lines for other streams.

    Args:
        stream: the output; None shows nothing.
        total: the most schedules; None for any number.
        resumed: schedules that an earlier run has done.
        budget_s: wall time after which no further schedule begins.
    """
    if stream is None:
        return NoProgress()
    meter = CampaignMeter(total, resumed, budget_s=budget_s)
    return BarProgress(meter, stream) if stream.isatty() else PlainProgress(meter, stream)

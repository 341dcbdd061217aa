"""The wall clock, for code outside of a run: a stopwatch, and pacing virtual time to real time.

Pacing is a wrapper around running the kernel, not a mode of it: it sleeps until the next event is due, then lets the
kernel run. So a paced run has the trace of a free one. Code that brings input from outside gives the pacer another
function to sleep with, which returns when input arrives. This is one of the few modules that may read the wall clock.
"""

from __future__ import annotations

import time
from collections.abc import Callable

from cfepy.rtos.kernel import Kernel
from cfepy.units import NS_PER_S

STEP_NS = 1_000_000  # wall time: what is due within a millisecond runs in one go
ANSWER_NS = 100_000  # virtual time by which a run may be ahead, so that what a call costs does not cut an answer in two
PATIENCE_NS = 50_000_000  # wall time: longest sleep


class Stopwatch:
    """Wall-clock time since it was made."""

    def __init__(self) -> None:
        self._start = time.perf_counter_ns()

    def elapsed_ns(self) -> int:
        """Nanoseconds since the start."""
        return time.perf_counter_ns() - self._start


class Pacer:
    """Keeps the virtual clock of a kernel at a multiple of real time.

    A run that cannot keep up falls behind, and catches up as soon as it can.

    Args:
        kernel: the kernel to pace, at the moment that pacing starts.
        run_until: runs it until a virtual time in ns: `Kernel.run`, or what wraps it.
        factor: virtual seconds for a real one, more than 0.
        wait: sleeps for so many real seconds, more than 0, or less when there is input for the run.
        elapsed_ns: the clock on the wall, in ns since some instant; another one for tests.
    """

    def __init__(
        self,
        kernel: Kernel,
        run_until: Callable[[int], object],
        factor: float = 1.0,
        wait: Callable[[float], object] = time.sleep,
        elapsed_ns: Callable[[], int] | None = None,
    ) -> None:
        if not factor > 0:
            raise ValueError(f"factor must be greater than 0, not {factor}")
        self._kernel = kernel
        self._run_until = run_until
        self._factor = factor
        self._wait = wait
        self._virtual_start = kernel.now
        self._elapsed_ns = elapsed_ns or Stopwatch().elapsed_ns

    def step(self, until_ns: int) -> None:
        """Wait for the next event to be due and run it, at most until a virtual time in ns.

        It comes back after some 50 ms of wall time at the latest, so that the caller can look after other things, and
        calls again until the clock is where it wants it.
        """
        elapsed = self._elapsed_ns()
        latest = self._due(elapsed + PATIENCE_NS)
        upcoming = self._kernel.next_event()
        idle_until = latest if upcoming is None else min(upcoming, latest)
        now = self._due(elapsed)
        if self._kernel.ready:  # input has made a task ready
            self._run_until(max(min(now + ANSWER_NS, until_ns), self._kernel.now))
            return
        is_due = upcoming is not None and upcoming <= now
        target = min(now if is_due else max(idle_until, self._due(elapsed + STEP_NS)), until_ns)
        ahead = self._wall_of(target) - self._elapsed_ns()
        if ahead > 0:
            self._wait(ahead / NS_PER_S)
            target = min(target, self._due(self._elapsed_ns()))  # earlier when input ended the wait
        self._run_until(max(target, self._kernel.now))

    def _due(self, wall_ns: int) -> int:
        """The virtual time that belongs to a wall time."""
        return self._virtual_start + int(wall_ns * self._factor)

    def _wall_of(self, virtual_ns: int) -> int:
        return int((virtual_ns - self._virtual_start) / self._factor)

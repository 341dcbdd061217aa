"""The wall clock, for code outside of a run: a stopwatch, and pacing of virtual time to real time.

Pacing wraps the kernel; it is not a mode of the kernel. It sleeps until the next event is due, then runs the kernel. So
a paced run has the same trace as a free run. Code that brings input from outside gives the pacer its own sleep
function, which returns when input arrives. This is one of the few modules that may read the wall clock.
"""

from __future__ import annotations

import time
from collections.abc import Callable

from cfepy.rtos.kernel import Kernel
from cfepy.units import NS_PER_S

STEP_NS = 1_000_000  # wall time: events that are due within a millisecond run together
ANSWER_NS = 100_000  # virtual time by which a run may be ahead, so that the cost of a call does not split an answer
PATIENCE_NS = 50_000_000  # wall time: longest sleep


class Stopwatch:
    """Wall-clock time since the object was created."""

    def __init__(self) -> None:
        self._start = time.perf_counter_ns()

    def elapsed_ns(self) -> int:
        """Return the nanoseconds since the start."""
        return time.perf_counter_ns() - self._start


class Pacer:
    """Keeps the virtual clock of a kernel at a multiple of real time.

    A run that cannot keep up falls behind, and catches up as soon as it can.

    Args:
        kernel: the kernel to pace, as it is when pacing starts.
        run_until: runs the kernel until a virtual time in ns: `Kernel.run`, or a wrapper of it.
        factor: virtual seconds per real second, more than 0.
        wait: sleeps for the given number of real seconds, more than 0, or less if input for the run arrives.
        elapsed_ns: the wall clock, in ns since an arbitrary time; tests pass another clock.
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
        """Wait until the next event is due and run it.

        It returns after about 50 ms of wall time at the latest, so that the caller can do other work. The caller
        repeats it until the clock has the wanted time.

        Args:
            until_ns: virtual time that it does not go beyond, in ns.
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
            target = min(target, self._due(self._elapsed_ns()))  # earlier if input ended the wait
        self._run_until(max(target, self._kernel.now))

    def _due(self, wall_ns: int) -> int:
        """Return the virtual time that corresponds to a wall time."""
        return self._virtual_start + int(wall_ns * self._factor)

    def _wall_of(self, virtual_ns: int) -> int:
        return int((virtual_ns - self._virtual_start) / self._factor)

"""The progress of a flight that a command looks at: the virtual time so far, on a terminal."""

from __future__ import annotations

from cfepy.cli.options import LONGEST_S
from cfepy.mission import PieceLength
from cfepy.pilot import Host, LiveRun
from cfepy.rtos import Stopwatch
from cfepy.units import NS_PER_S
from cfepy.writing.work_progress import WorkProgress


class FlyingProgress(Host):
    """Shows how far a flight has come, between its parts. The trace is the same as without it."""

    def __init__(self) -> None:
        self.progress = WorkProgress(Stopwatch().elapsed_ns)
        self._piece = PieceLength()

    def begin(self, run: LiveRun) -> None:
        super().begin(run)
        until_s = run.course.until_ns / NS_PER_S
        self._total = "" if until_s >= LONGEST_S else f" of {until_s:g}"

    def step(self, until_ns: int) -> None:
        kernel, watch = self._mission.kernel, Stopwatch()
        since_ns = kernel.now
        self._mission.run_until(min(until_ns, since_ns + self._piece.ns))
        self._piece.took(kernel.now - since_ns, watch.elapsed_ns())
        self.progress.show(f"flying: {kernel.now / NS_PER_S:.1f}{self._total} virtual s")

    def end(self) -> None:
        self.progress.clear()

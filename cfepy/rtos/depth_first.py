"""Systematic search through the schedules of a run: depth first, the depth growing by one deviation at a time.

Every schedule is a list of deviations from fifo, and its children deviate once more, after its last deviation; so none
comes twice. How many choices a decision has is only known from a run, so each run is what the next schedules are made
of. Bounding preemptions rather than steps is the idea of CHESS (Musuvathi, Qadeer: PLDI 2007).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence

from cfepy.rtos.schedule import Schedule


class DepthFirst:
    """All schedules of at most so many deviations, those with fewer first.

    Args:
        preemptions: how many times a task that could go on is taken off the CPU, or held up, in one run, at most.
        reorderings: how many times another than the first of the waiting tasks goes on, in one run, at most.
        options: a schedule whose options (`any`, `hold`) all have.
    """

    def __init__(self, preemptions: int = 2, reorderings: int = 2, options: Schedule | None = None) -> None:
        self._preemptions = preemptions
        self._reorderings = reorderings
        self._first: Schedule | None = (options or Schedule()).at({})
        self._open: deque[Iterator[Schedule]] = deque()
        self._away: dict[Schedule, None] = {}

    @property
    def exhausted(self) -> bool:
        """Whether all schedules have been given out, and the results of all of them are known."""
        return self._first is None and not self._open and not self._away

    def next(self) -> Schedule | None:
        """The next schedule to run; None when all have been given out, as far as results are known by now."""
        first, self._first = self._first, None
        found = first or self._next_child()
        if found is not None:
            self._away[found] = None
        return found

    def _next_child(self) -> Schedule | None:
        while self._open:
            child = next(self._open[0], None)
            if child is not None:
                return child
            self._open.popleft()
        return None

    def learn(self, schedule: Schedule, widths: Sequence[int], running: Sequence[bool]) -> None:
        """A schedule was run.

        Args:
            schedule: as `next` gave it.
            widths: of the decisions in the run, as `Recorded` keeps them.
            running: as `Recorded` keeps it.
        """
        del self._away[schedule]
        preemptions = sum(running[decision] for decision, _ in schedule.deviations)
        reorderings = len(schedule.deviations) - preemptions
        may_preempt = preemptions < self._preemptions
        may_reorder = reorderings < self._reorderings
        if may_preempt or may_reorder:
            self._open.append(_children(schedule, widths, running, may_preempt, may_reorder))


def _children(
    parent: Schedule, widths: Sequence[int], running: Sequence[bool], may_preempt: bool, may_reorder: bool
) -> Iterator[Schedule]:
    """The schedules that deviate once more, later."""
    made = dict(parent.deviations)
    start = parent.deviations[-1][0] + 1 if parent.deviations else 0
    for decision in range(start, len(widths)):
        if may_preempt if running[decision] else may_reorder:
            for choice in range(1, widths[decision]):
                yield parent.at({**made, decision: choice})

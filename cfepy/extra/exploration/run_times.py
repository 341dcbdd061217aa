"""Who had the processor when, for what comes too late: a `RunTimes` watches a run and is asked for a span of it."""

from __future__ import annotations

from collections import Counter
from typing import NamedTuple

from cfepy.monitors import Observer
from cfepy.rtos import Task

LEAST_SHARE = 0.1  # of a span: a task that ran for less of it more than usual is not named


class Turn(NamedTuple):
    """A task had the processor: its name, from when until when in virtual ns."""

    task: str
    from_ns: int
    to_ns: int


class RunTimes(Observer):
    """Notes the turns of a run in which time went by.

    Attributes:
        turns: in their order; the running one is not among them.
    """

    def __init__(self) -> None:
        super().__init__()
        self.turns: list[Turn] = []
        self._since_ns = 0

    def on_run(self, task: Task, at_ns: int) -> None:
        self._since_ns = at_ns

    def on_leave(self, task: Task, at_ns: int, waits: bool) -> None:
        if at_ns > self._since_ns:
            self.turns.append(Turn(task.name, self._since_ns, at_ns))

    def between(self, from_ns: int, to_ns: int) -> Counter[str]:
        """For how many ns each task ran in a span of virtual time, by name."""
        found: Counter[str] = Counter()
        for turn in self.turns:
            found[turn.task] += max(0, min(turn.to_ns, to_ns) - max(turn.from_ns, from_ns))
        return found


def longest_more(ran: Counter[str], usual: Counter[str], span_ns: int) -> str:
    """The task that ran for longest beyond what is usual; empty when none did for a good part of the span.

    Args:
        ran: by task, for how long it ran in the span.
        usual: the same in another run.
        span_ns: how long the span is.
    """
    more = {task: time_ns - usual[task] for task, time_ns in ran.items()}
    task = max(more, key=lambda each: more[each], default="")
    return task if task and more[task] >= LEAST_SHARE * span_ns else ""

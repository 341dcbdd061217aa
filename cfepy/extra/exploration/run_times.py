"""The CPU times of tasks, to explain a missed deadline: a `RunTimes` watches a run and answers for a span of it."""

from __future__ import annotations

from collections import Counter
from typing import NamedTuple

from cfepy.monitors import Observer
from cfepy.rtos import Task

LEAST_SHARE = 0.1  # of a span: a task with less extra run time is not named


class Turn(NamedTuple):
    """A turn of a task on the processor: its name, its start and its end in virtual ns."""

    task: str
    from_ns: int
    to_ns: int


class RunTimes(Observer):
    """Records the turns of a run that took time.

    Attributes:
        turns: in their order, without the current one.
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
        """Return for how many ns each task ran in a span of virtual time, by name."""
        found: Counter[str] = Counter()
        for turn in self.turns:
            found[turn.task] += max(0, min(turn.to_ns, to_ns) - max(turn.from_ns, from_ns))
        return found


def longest_more(ran: Counter[str], usual: Counter[str], span_ns: int) -> str:
    """Return the task with the longest extra run time; empty if that is a small part of the span.

    Args:
        ran: by task, its run time in the span.
        usual: the same in another run.
        span_ns: length of the span.
    """
    more = {task: time_ns - usual[task] for task, time_ns in ran.items()}
    task = max(more, key=lambda each: more[each], default="")
    return task if task and more[task] >= LEAST_SHARE * span_ns else ""

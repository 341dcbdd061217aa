"""Tasks that are ready for long while a task of higher or equal priority uses the CPU.

The kernel looks at most every 100 ms of virtual time, and only when virtual CPU time passes. A run in which computing
takes no time has no such tasks.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from cfepy.rtos.task import Task


@dataclass(slots=True)
class KeptBack:
    """A task that was ready without running.

    Attributes:
        task: the task.
        since_ns: begin of the longest time, in virtual ns.
        length_ns: its length as far as it was seen, in ns.
        by: the task that used the CPU at its end.
    """

    task: Task
    since_ns: int
    length_ns: int
    by: Task


class ReadyWatch:
    """Remembers for each task the longest time for which it was ready without running.

    Attributes:
        found: the tasks that were seen at two looks or more.
    """

    def __init__(self) -> None:
        self.found: dict[Task, KeptBack] = {}
        self._since: dict[int, int] = {}
        """By the number of an entry of the ready heap, which is new each time that a task becomes ready."""

    def look(self, now: int, running: Task, ready: Iterable[tuple[int, int, Task]]) -> None:
        """Look at the ready tasks.

        Args:
            now: virtual time in ns.
            running: the task that has the CPU.
            ready: the heap of the ready tasks.
        """
        since: dict[int, int] = {}
        for _, number, task in ready:
            if not task.ident or task.done:  # the host
                continue
            since[number] = began = self._since.get(number, now)
            length, known = now - began, self.found.get(task)
            if length and (known is None or known.since_ns == began or known.length_ns < length):
                self.found[task] = KeptBack(task, began, length, running)
        self._since = since

"""Tasks that start others, which some policies let go on first: those they start can only meet once all are there."""

from __future__ import annotations

from collections.abc import Sequence

from cfepy.rtos.task import Task


class StartersFirst:
    """Keeps those that a task has started from going on before it, until it waits, or polls."""

    def __init__(self) -> None:
        self._children: dict[Task, int] = {}  # how many a task had when its last time slice was over
        self._polling: dict[Task, None] = {}

    def polls(self, task: Task) -> bool:
        """Whether a task that used up its time slice has started nobody in it. It comes first no more then."""
        before = self._children.get(task, 0)
        self._children[task] = task.children
        if task.children > before:
            return False
        self._polling[task] = None
        return True

    def free(self, tasks: Sequence[Task]) -> Sequence[Task]:
        """Those whose starters do not come before them. A starter waits until a new thread has begun.

        Args:
            tasks: the candidates.
        """
        starters = tuple(f"{task.path}." for task in tasks if task not in self._polling)
        free = [task for task in tasks if not task.path.startswith(starters)]
        return [task for task in free if not task.started] or free

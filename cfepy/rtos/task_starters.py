"""Tasks that start other tasks. Some policies run them first, because the started tasks can only meet once all
exist.
"""

from __future__ import annotations

from collections.abc import Sequence

from cfepy.rtos.task import Task


class StartersFirst:
    """Keeps the tasks that a task has started from running before it, until it waits or polls."""

    def __init__(self) -> None:
        self._children: dict[Task, int] = {}  # number of children at the end of its last time slice
        self._polling: dict[Task, None] = {}

    def polls(self, task: Task) -> bool:
        """Return whether a task used up its time slice without starting another task; it then loses its precedence."""
        before = self._children.get(task, 0)
        self._children[task] = task.children
        if task.children > before:
            return False
        self._polling[task] = None
        return True

    def free(self, tasks: Sequence[Task]) -> Sequence[Task]:
        """Return the candidates that no starter precedes. A starter waits until a new thread has begun.

        Args:
            tasks: the candidates.
        """
        starters = tuple(f"{task.path}." for task in tasks if task not in self._polling)
        free = [task for task in tasks if not task.path.startswith(starters)]
        return [task for task in free if not task.started] or free

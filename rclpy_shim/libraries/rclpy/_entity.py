"""`Entity`: base of everything that an executor waits for."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

NEVER = 1 << 62
Call = tuple[Callable[..., Any], tuple[Any, ...]]
"""A function or coroutine function, and its arguments."""


class Entity:
    """Something that may have work for an executor.

    Attributes:
        callback_group: its group.
        callback: its function, which may be replaced at any time.
        due_ns: steady time in ns at which an executor must look again.
    """

    callback_group: Any = None
    callback: Any = None
    due_ns = NEVER
    _executor_event = False  # an executor has made a task for it that has not begun
    _of_node: Any = None

    def may_have_work(self) -> bool:
        """Return False if it cannot have work before the program's pipes change."""
        return True

    def ready(self) -> bool:
        """Return True if it has work."""
        return False

    def is_still_ready(self) -> bool:
        """Return False if the work has gone since `ready`, without having been taken."""
        return True

    def take_work(self, executor: Any) -> Call | None:
        """Take its work.

        Args:
            executor: the executor that runs the work.

        Returns:
            The call to make, or None if the work has gone.
        """
        return None


def nothing() -> None:
    """Stand for the callback of an entity without one."""

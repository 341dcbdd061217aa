"""`WaitList`: the tasks that wait for one object; plain data, changed by the kernel."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from cfepy.rtos.task import Task


class WaitList(list["Task"]):
    """The tasks that wait for one object, the most urgent first, first come first served within a priority.

    Args:
        what: name of the object for the deadlock report, such as "queue HK_PIPE".

    Attributes:
        holders: returns the tasks that must all let go of the object before a wait can end; empty if any task can end
            it.
        subject: the object itself, such as a Python lock; None if unknown.
        is_orphaned: whether the object was deleted while tasks waited, so that no task can end their waits.
        is_cancelable: whether a task that another task deletes can be ended while it waits here; not in a mutex of
            pthreads.
    """

    __slots__ = ("holders", "is_cancelable", "is_orphaned", "subject", "what")

    def __init__(self, what: str) -> None:
        super().__init__()
        self.what = what
        self.holders: Callable[[], Sequence[Task]] = tuple
        self.subject: object = None
        self.is_orphaned = False
        self.is_cancelable = True

    def orphan(self) -> None:
        """Note that the object was deleted, and leave its waiting tasks where they are."""
        if self and not self.is_orphaned:
            self.is_orphaned = True
            self.what += ", which was deleted"

    __hash__ = object.__hash__  # type: ignore[assignment]  # a place to wait has an identity

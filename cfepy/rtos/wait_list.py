"""`WaitList`: the tasks that wait for one thing; plain data, changed by the kernel."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from cfepy.rtos.task import Task


class WaitList(list["Task"]):
    """Tasks that wait for one thing, most urgent first, first come first within a priority.

    Args:
        what: the thing, for the deadlock report: "queue HK_PIPE".

    Attributes:
        holders: the tasks that all have to let go of it before a wait can end; none where any task may end it.
        subject: the object by which a wait is ended, such as a lock of Python's; None where that is not known.
    """

    __slots__ = ("holders", "subject", "what")

    def __init__(self, what: str) -> None:
        super().__init__()
        self.what = what
        self.holders: Callable[[], Sequence[Task]] = tuple
        self.subject: object = None

    __hash__ = object.__hash__  # type: ignore[assignment]  # a place to wait has an identity

"""The exceptions of the kernel itself."""

from __future__ import annotations

from typing import Any


class DeadlockError(RuntimeError):
    """Exception for a deadlock: no task is ready and no deadline is left. The text gives each task and the object it
    waits for.

    Args:
        text: the text.
        circle: the tasks that wait for each other, each as a `Wait`, if a call would have closed the cycle.
    """

    def __init__(self, text: str, circle: tuple[Any, ...] = ()) -> None:
        super().__init__(text)
        self.circle = circle


class InjectedCrash(BaseException):
    """Exception that a fault raises in a call of a task to crash it.

    It is not an `Exception`, because an application cannot catch a processor exception in C either.
    """

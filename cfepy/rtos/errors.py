"""The errors of the kernel itself."""

from __future__ import annotations

from typing import Any


class DeadlockError(RuntimeError):
    """No task can ever go on: none is ready and no deadline is left. The text says which task waits for what.

    Args:
        text: that.
        circle: the tasks that wait for each other, each a `Wait`, where the error comes out of a call that would have
            closed their circle.
    """

    def __init__(self, text: str, circle: tuple[Any, ...] = ()) -> None:
        super().__init__(text)
        self.circle = circle


class InjectedCrash(BaseException):
    """What comes out of a call of a task that a fault lets crash.

    It is no `Exception`, as a processor exception in C is none that an application could catch.
    """

"""What can go wrong in the kernel itself."""

from __future__ import annotations


class DeadlockError(RuntimeError):
    """No task can ever go on: nobody is ready and no deadline is left. The text says who waits for what."""


class InjectedCrash(BaseException):
    """What comes out of a call of a task that a fault lets crash.

    It is no `Exception`, as a processor exception in C is none that an application could catch.
    """

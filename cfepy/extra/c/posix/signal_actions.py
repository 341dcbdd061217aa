"""The signals of a process of Linux, and the actions that compiled code may choose: to ignore one, or the default.

No signal of the host reaches an application. SIGPIPE comes from a write to a pipe or a connection without a reader.
"""

from __future__ import annotations

import errno

from cfepy.extra.c.crashes import CFault
from cfepy.extra.c.posix.open_descriptors import failure

SIG_DFL, SIG_IGN = 0, 1
SIGKILL, SIGPIPE, SIGSTOP = 9, 13, 19
MOST_SIGNALS = 64
HANDLER = (
    "signals belong to the host's process, and cfepy calls no handler; "
    "a fault is reported by cFE, and OS_TimerCreate calls at times"
)


class SignalActions:
    """The actions of a processor's signals: SIG_DFL or SIG_IGN."""

    def __init__(self) -> None:
        self._actions: dict[int, int] = {}

    def action(self, number: int) -> int:
        """Return the action of a signal.

        Raises:
            OSError: EINVAL.
        """
        if not 1 <= number <= MOST_SIGNALS:
            raise failure(errno.EINVAL)
        return self._actions.get(number, SIG_DFL)

    def choose(self, function: str, number: int, action: int) -> int:
        """Change the action of a signal. Returns the one before.

        Raises:
            OSError: EINVAL.
            CFault: the action is a function.
        """
        before = self.action(number)
        if number in (SIGKILL, SIGSTOP):
            raise failure(errno.EINVAL)
        if action not in (SIG_DFL, SIG_IGN):
            raise CFault(f"{function}() with a handler is not available; {HANDLER}")
        self._actions[number] = action
        return before

    def broken_pipe(self, why: str, advice: str = "signal(SIGPIPE, SIG_IGN) avoids the signal") -> Exception:
        """Return EPIPE if SIGPIPE is ignored, otherwise the fault that ends the process."""
        if self.action(SIGPIPE) == SIG_IGN:
            return failure(errno.EPIPE)
        fault = CFault(f"SIGPIPE: {why}; {advice}")
        fault.ends_process = True
        return fault

"""Signals by which the stall watch gets through to a thread that executes no Python, or to a process that does not."""

from __future__ import annotations

import faulthandler
import signal
import sys
import threading


class Waker:
    """Lets Python's main thread look up from a function in C that waits, such as `time.sleep` or `input`.

    What is to be raised in a thread waits until that executes Python. A signal lets the main thread do so: its handler,
    in the middle of the wait. SIGURG is one that means nothing to a process that has no handler for it.

    Attributes:
        ident: of the main thread, while it can be woken; 0 else.
    """

    def __init__(self) -> None:
        self.ident = 0

    def begin(self) -> None:
        """From now on the calling thread can be woken, if it is the main one and the system has such signals."""
        if not hasattr(signal, "pthread_kill") or threading.current_thread() is not threading.main_thread():
            return
        if signal.getsignal(signal.SIGURG) in (signal.SIG_DFL, _look_up):
            signal.signal(signal.SIGURG, _look_up)
            self.ident = threading.get_ident()

    def wake(self) -> None:
        """Wake it, from another thread."""
        signal.pthread_kill(self.ident, signal.SIGURG)

    def end(self) -> None:
        """Leave it alone."""
        if self.ident == threading.get_ident() and signal.getsignal(signal.SIGURG) is _look_up:
            signal.signal(signal.SIGURG, signal.SIG_DFL)
        self.ident = 0


def _look_up(*_: object) -> None:
    """At the first step of this, Python raises what it was told to."""


class LastResort:
    """Ends the process when a C function keeps all threads of Python from running, so that none can look on.

    It counts CPU time, and is armed anew at each look: a process that is stopped, or waits, does not come to its end.
    Python's `faulthandler` writes the stack to standard error, and the process is killed by SIGVTALRM. Only for a
    process that has nothing else to do.
    """

    def __init__(self) -> None:
        self._is_there = hasattr(signal, "setitimer") and hasattr(faulthandler, "register")
        if self._is_there and not (sys.__stderr__ is None or sys.__stderr__.closed):
            faulthandler.register(signal.SIGVTALRM, file=sys.__stderr__, all_threads=False, chain=True)

    def arm(self, seconds: float) -> None:
        """End the process after so many seconds of CPU time; 0 for never."""
        if self._is_there:
            signal.setitimer(signal.ITIMER_VIRTUAL, seconds)

    def disarm(self) -> None:
        """Leave it alone."""
        self.arm(0)

"""Signals with which the stall watch reaches a thread or a process that executes no Python code."""

from __future__ import annotations

import faulthandler
import signal
import sys
import threading


class Waker:
    """Wakes Python's main thread from a C function that waits, such as `time.sleep` or `input`.

    An exception scheduled in a thread waits until the thread executes Python code. A signal makes the main thread do
    so: its handler runs in the middle of the wait. SIGURG does nothing in a process without a handler for it.

    Attributes:
        ident: identifier of the main thread while it can be woken, otherwise 0.
    """

    def __init__(self) -> None:
        self.ident = 0

    def begin(self) -> None:
        """Allow the calling thread to be woken, if it is the main thread and the system has such signals."""
        if not hasattr(signal, "pthread_kill") or threading.current_thread() is not threading.main_thread():
            return
        if signal.getsignal(signal.SIGURG) in (signal.SIG_DFL, _look_up):
            signal.signal(signal.SIGURG, _look_up)
            self.ident = threading.get_ident()

    def wake(self) -> None:
        """Wake the thread, from another thread."""
        signal.pthread_kill(self.ident, signal.SIGURG)

    def end(self) -> None:
        """Stop waking the thread."""
        if self.ident == threading.get_ident() and signal.getsignal(signal.SIGURG) is _look_up:
            signal.signal(signal.SIGURG, signal.SIG_DFL)
        self.ident = 0


def _look_up(*_: object) -> None:
    """Do nothing; Python raises the scheduled exception at the first step of this function."""


class LastResort:
    """Ends the process when a C function keeps all Python threads from running.

    It counts CPU time and is rearmed at each check, so a process that is stopped or waits is not ended. Python's
    `faulthandler` writes the stack to standard error, and SIGVTALRM kills the process. Use it only in a process that
    has no other work.
    """

    def __init__(self) -> None:
        self._is_there = hasattr(signal, "setitimer") and hasattr(faulthandler, "register")
        if self._is_there and not (sys.__stderr__ is None or sys.__stderr__.closed):
            faulthandler.register(signal.SIGVTALRM, file=sys.__stderr__, all_threads=False, chain=True)

    def arm(self, seconds: float) -> None:
        """End the process after this many seconds of CPU time; 0 for never."""
        if self._is_there:
            signal.setitimer(signal.ITIMER_VIRTUAL, seconds)

    def disarm(self) -> None:
        """Cancel the end of the process."""
        self.arm(0)

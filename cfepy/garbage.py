"""Times in which Python does not look for garbage: a finalizer must not run where nobody expects it.

Whether garbage is collected is a property of the whole interpreter, so what holds it up is counted here, over all
threads: a mission that ends in one thread must not bring the collector back into a mission of another.
"""

from __future__ import annotations

import gc
import threading

from cfepy.host_system import in_forked_process


class _NoCollection:
    """Use it as a context manager: garbage is not collected before the last thread has left it."""

    def __init__(self) -> None:
        self._lock = threading.RLock()  # a finalizer may come here while its thread is in the middle of it
        self._holders: dict[int, int] = {}
        self._resumes = False
        in_forked_process(self._in_child)

    def __enter__(self) -> None:
        with self._lock:
            if not self._holders:
                self._resumes = gc.isenabled()
                gc.disable()
            me = threading.get_ident()
            self._holders[me] = self._holders.get(me, 0) + 1

    def __exit__(self, *error: object) -> None:
        with self._lock:
            me = threading.get_ident()
            self._holders[me] -= 1
            if not self._holders[me]:
                del self._holders[me]
            self._resume_unless_held()

    def _resume_unless_held(self) -> None:
        if not self._holders and self._resumes:
            gc.enable()

    def _in_child(self) -> None:
        """The other threads have not come along into a forked process."""
        self._lock = threading.RLock()
        me = threading.get_ident()
        self._holders = {me: self._holders[me]} if me in self._holders else {}
        self._resume_unless_held()


no_collection = _NoCollection()

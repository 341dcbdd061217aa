"""When Python looks for garbage: not where nobody expects a finalizer to run, and at the end of a flight.

Whether garbage is collected is a property of the whole interpreter, so what holds it up is counted here, over all
threads: a mission that ends in one thread must not bring the collector back into a mission of another.
"""

from __future__ import annotations

import gc
import threading

from cfepy.interpreter.host_system import in_forked_process


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


CAN_FREEZE = hasattr(gc, "freeze")  # PyPy, which has generations of its own, cannot
MOST_OBJECTS = 20_000  # more objects are frozen: looking for garbage in them takes milliseconds
LOOKS = 64  # of so many looks for garbage at the end of a run one goes through everything,
OBJECTS = 100_000  # or of several times as many, when it has several times so many objects
_every = 1  # garbage is looked for at the end of each so-many-th run
_runs = 0


def freeze() -> None:
    """Leave out all objects that there are when garbage is looked for, where the interpreter can."""
    if CAN_FREEZE:
        gc.freeze()


def freeze_many() -> None:
    """Freeze all objects when there are so many that looking for garbage in them takes long.

    They stay frozen, for to count many objects at each run takes as long.
    """
    if CAN_FREEZE and len(gc.get_objects()) > MOST_OBJECTS:
        gc.freeze()


def collect_every(runs: int) -> None:
    """Have `collect_leftovers` look for garbage at the end of every `runs`-th run only.

    A suite of thousands of short missions spends a tenth of its time on it otherwise. As many missions may then be in
    memory at once.
    """
    global _every
    _every = runs


def collect_leftovers() -> None:
    """Look for garbage in all objects that are not frozen; every `LOOKS` times in all objects.

    A run leaves classes, whose circles reference counting cannot free; the simulation itself is still
    referenced, and is found the next time. What was there before the first run stays frozen: to go through it takes
    longer than all the rest.
    """
    global _runs
    _runs += 1
    if _runs % _every:
        return
    looks = gc.get_stats()[-1]["collections"] + 1 if CAN_FREEZE else 1
    if looks % LOOKS == 0 and looks // LOOKS % max(1, gc.get_freeze_count() // OBJECTS) == 0:
        gc.unfreeze()
    gc.collect()
    freeze_many()

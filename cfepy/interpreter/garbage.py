"""Control of garbage collection: off where a finalizer must not run, and a collection at the end of a flight.

Collection is switched for the whole interpreter, so this module counts its users over all threads. A mission that ends
in one thread must not switch the collector on again for a mission in another thread.
"""

from __future__ import annotations

import gc
import threading

from cfepy.interpreter.host_system import in_forked_process


class _NoCollection:
    """A context manager: the collector is off until the last thread has left it."""

    def __init__(self) -> None:
        self._lock = threading.RLock()  # a finalizer can enter this in a thread that is already inside
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
        """Drop the other threads, which do not exist in a forked process."""
        self._lock = threading.RLock()
        me = threading.get_ident()
        self._holders = {me: self._holders[me]} if me in self._holders else {}
        self._resume_unless_held()


no_collection = _NoCollection()


CAN_FREEZE = hasattr(gc, "freeze")  # PyPy cannot: it has its own generations
MOST_OBJECTS = 20_000  # freeze more objects than this: a collection over them takes milliseconds
MOST_GROWTH = 60_000  # so many more objects, frozen or not, can be garbage: a collection then goes through all of them
_every = 1  # `collect_leftovers` collects at the end of each so-many-th run
_runs = 0
_kept = 0  # number of objects that the last collection over all objects has left, or at first that were there


def freeze() -> None:
    """Exclude all present objects from garbage collection, if the interpreter can."""
    if CAN_FREEZE:
        gc.freeze()


def freeze_many() -> None:
    """Freeze all objects if there are so many that a collection takes long.

    They stay frozen, because counting many objects at each run takes just as long. Garbage that `collect_leftovers` has
    not looked for yet must not be frozen, because no collection would find it. The simulation that runs now is frozen
    too, and becomes garbage later; `collect_leftovers` notices it by the growth of the number of objects.
    """
    global _kept
    if _runs % _every or not CAN_FREEZE or len(gc.get_objects()) <= MOST_OBJECTS:
        return
    present = len(gc.get_objects()) + gc.get_freeze_count()
    _kept = _kept or present
    if present <= _kept + MOST_GROWTH:
        gc.freeze()


def collect_young() -> None:
    """Collect garbage among the objects that were made since the last collection."""
    gc.collect(0)


def collect_every(runs: int) -> None:
    """Let `collect_leftovers` collect garbage at the end of every `runs`-th run only.

    Otherwise a suite of thousands of short missions spends a tenth of its time on it. In return, this many missions may
    be in memory at once.
    """
    global _every
    _every = runs


def collect_leftovers() -> None:
    """Collect garbage among the objects that are not frozen, and among all objects once their number has grown.

    A run leaves classes in reference cycles. The simulation itself is still referenced, and the next collection finds
    it. The objects that existed before the first run stay frozen, because going through them takes longer than all the
    rest.
    """
    global _runs, _kept
    _runs += 1
    if _runs % _every:
        return
    gc.collect()
    if CAN_FREEZE and len(gc.get_objects()) > MOST_OBJECTS:
        if _kept and len(gc.get_objects()) + gc.get_freeze_count() > _kept + MOST_GROWTH:
            gc.unfreeze()
            gc.collect()
            _kept = len(gc.get_objects())
        freeze_many()

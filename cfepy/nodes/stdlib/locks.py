"""`_thread.lock` and `_thread.RLock` on the kernel.

A free lock is taken and given back without a kernel call. A contended one is handed to the most urgent waiter, first
come first within a priority, so that it cannot be snatched in between. Locks hash by serial number, because the
standard library keeps them in sets and iterates those.

The classes are made per universe: their methods then reach the kernel through a cell, which keeps a lock-and-release
near the price of a native one.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any, NamedTuple

from cfepy.interpreter.own_code import called_as, is_shown, is_standard
from cfepy.rtos import FOREVER, TIMEOUT, WaitList
from cfepy.schedules import ExploringKernel

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import FrameType

    from cfepy.nodes.universe import Universe
    from cfepy.rtos import Task

# number of calls of an uncontended lock that cost one charge, so that a loop that polls under a lock progresses
POLLS = 16
MAX_WAIT_S = 1e9
_TAKING = ("acquire", "acquire_lock", "__enter__")
_GIVING = ("release", "release_lock", "__exit__", "_release_save")
_ANY_TASK = False  # holder of a lock that is used as a signal


class LockTypes(NamedTuple):
    """Both lock classes of one universe."""

    lock: type
    rlock: type


def wait_ns(seconds: float) -> int:
    """Return a waiting time in ns, at least 1: a loop over the remaining time must not hang because of rounding."""
    return int(min(seconds, MAX_WAIT_S) * 1e9 + 0.5) or 1


def timeout_ns(blocking: bool, timeout: float) -> int:
    """Return the wait that the arguments of `acquire` request: FOREVER, 0 for none, or ns.

    Raises:
        ValueError: if Python's own locks refuse these arguments.
    """
    if timeout == -1:
        return FOREVER if blocking else 0
    if not blocking:
        raise ValueError("can't specify a timeout for a non-blocking call")
    if timeout < 0:
        raise ValueError("timeout value must be a non-negative number")
    return wait_ns(timeout) if timeout else 0


def make_lock_types(universe: Universe) -> LockTypes:
    """Return the lock classes of a universe."""
    types = LockTypes(_make_lock(universe), _make_rlock(universe))
    if isinstance(universe.kernel, ExploringKernel):
        for each in types:
            _explore(each, universe.kernel)
    return types


class LockPoints(NamedTuple):
    """Where other tasks may run when a lock is used.

    The standard library's own locks guard its internal state, and the order in which tasks acquire them does not affect
    the mission. The use of such a lock is therefore part of its caller's step, unless the caller has to wait.

    Attributes:
        taking: whether other tasks may run before the lock is acquired.
        giving: whether they may run before it is released.
        given: whether they may run after it is released, if the release, or something done while the lock was held,
            made a task ready.
    """

    taking: bool
    giving: bool
    given: bool


OWN = LockPoints(taking=True, giving=True, given=True)
"""A lock that the mission made, also within a condition."""
STEP = LockPoints(taking=True, giving=False, given=True)
"""A lock in an event, a semaphore, a queue or a future: each call of their methods is one step."""
INNER = LockPoints(taking=False, giving=False, given=True)
"""A lock that guards the standard library's own state."""
WAITER = LockPoints(taking=False, giving=False, given=False)
"""A lock that a condition makes for each waiting task; a woken task must wait for the condition's lock first."""
END = LockPoints(taking=True, giving=False, given=False)
"""A lock that a thread holds until it ends, and that others acquire to wait for its end."""


def _points_of(frame: FrameType | None) -> LockPoints:
    """Return where other tasks may run when a lock created here is used, depending on its creator.

    Args:
        frame: frame of the function that creates the lock.
    """
    outermost = ""
    while frame is not None and (is_standard(file := frame.f_code.co_filename) or not is_shown(file)):
        outermost = frame.f_code.co_qualname
        module = frame.f_globals.get("__name__", "")
        if outermost in _INNER_MAKERS or module.partition(".")[0] == "logging":
            return INNER
        frame = frame.f_back
    return OWN if outermost in _MAKERS_OF_OWN else STEP


_INNER_MAKERS = ("<module>", "Thread.__init__")
_MAKERS_OF_OWN = ("", "RLock", "Condition.__init__")


def _explore(lock: type, kernel: ExploringKernel) -> None:
    """Make calls that acquire or release a lock scheduling points (`LockPoints`), and record the holder of a plain one.

    The kernel's observer receives these calls, the creation of a lock, and the call by which a condition checks the
    lock's owner (`_is_owned`).
    """
    methods = vars(lock)
    plain = "holder" in methods

    def may_wait(self: Any, points: LockPoints) -> bool:
        """A thread acquires the lock that it holds until its end at once."""
        return points.taking and not (points is END and self.holder is kernel.current)

    def observed(name: str, has_point: bool = True) -> Callable[..., Any]:
        method = methods[name]
        takes = plain and name in _TAKING
        gives = name in _GIVING

        def call(self: Any, *args: Any, **options: Any) -> Any:
            points = self.points
            if has_point and (points.giving if gives else may_wait(self, points)):
                kernel.point()
            if takes and points is WAITER:
                kernel.forgive()
            observer = kernel.observer
            if observer is not None:
                observer.called(self, name, (*args, *options.values()))
            try:
                hushed = gives and not points.giving
                result = kernel.hush(method, self, *args, **options) if hushed else method(self, *args, **options)
            except BaseException:
                if observer is not None:
                    observer.failed(self, name)
                raise
            if takes and result and self.holder is not _ANY_TASK:
                self.holder = kernel.current
            if observer is not None:
                observer.returned(self, name, args, result)
            if gives and points.given:
                kernel.settle()
            elif points is END:
                kernel.forgive()
            return result

        return called_as(call, name)

    def made(self: Any) -> None:
        self.points = _points_of(sys._getframe(1))
        init(self)

    changed = {name: observed(name) for name in (*_TAKING, *_GIVING) if name in methods}
    changed |= {name: observed(name, has_point=False) for name in ("__init__", "_is_owned")}
    if "_acquire_restore" in methods:  # with which a condition acquires its lock again
        changed["_acquire_restore"] = observed("_acquire_restore", has_point=False)
    init = changed["__init__"]
    changed["__init__"] = called_as(made, "__init__")
    for name, call in changed.items():
        setattr(lock, name, call)


def as_waiter(lock: Any) -> Any:
    """Mark a plain lock as a signal: the task that acquired it does not block those that wait for it."""
    lock.holder = _ANY_TASK
    lock.points = WAITER
    return lock


def _wait_for(universe: Universe, waits: WaitList, wait: int, give_back: Any) -> bool:
    """Wait to be handed a lock; a task that is ended at that moment releases it again."""
    kernel = universe.kernel
    task = kernel.current
    if task is kernel.host:
        raise RuntimeError("the lock of a node is held; only tasks of the node can wait for it")
    task.wake = None
    try:
        return kernel.wait_on(waits, wait) is not TIMEOUT
    except BaseException:  # the end of the task, or an exception raised by a signal handler
        if task.wake is waits:
            give_back()
        raise


def _make_lock(universe: Universe) -> type:
    kernel = universe.kernel
    name = universe.name

    class lock:
        """A lock that any task may release."""

        __slots__ = ("__weakref__", "_locked", "_polls", "_serial", "_waits", "holder", "points")

        def __init__(self) -> None:
            self._locked = False
            self._polls = POLLS
            self._waits: WaitList | None = None
            self.holder: Any = None  # the task, or `_ANY_TASK`; only recorded while schedules are explored
            universe.serial = self._serial = universe.serial + 1

        def acquire(self, blocking: bool = True, timeout: float = -1) -> bool:
            if not self._locked and timeout == -1:
                self._locked = True
                if self._polls:
                    self._polls -= 1
                else:
                    self._polls = POLLS
                    universe.charge()
                return True
            wait = timeout_ns(blocking, timeout)
            if not self._locked:
                self._locked = True
                return True
            if not wait:
                universe.charge()
                return False
            if self._waits is None:
                self._waits = WaitList(f"lock {self._serial} of {name}")
                self._waits.subject = self
                self._waits.holders = lambda: (self.holder,) if self.holder else ()
            return _wait_for(universe, self._waits, wait, self.release)

        def release(self) -> None:
            if not self._locked:
                raise RuntimeError("release unlocked lock")
            waits = self._waits
            if waits:
                kernel.wake_first(waits, waits)
            else:
                self._locked = False

        def locked(self) -> bool:
            return self._locked

        _is_owned = locked  # needed by Condition for a plain lock, without a failed attempt to acquire it

        def __hash__(self) -> int:
            return self._serial

        def __eq__(self, other: object) -> bool:
            return self is other

        def __enter__(self) -> bool:
            if self._locked or not self._polls:
                return self.acquire()
            self._locked = True
            self._polls -= 1
            return True

        def __exit__(self, *error: object) -> None:
            if self._waits or not self._locked:
                self.release()
            else:
                self._locked = False

        def __repr__(self) -> str:
            return f"<{'locked' if self._locked else 'unlocked'} _thread.lock object number {self._serial}>"

        def _at_fork_reinit(self) -> None:
            self._locked = False

        acquire_lock, release_lock, locked_lock = acquire, release, locked

    lock.__module__ = "_thread"
    return lock


def _make_rlock(universe: Universe) -> type:
    kernel = universe.kernel
    name = universe.name

    class RLock:
        """A lock that its owner may acquire again."""

        __slots__ = ("__weakref__", "_count", "_owner", "_polls", "_serial", "_waits", "points")

        def __init__(self) -> None:
            self._owner: Task | None = None
            self._count = 0
            self._polls = POLLS
            self._waits: WaitList | None = None
            universe.serial = self._serial = universe.serial + 1

        def acquire(self, blocking: bool = True, timeout: float = -1) -> bool:
            current = kernel.current
            owner = self._owner
            if owner is None or owner is current:
                if timeout != -1:
                    timeout_ns(blocking, timeout)
                self._owner = current
                self._count += 1
                if self._polls:
                    self._polls -= 1
                else:
                    self._polls = POLLS
                    universe.charge()
                return True
            wait = timeout_ns(blocking, timeout)
            if not wait:
                universe.charge()
                return False
            return self._take_over(wait, 1)

        def _take_over(self, wait: int, count: int) -> bool:
            if self._waits is None:
                self._waits = WaitList(f"lock {self._serial} of {name}")
                self._waits.subject = self
                self._waits.holders = lambda: () if self._owner is None else (self._owner,)
            if not _wait_for(universe, self._waits, wait, self._hand_on):
                return False
            self._owner, self._count = kernel.current, count
            return True

        def _hand_on(self) -> None:
            """Set `_owner` at once: no other task may acquire the lock before its next owner runs."""
            waits = self._waits
            if waits:
                self._owner = waits[0]
                kernel.wake_first(waits, waits)
            else:
                self._owner = None

        def release(self) -> None:
            if self._owner is not kernel.current:
                raise RuntimeError("cannot release un-acquired lock")
            self._count = count = self._count - 1
            if not count:
                if self._waits:
                    self._hand_on()
                else:
                    self._owner = None

        def __hash__(self) -> int:
            return self._serial

        def __eq__(self, other: object) -> bool:
            return self is other

        def __exit__(self, *error: object) -> None:
            self.release()

        def __repr__(self) -> str:
            owner = self._owner.ident if self._owner is not None else 0
            return f"<_thread.RLock object number {self._serial} owner={owner} count={self._count}>"

        def _is_owned(self) -> bool:
            return self._owner is kernel.current

        def _recursion_count(self) -> int:
            return self._count if self._owner is kernel.current else 0

        def _release_save(self) -> int:
            count, self._count = self._count, 0
            self._hand_on()
            return count

        def _acquire_restore(self, count: int) -> None:
            if self._owner is None:
                self._owner, self._count = kernel.current, count
            else:
                self._take_over(FOREVER, count)

        def _at_fork_reinit(self) -> None:
            self._owner, self._count = None, 0

        __enter__ = acquire

    RLock.__module__ = "_thread"
    return RLock

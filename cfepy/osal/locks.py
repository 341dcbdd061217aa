"""OSAL's locks: mutexes (OS_MutSem*), condition variables (OS_CondVar*), readers-writer locks (OS_RwLock*).

A mutex is recursive, has priority inheritance, and only its owner can give it. A condition variable has a mutex of its
own. A readers-writer lock has many readers or one writer, and a waiting writer holds new readers back.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from cfepy.ids import OS_CONDVAR_BASE, OS_MUTEX_BASE, OS_RWLOCK_BASE
from cfepy.osal.clock import OS_TIME_TICK_RESOLUTION_NS, ClockApi, OsTime
from cfepy.osal.core import DELETED, Core, OsObject, OsObjectTable, Setup
from cfepy.rtos import FOREVER, TIMEOUT, Kernel, Mutex, Task, WaitList
from cfepy.status import OS_ERROR, OS_SEM_FAILURE, OsalError


class MutexInfo(NamedTuple):
    """The result of `mut_sem_get_info` (OS_mut_sem_prop_t)."""

    name: str
    creator: int


class OsMutex(OsObject):
    """The record of a mutex."""

    __slots__ = ("mutex",)

    def __init__(self, name: str, mutex: Mutex) -> None:
        super().__init__(name)
        self.mutex = mutex


class MutexApi(Core):
    """The OS_MutSem* functions."""

    def __init__(self, setup: Setup) -> None:
        super().__init__(setup)
        self._mutexes: OsObjectTable[OsMutex] = self._table("mutex", OS_MUTEX_BASE, setup.config.os_max_mutexes)

    def mut_sem_create(self, name: str, options: int = 0) -> int:
        """Make a mutex (OS_MutSemCreate).

        Args:
            name: unique among mutexes, at most 19 characters.
            options: no effect, as in NASA's OSAL.

        Returns:
            The mutex's id.

        Raises:
            OsalError: OS_ERR_NAME_TOO_LONG, OS_ERR_NAME_TAKEN or OS_ERR_NO_FREE_IDS.
        """
        if self._cost:
            self.kernel.charge(self._cost)
        record = OsMutex(name, Mutex(self.kernel, name, stays_locked=not self.config.safe))
        return self._register(self._mutexes, record, "mutex", self._setup.sizes.mutex)

    def mut_sem_take(self, mutex_id: int) -> None:
        """Wait until the mutex is free or belongs to the caller; the owner inherits the caller's priority
        (OS_MutSemTake).

        Raises:
            OsalError: OS_ERR_INVALID_ID.
            DeadlockError: in a safe mission, if the owner waits, directly or not, for a mutex that the caller holds.
                Otherwise the caller waits forever.
        """
        if self._cost:
            self.kernel.charge(self._cost)
        record = self._mutexes.lookup(mutex_id)
        if record is None:
            raise self._mutexes.missing(mutex_id)
        record.mutex.take()

    def mut_sem_give(self, mutex_id: int) -> None:
        """Undo one take (OS_MutSemGive).

        Raises:
            OsalError: OS_SEM_FAILURE if the caller does not own it; OS_ERR_INVALID_ID.
        """
        if self._cost:
            self.kernel.charge(self._cost)
        record = self._mutexes.lookup(mutex_id)
        if record is None:
            raise self._mutexes.missing(mutex_id)
        if not record.mutex.give():
            owner = record.mutex.owner
            raise OsalError(
                OS_SEM_FAILURE,
                f"{self.kernel.current.name} cannot give mutex {record.name}, which "
                + (f"{owner.name} owns" if owner is not None else "is not taken"),
            )

    def mut_sem_delete(self, mutex_id: int) -> None:
        """Delete a mutex (OS_MutSemDelete).

        Raises:
            OsalError: OS_SEM_FAILURE while a task owns it; OS_ERR_INVALID_ID.
        """
        record = self._mutex(mutex_id)
        if record.mutex.owner is not None:
            raise OsalError(OS_SEM_FAILURE, f"{record.mutex.owner.name} owns mutex {record.name}")
        self._unregister(self._mutexes, record)

    def mut_sem_get_id_by_name(self, name: str) -> int:
        """Return the id of a named mutex, or OS_ERR_NAME_NOT_FOUND (OS_MutSemGetIdByName)."""
        return self._mutexes.named(name)

    def mut_sem_get_info(self, mutex_id: int) -> MutexInfo:
        """Return facts about a mutex, or OS_ERR_INVALID_ID (OS_MutSemGetInfo)."""
        record = self._mutex(mutex_id)
        return MutexInfo(record.name, record.creator)

    def _mutex(self, mutex_id: int) -> OsMutex:
        record = self._mutexes.lookup(mutex_id)
        if record is None:
            raise self._mutexes.missing(mutex_id)
        return record


class CondVarInfo(NamedTuple):
    """The result of `cond_var_get_info` (OS_condvar_prop_t)."""

    name: str
    creator: int


class OsCondVar(OsObject):
    """The record of a condition variable."""

    __slots__ = ("mutex", "waits")

    def __init__(self, name: str, kernel: Kernel, safe: bool) -> None:
        super().__init__(name)
        self.mutex = Mutex(kernel, f"of condition {name}", stays_locked=not safe)
        self.waits = WaitList(f"condition {name}")
        self.waits.subject = self


class CondVarApi(ClockApi):
    """The OS_CondVar* functions."""

    def __init__(self, setup: Setup) -> None:
        super().__init__(setup)
        self._cond_vars: OsObjectTable[OsCondVar] = self._table(
            "condition variable", OS_CONDVAR_BASE, setup.config.os_max_condvars
        )

    def cond_var_create(self, name: str, options: int = 0) -> int:
        """Make a condition variable (OS_CondVarCreate).

        Args:
            name: unique among condition variables, at most 19 characters.
            options: no effect, as in NASA's OSAL.

        Returns:
            Its id.

        Raises:
            OsalError: OS_ERR_NAME_TOO_LONG, OS_ERR_NAME_TAKEN or OS_ERR_NO_FREE_IDS.
        """
        if self._cost:
            self.kernel.charge(self._cost)
        sizes = self._setup.sizes
        return self._register(
            self._cond_vars,
            OsCondVar(name, self.kernel, self.config.safe),
            "condition variable",
            sizes.mutex + sizes.semaphore,
        )

    def cond_var_lock(self, var_id: int) -> None:
        """Take its mutex (OS_CondVarLock).

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        self._cond_var(var_id).mutex.take()

    def cond_var_unlock(self, var_id: int) -> None:
        """Give its mutex (OS_CondVarUnlock).

        Raises:
            OsalError: OS_ERROR if the caller does not own it; OS_ERR_INVALID_ID.
        """
        record = self._cond_var(var_id)
        if not record.mutex.give():
            raise OsalError(OS_ERROR, f"condition variable {record.name} is not locked by the caller")

    def cond_var_signal(self, var_id: int) -> None:
        """Wake the most urgent waiting task, if any (OS_CondVarSignal).

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        self.kernel.wake_first(self._cond_var(var_id).waits, True)

    def cond_var_broadcast(self, var_id: int) -> None:
        """Wake all waiting tasks (OS_CondVarBroadcast).

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        self.kernel.wake_all(self._cond_var(var_id).waits, True)

    def cond_var_wait(self, var_id: int) -> None:
        """Unlock, wait for a signal, and lock again (OS_CondVarWait).

        Raises:
            OsalError: OS_ERROR if the caller has not locked it; OS_ERR_INVALID_ID.
        """
        self._wait(self._cond_var(var_id), FOREVER)

    def cond_var_timed_wait(self, var_id: int, until: OsTime) -> bool:
        """Wait like `cond_var_wait`, until a local time at the latest (OS_CondVarTimedWait).

        Args:
            var_id: the condition variable.
            until: absolute local time as `get_local_time` returns it, in ticks of 100 ns.

        Returns:
            False if the time passed without a signal.

        Raises:
            OsalError: OS_ERROR if the caller has not locked it; OS_ERR_INVALID_ID.
        """
        left = (until - self.get_local_time()) * OS_TIME_TICK_RESOLUTION_NS
        return self._wait(self._cond_var(var_id), max(left, 1)) is not TIMEOUT

    def cond_var_delete(self, var_id: int) -> None:
        """Delete a condition variable (OS_CondVarDelete).

        The call waits until no task waits for a signal, as pthread_cond_destroy does; none can be given any more. In a
        safe mission it ends these waits with OS_ERR_INVALID_ID.

        Raises:
            OsalError: OS_ERROR while a task has locked it; OS_ERR_INVALID_ID.
        """
        record = self._cond_var(var_id)
        if record.mutex.owner is not None:
            raise OsalError(OS_ERROR, f"{record.mutex.owner.name} has locked condition variable {record.name}")
        if record.waits and self._is_strict:
            self._await_leaving(self._cond_vars, record, record.waits)
        self._unregister(self._cond_vars, record)
        self.kernel.wake_all(record.waits, DELETED)

    def cond_var_get_id_by_name(self, name: str) -> int:
        """Return the id of a named condition variable, or OS_ERR_NAME_NOT_FOUND (OS_CondVarGetIdByName)."""
        return self._id_by_name(self._cond_vars, name)

    def cond_var_get_info(self, var_id: int) -> CondVarInfo:
        """Return facts about a condition variable, or OS_ERR_INVALID_ID (OS_CondVarGetInfo)."""
        record = self._cond_var(var_id)
        return CondVarInfo(record.name, record.creator)

    def _cond_var(self, var_id: int) -> OsCondVar:
        if self._cost:
            self.kernel.charge(self._cost)
        record = self._cond_vars.lookup(var_id)
        if record is None:
            raise self._cond_vars.missing(var_id)
        return record

    def _wait(self, record: OsCondVar, timeout_ns: int) -> Any:
        mutex, task = record.mutex, self.kernel.current
        if mutex.owner is not task:
            raise OsalError(OS_ERROR, f"condition variable {record.name} is not locked by the caller")
        count = mutex.count
        # No task may run between the unlock and the wait, or a signal could get lost. So `give`, which preempts, is not
        # used.
        mutex.abandon(task)
        try:
            woken = self.kernel.wait_on(record.waits, timeout_ns)
        except BaseException:
            self._has_left(record, record.waits)
            raise
        self._has_left(record, record.waits)
        if woken is DELETED:
            raise self._cond_vars.gone(record)
        mutex.take()
        mutex.count = count
        return woken


class RwLockInfo(NamedTuple):
    """The result of `rw_lock_get_info` (OS_rwlock_prop_t)."""

    name: str
    creator: int


class OsRwLock(OsObject):
    """The record of a readers-writer lock."""

    __slots__ = ("readers", "waiting_readers", "waiting_writers", "writer")

    def __init__(self, name: str, safe: bool) -> None:
        super().__init__(name)
        self.readers: list[Task] = []
        self.writer: Task | None = None
        self.waiting_readers = WaitList(f"readers of lock {name}")
        self.waiting_writers = WaitList(f"writers of lock {name}")
        self.waiting_readers.is_cancelable = self.waiting_writers.is_cancelable = safe
        self.waiting_readers.holders = lambda: self._writers() or self.waiting_writers[:1]
        self.waiting_writers.holders = lambda: self._writers() or self.readers

    def _writers(self) -> list[Task]:
        return [] if self.writer is None else [self.writer]


class RwLockApi(Core):
    """The OS_RwLock* functions."""

    def __init__(self, setup: Setup) -> None:
        super().__init__(setup)
        self._rw_locks: OsObjectTable[OsRwLock] = self._table(
            "readers-writer lock", OS_RWLOCK_BASE, setup.config.os_max_rwlocks
        )

    def rw_lock_create(self, name: str, options: int = 0) -> int:
        """Make a readers-writer lock (OS_RwLockCreate).

        Args:
            name: unique among these locks, at most 19 characters.
            options: no effect, as in NASA's OSAL.

        Returns:
            The lock's id.

        Raises:
            OsalError: OS_ERR_NAME_TOO_LONG, OS_ERR_NAME_TAKEN or OS_ERR_NO_FREE_IDS.
        """
        return self._register(
            self._rw_locks, OsRwLock(name, self.config.safe), "readers-writer lock", self._setup.sizes.mutex
        )

    def rw_lock_read_take(self, rw_id: int) -> None:
        """Wait until no task writes or waits to write (OS_RwLockReadTake).

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        record = self._rw_lock(rw_id)
        if record.writer is None and not record.waiting_writers:
            record.readers.append(self.kernel.current)
        else:
            self.kernel.wait_on(record.waiting_readers)

    def rw_lock_read_give(self, rw_id: int) -> None:
        """Release the lock for reading (OS_RwLockReadGive).

        Raises:
            OsalError: OS_ERROR if no task reads; OS_ERR_INVALID_ID.
        """
        record = self._rw_lock(rw_id)
        if not record.readers:
            raise OsalError(OS_ERROR, f"lock {record.name} is not held for reading")
        task = self.kernel.current
        record.readers.remove(task if task in record.readers else record.readers[0])
        if not record.readers:
            self._hand_on(record)

    def rw_lock_write_take(self, rw_id: int) -> None:
        """Wait until no task reads or writes (OS_RwLockWriteTake).

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        record = self._rw_lock(rw_id)
        if record.writer is None and not record.readers:
            record.writer = self.kernel.current
        else:
            self.kernel.wait_on(record.waiting_writers)

    def rw_lock_write_give(self, rw_id: int) -> None:
        """Release the lock for writing (OS_RwLockWriteGive).

        Raises:
            OsalError: OS_ERROR if the caller does not write; OS_ERR_INVALID_ID.
        """
        record = self._rw_lock(rw_id)
        if record.writer is not self.kernel.current:
            raise OsalError(OS_ERROR, f"the caller does not hold lock {record.name} for writing")
        record.writer = None
        self._hand_on(record)

    def rw_lock_delete(self, rw_id: int) -> None:
        """Delete a lock (OS_RwLockDelete); tasks that wait for it wait forever, as on Linux.

        Raises:
            OsalError: OS_ERR_INVALID_ID. In a safe mission OS_ERROR while a task holds it.
        """
        record = self._rw_lock(rw_id)
        if self.config.safe and (record.readers or record.writer is not None):
            raise OsalError(OS_ERROR, f"lock {record.name} is held")
        self._unregister(self._rw_locks, record)
        record.waiting_readers.orphan()
        record.waiting_writers.orphan()

    def rw_lock_get_id_by_name(self, name: str) -> int:
        """Return the id of a named lock, or OS_ERR_NAME_NOT_FOUND (OS_RwLockGetIdByName)."""
        return self._rw_locks.named(name)

    def rw_lock_get_info(self, rw_id: int) -> RwLockInfo:
        """Return facts about a lock, or OS_ERR_INVALID_ID (OS_RwLockGetInfo)."""
        record = self._rw_lock(rw_id)
        return RwLockInfo(record.name, record.creator)

    def _rw_lock(self, rw_id: int) -> OsRwLock:
        if self._cost:
            self.kernel.charge(self._cost)
        record = self._rw_locks.lookup(rw_id)
        if record is None:
            raise self._rw_locks.missing(rw_id)
        return record

    def _hand_on(self, record: OsRwLock) -> None:
        """Give a free lock to the most urgent waiting writer, or otherwise to all waiting readers."""
        if record.waiting_writers:
            record.writer = writer = record.waiting_writers[0]
            self.kernel.call_joiners(writer)
            self.kernel.wake_first(record.waiting_writers)
        elif record.waiting_readers:
            record.readers = list(record.waiting_readers)
            for reader in record.readers:
                self.kernel.call_joiners(reader)
            self.kernel.wake_all(record.waiting_readers)

"""OSAL condition variables (OS_CondVar*), each with a mutex of its own.

May import cfepy.rtos, ids, status and its neighbours in cfepy.osal.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from cfepy.ids import OS_CONDVAR_BASE
from cfepy.osal.clock import OS_TIME_TICK_RESOLUTION_NS, ClockApi, OsTime
from cfepy.osal.core import DELETED, ObjectTable, OsObject, Setup
from cfepy.osal.limits import OS_MAX_CONDVARS
from cfepy.rtos import FOREVER, TIMEOUT, Kernel, Mutex, WaitList
from cfepy.status import OS_ERROR, OsalError


class CondVarInfo(NamedTuple):
    """What `cond_var_get_info` tells (OS_condvar_prop_t)."""

    name: str
    creator: int


class OsCondVar(OsObject):
    """The record of a condition variable."""

    __slots__ = ("mutex", "waits")

    def __init__(self, name: str, kernel: Kernel) -> None:
        super().__init__(name)
        self.mutex = Mutex(kernel, f"of condition {name}")
        self.waits = WaitList(f"condition {name}")


class CondVarApi(ClockApi):
    """The OS_CondVar* functions."""

    def __init__(self, setup: Setup) -> None:
        super().__init__(setup)
        self._cond_vars: ObjectTable[OsCondVar] = self._table("condition variable", OS_CONDVAR_BASE, OS_MAX_CONDVARS)

    def cond_var_create(self, name: str, options: int = 0) -> int:
        """Make a condition variable (OS_CondVarCreate).

        Args:
            name: unique among condition variables, at most 19 characters.
            options: without effect, as in NASA's.

        Returns:
            Its id.

        Raises:
            OsalError: OS_ERR_NAME_TOO_LONG, OS_ERR_NAME_TAKEN or OS_ERR_NO_FREE_IDS.
        """
        if self._cost:
            self.kernel.charge(self._cost)
        sizes = self._setup.sizes
        return self._register(
            self._cond_vars, OsCondVar(name, self.kernel), "condition variable", sizes.mutex + sizes.semaphore
        )

    def cond_var_lock(self, var_id: int) -> None:
        """Take its mutex (OS_CondVarLock).

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        self._cond_var(var_id).mutex.take()

    def cond_var_unlock(self, var_id: int) -> None:
        """Give its mutex back (OS_CondVarUnlock).

        Raises:
            OsalError: OS_ERROR when the caller does not own it; OS_ERR_INVALID_ID.
        """
        record = self._cond_var(var_id)
        if not record.mutex.give():
            raise OsalError(OS_ERROR, f"condition variable {record.name} is not locked by the caller")

    def cond_var_signal(self, var_id: int) -> None:
        """Wake the most urgent task that waits, if any (OS_CondVarSignal).

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        self.kernel.wake_first(self._cond_var(var_id).waits, True)

    def cond_var_broadcast(self, var_id: int) -> None:
        """Wake all tasks that wait (OS_CondVarBroadcast).

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        self.kernel.wake_all(self._cond_var(var_id).waits, True)

    def cond_var_wait(self, var_id: int) -> None:
        """Unlock, wait for a signal, and lock again (OS_CondVarWait).

        Raises:
            OsalError: OS_ERROR when the caller has not locked it; OS_ERR_INVALID_ID.
        """
        self._wait(self._cond_var(var_id), FOREVER)

    def cond_var_timed_wait(self, var_id: int, until: OsTime) -> bool:
        """As `cond_var_wait` until a local time; False when that came first (OS_CondVarTimedWait).

        Args:
            var_id: the condition variable.
            until: absolute local time as `get_local_time` gives it, in ticks of 100 ns.

        Raises:
            OsalError: OS_ERROR when the caller has not locked it; OS_ERR_INVALID_ID.
        """
        left = (until - self.get_local_time()) * OS_TIME_TICK_RESOLUTION_NS
        return self._wait(self._cond_var(var_id), max(left, 1)) is not TIMEOUT

    def cond_var_delete(self, var_id: int) -> None:
        """Delete a condition variable; tasks that wait get OS_ERR_INVALID_ID (OS_CondVarDelete).

        Raises:
            OsalError: OS_ERROR while a task has locked it; OS_ERR_INVALID_ID.
        """
        record = self._cond_var(var_id)
        if record.mutex.owner is not None:
            raise OsalError(OS_ERROR, f"{record.mutex.owner.name} has locked condition variable {record.name}")
        self._unregister(self._cond_vars, record)
        self.kernel.wake_all(record.waits, DELETED)

    def cond_var_get_id_by_name(self, name: str) -> int:
        """Id of a named condition variable, or OS_ERR_NAME_NOT_FOUND (OS_CondVarGetIdByName)."""
        return self._cond_vars.named(name)

    def cond_var_get_info(self, var_id: int) -> CondVarInfo:
        """Facts about a condition variable, or OS_ERR_INVALID_ID (OS_CondVarGetInfo)."""
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
        # Nobody may run between the unlock and the wait, else a signal could get lost: so no `give`, which preempts.
        mutex.abandon(task)
        woken = self.kernel.wait_on(record.waits, timeout_ns)
        if woken is DELETED:
            raise self._cond_vars.gone(record)
        mutex.take()
        mutex.count = count
        return woken

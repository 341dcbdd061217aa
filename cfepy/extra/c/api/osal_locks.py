"""OS_CondVar*, OS_RwLock*: condition variables and readers-writer locks for C."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.extra.c.api.osal_values import BAD, NAMED, properties
from cfepy.osal import OsTime
from cfepy.status import OS_ERROR_TIMEOUT, OsalError

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime


def declare(api: Declarations, c: CRuntime) -> None:
    _declare_condition_variables(api, c)
    _declare_rw_locks(api, c)


def _declare_condition_variables(api: Declarations, c: CRuntime) -> None:
    os, memory = c.handle.os, c.memory

    def timed_wait(var_id: int, until: int) -> None:
        if not os.cond_var_timed_wait(var_id, OsTime(memory.i64(until))):
            raise OsalError(OS_ERROR_TIMEOUT)

    api.add("OS_CondVarCreate", "4SI", os.cond_var_create, BAD)
    api.add("OS_CondVarLock", "$I", os.cond_var_lock)
    api.add("OS_CondVarUnlock", "$I", os.cond_var_unlock)
    api.add("OS_CondVarSignal", "$I", os.cond_var_signal)
    api.add("OS_CondVarBroadcast", "$I", os.cond_var_broadcast)
    api.add("OS_CondVarWait", "$I", os.cond_var_wait)
    api.add("OS_CondVarTimedWait", "$IP", timed_wait, BAD)
    api.add("OS_CondVarDelete", "I", os.cond_var_delete)
    api.add("OS_CondVarGetIdByName", "$4S", os.cond_var_get_id_by_name, BAD)
    api.add("OS_CondVarGetInfo", "$IP", properties(memory, NAMED, os.cond_var_get_info), BAD)


def _declare_rw_locks(api: Declarations, c: CRuntime) -> None:
    os = c.handle.os
    api.add("OS_RwLockCreate", "4SI", os.rw_lock_create, BAD)
    api.add("OS_RwLockReadGive", "$I", os.rw_lock_read_give)
    api.add("OS_RwLockWriteGive", "$I", os.rw_lock_write_give)
    api.add("OS_RwLockReadTake", "$I", os.rw_lock_read_take)
    api.add("OS_RwLockWriteTake", "$I", os.rw_lock_write_take)
    api.add("OS_RwLockDelete", "I", os.rw_lock_delete)
    api.add("OS_RwLockGetIdByName", "$4S", os.rw_lock_get_id_by_name, BAD)
    api.add("OS_RwLockGetInfo", "$IP", properties(c.memory, NAMED, os.rw_lock_get_info), BAD)

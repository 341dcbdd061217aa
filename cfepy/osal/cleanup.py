"""Giving back what an application made: the part of OSAL that ES calls when an application ends.

NASA does this task by task in CFE_ES_CleanupTaskResources. May import cfepy.rtos, ids, status and its neighbours in
cfepy.osal.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from cfepy.ids import (
    OS_BINSEM_BASE,
    OS_CONDVAR_BASE,
    OS_COUNTSEM_BASE,
    OS_DIR_BASE,
    OS_MODULE_BASE,
    OS_MUTEX_BASE,
    OS_QUEUE_BASE,
    OS_RWLOCK_BASE,
    OS_STREAM_BASE,
    OS_TASK_BASE,
    OS_TIMEBASE_BASE,
    OS_TIMECB_BASE,
)
from cfepy.osal.condvars import CondVarApi
from cfepy.osal.core import OsObject, Setup
from cfepy.osal.directories import DirectoryApi
from cfepy.osal.modules import ModuleApi
from cfepy.osal.mutexes import MutexApi
from cfepy.osal.paths import PathApi
from cfepy.osal.queues import QueueApi
from cfepy.osal.rwlocks import RwLockApi
from cfepy.osal.select import SelectApi
from cfepy.osal.semaphores import SemaphoreApi
from cfepy.osal.tasks import OsTask, TaskApi
from cfepy.osal.timers import TimerApi
from cfepy.status import OsalError


class Leftover(NamedTuple):
    """An object that could not be deleted, and why."""

    object_id: int
    error: OsalError


class CleanupApi(
    TaskApi,
    QueueApi,
    SemaphoreApi,
    MutexApi,
    CondVarApi,
    RwLockApi,
    TimerApi,
    SelectApi,
    PathApi,
    DirectoryApi,
    ModuleApi,
):
    """Deletion of everything that belongs to somebody."""

    def __init__(self, setup: Setup) -> None:
        super().__init__(setup)
        # NASA's order; what comes after the timers is left behind by NASA's CFE_ES_CleanupObjectCallback.
        self._deleters: dict[int, Callable[[int], None]] = {
            OS_TASK_BASE: self.task_delete,
            OS_QUEUE_BASE: self.queue_delete,
            OS_COUNTSEM_BASE: self.count_sem_delete,
            OS_BINSEM_BASE: self.bin_sem_delete,
            OS_MUTEX_BASE: self.mut_sem_delete,
            OS_STREAM_BASE: self.close,
            OS_TIMECB_BASE: self.timer_delete,
            OS_TIMEBASE_BASE: self.time_base_delete,
            OS_DIR_BASE: self.directory_close,
            OS_CONDVAR_BASE: self.cond_var_delete,
            OS_RWLOCK_BASE: self.rw_lock_delete,
            OS_MODULE_BASE: self.module_unload,
        }

    def delete_objects_of(self, owner: Any) -> list[Leftover]:
        """Delete the tasks that work for an application, youngest first, each after all it made.

        The calling task is left out.

        Args:
            owner: what `Task.owner` is for these tasks.

        Returns:
            What could not be deleted.
        """
        for task_id, record in reversed(self._tasks_of(owner)):
            self.delete_objects_of_task(task_id)
            if not record.deleted:
                self.task_delete(task_id)
        # Once more for what is left: mutexes that a task held until it ended, things of tasks that ended before.
        return self._delete_where(lambda record: record.owner is owner and not self._is_caller(record))

    def delete_objects_of_task(self, task_id: int) -> list[Leftover]:
        """Delete every object that a task created, other tasks included, but not the task (OS_ForEachObject).

        Returns:
            What could not be deleted.
        """
        return self._delete_where(lambda record: record.creator == task_id and not self._is_caller(record))

    def _tasks_of(self, owner: Any) -> list[tuple[int, OsTask]]:
        return [
            (task_id, record)
            for task_id, record in sorted(self._tasks.items())
            if record.task is not None and record.task.owner is owner and not self._is_caller(record)
        ]

    def _is_caller(self, record: OsObject) -> bool:
        return isinstance(record, OsTask) and record.task is self.kernel.current

    def _delete_where(self, belongs: Callable[[OsObject], bool]) -> list[Leftover]:
        leftovers: list[Leftover] = []
        for base, delete in self._deleters.items():
            for object_id, record in self._tables[base].items():
                if record.deleted or not belongs(record):
                    continue
                try:
                    delete(object_id)
                except OsalError as error:
                    leftovers.append(Leftover(object_id, error))
        return leftovers

"""OSAL mutexes (OS_MutSem*): recursive, with priority inheritance, given back by their owner only.

May import cfepy.rtos, ids, status and its neighbours in cfepy.osal.
"""

from __future__ import annotations

from typing import NamedTuple

from cfepy.ids import OS_MUTEX_BASE
from cfepy.osal.core import Core, ObjectTable, OsObject, Setup
from cfepy.rtos import Mutex
from cfepy.status import OS_SEM_FAILURE, OsalError


class MutexInfo(NamedTuple):
    """What `mut_sem_get_info` tells (OS_mut_sem_prop_t)."""

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
        self._mutexes: ObjectTable[OsMutex] = self._table("mutex", OS_MUTEX_BASE, setup.config.os_max_semaphores)

    def mut_sem_create(self, name: str, options: int = 0) -> int:
        """Make a mutex (OS_MutSemCreate).

        Args:
            name: unique among mutexes, at most 19 characters.
            options: without effect, as in NASA's.

        Returns:
            The mutex's id.

        Raises:
            OsalError: OS_ERR_NAME_TOO_LONG, OS_ERR_NAME_TAKEN or OS_ERR_NO_FREE_IDS.
        """
        if self._cost:
            self.kernel.charge(self._cost)
        record = OsMutex(name, Mutex(self.kernel, name))
        return self._register(self._mutexes, record, "mutex", self._setup.sizes.mutex)

    def mut_sem_take(self, mutex_id: int) -> None:
        """Wait until the mutex is free or ours already; the owner becomes as urgent as we are (OS_MutSemTake).

        Raises:
            OsalError: OS_ERR_INVALID_ID.
            DeadlockError: the owner waits, directly or not, for a mutex that the caller holds.
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
            OsalError: OS_SEM_FAILURE when the caller does not own it; OS_ERR_INVALID_ID.
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
                f"{self.kernel.current.name} gives mutex {record.name}, which "
                + (f"{owner.name} owns" if owner is not None else "nobody owns"),
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
        """Id of a named mutex, or OS_ERR_NAME_NOT_FOUND (OS_MutSemGetIdByName)."""
        return self._mutexes.named(name)

    def mut_sem_get_info(self, mutex_id: int) -> MutexInfo:
        """Facts about a mutex, or OS_ERR_INVALID_ID (OS_MutSemGetInfo)."""
        record = self._mutex(mutex_id)
        return MutexInfo(record.name, record.creator)

    def _mutex(self, mutex_id: int) -> OsMutex:
        record = self._mutexes.lookup(mutex_id)
        if record is None:
            raise self._mutexes.missing(mutex_id)
        return record

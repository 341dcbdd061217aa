"""OSAL readers-writer locks (OS_RwLock*): many readers or one writer, and a waiting writer holds new readers back.

May import cfepy.rtos, ids, status and its neighbours in cfepy.osal.
"""

from __future__ import annotations

from typing import NamedTuple

from cfepy.ids import OS_RWLOCK_BASE
from cfepy.osal.core import Core, ObjectTable, OsObject, Setup
from cfepy.osal.limits import OS_MAX_RWLOCKS
from cfepy.rtos import Task, WaitList
from cfepy.status import OS_ERROR, OsalError


class RwLockInfo(NamedTuple):
    """What `rw_lock_get_info` tells (OS_rwlock_prop_t)."""

    name: str
    creator: int


class OsRwLock(OsObject):
    """The record of a readers-writer lock."""

    __slots__ = ("readers", "waiting_readers", "waiting_writers", "writer")

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.readers = 0
        self.writer: Task | None = None
        self.waiting_readers = WaitList(f"readers of lock {name}")
        self.waiting_writers = WaitList(f"writers of lock {name}")
        self.waiting_readers.owner = self.waiting_writers.owner = lambda: self.writer


class RwLockApi(Core):
    """The OS_RwLock* functions."""

    def __init__(self, setup: Setup) -> None:
        super().__init__(setup)
        self._rw_locks: ObjectTable[OsRwLock] = self._table("readers-writer lock", OS_RWLOCK_BASE, OS_MAX_RWLOCKS)

    def rw_lock_create(self, name: str, options: int = 0) -> int:
        """Make a readers-writer lock (OS_RwLockCreate).

        Args:
            name: unique among these locks, at most 19 characters.
            options: without effect, as in NASA's.

        Returns:
            The lock's id.

        Raises:
            OsalError: OS_ERR_NAME_TOO_LONG, OS_ERR_NAME_TAKEN or OS_ERR_NO_FREE_IDS.
        """
        return self._register(self._rw_locks, OsRwLock(name), "readers-writer lock", self._setup.sizes.mutex)

    def rw_lock_read_take(self, rw_id: int) -> None:
        """Wait until nobody writes or waits to write (OS_RwLockReadTake).

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        record = self._rw_lock(rw_id)
        if record.writer is None and not record.waiting_writers:
            record.readers += 1
        else:
            self.kernel.wait_on(record.waiting_readers)

    def rw_lock_read_give(self, rw_id: int) -> None:
        """One reader less (OS_RwLockReadGive).

        Raises:
            OsalError: OS_ERROR when nobody reads; OS_ERR_INVALID_ID.
        """
        record = self._rw_lock(rw_id)
        if not record.readers:
            raise OsalError(OS_ERROR, f"nobody holds lock {record.name} for reading")
        record.readers -= 1
        if not record.readers:
            self._hand_on(record)

    def rw_lock_write_take(self, rw_id: int) -> None:
        """Wait until nobody reads or writes (OS_RwLockWriteTake).

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        record = self._rw_lock(rw_id)
        if record.writer is None and not record.readers:
            record.writer = self.kernel.current
        else:
            self.kernel.wait_on(record.waiting_writers)

    def rw_lock_write_give(self, rw_id: int) -> None:
        """Stop writing (OS_RwLockWriteGive).

        Raises:
            OsalError: OS_ERROR when the caller does not write; OS_ERR_INVALID_ID.
        """
        record = self._rw_lock(rw_id)
        if record.writer is not self.kernel.current:
            raise OsalError(OS_ERROR, f"the caller does not hold lock {record.name} for writing")
        record.writer = None
        self._hand_on(record)

    def rw_lock_delete(self, rw_id: int) -> None:
        """Delete a lock (OS_RwLockDelete).

        Raises:
            OsalError: OS_ERROR while somebody holds it; OS_ERR_INVALID_ID.
        """
        record = self._rw_lock(rw_id)
        if record.readers or record.writer is not None:
            raise OsalError(OS_ERROR, f"lock {record.name} is held")
        self._unregister(self._rw_locks, record)

    def rw_lock_get_id_by_name(self, name: str) -> int:
        """Id of a named lock, or OS_ERR_NAME_NOT_FOUND (OS_RwLockGetIdByName)."""
        return self._rw_locks.named(name)

    def rw_lock_get_info(self, rw_id: int) -> RwLockInfo:
        """Facts about a lock, or OS_ERR_INVALID_ID (OS_RwLockGetInfo)."""
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
        """The lock is free: the most urgent writer gets it, or else all readers."""
        if record.waiting_writers:
            record.writer = record.waiting_writers[0]
            self.kernel.wake_first(record.waiting_writers)
        elif record.waiting_readers:
            record.readers = len(record.waiting_readers)
            self.kernel.wake_all(record.waiting_readers)

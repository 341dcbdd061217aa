"""OSAL binary and counting semaphores (OS_BinSem*, OS_CountSem*)."""

from __future__ import annotations

from typing import NamedTuple

from cfepy.ids import OS_BINSEM_BASE, OS_COUNTSEM_BASE
from cfepy.osal.core import Core, OsObject, OsObjectTable, Setup
from cfepy.osal.limits import OS_CHECK, OS_PEND, SEM_VALUE_MAX
from cfepy.rtos import TIMEOUT, Semaphore
from cfepy.status import OS_ERR_INVALID_ARGUMENT, OS_INVALID_SEM_VALUE, OS_SEM_FAILURE, OsalError
from cfepy.units import NS_PER_MS


class SemaphoreInfo(NamedTuple):
    """The result of `bin_sem_get_info` and `count_sem_get_info` (OS_bin_sem_prop_t, OS_count_sem_prop_t)."""

    name: str
    creator: int
    value: int


class OsSemaphore(OsObject):
    """The record of a semaphore of either kind."""

    __slots__ = ("semaphore",)

    def __init__(self, name: str, semaphore: Semaphore) -> None:
        super().__init__(name)
        self.semaphore = semaphore
        semaphore.waits.subject = self


class SemaphoreApi(Core):
    """The OS_BinSem* and OS_CountSem* functions."""

    def __init__(self, setup: Setup) -> None:
        super().__init__(setup)
        self._bin_sems: OsObjectTable[OsSemaphore] = self._table(
            "binary semaphore", OS_BINSEM_BASE, setup.config.os_max_bin_semaphores
        )
        self._count_sems: OsObjectTable[OsSemaphore] = self._table(
            "counting semaphore", OS_COUNTSEM_BASE, setup.config.os_max_count_semaphores
        )

    def bin_sem_create(self, name: str, initial_value: int, options: int = 0) -> int:
        """Make a binary semaphore (OS_BinSemCreate).

        Args:
            name: unique among binary semaphores, at most 19 characters.
            initial_value: OS_SEM_EMPTY or OS_SEM_FULL; a larger value counts as full, as in NASA's OSAL.
            options: no effect, as in NASA's OSAL.

        Returns:
            The semaphore's id.

        Raises:
            OsalError: OS_ERR_NAME_TOO_LONG, OS_INVALID_SEM_VALUE (negative), OS_ERR_NAME_TAKEN or OS_ERR_NO_FREE_IDS.
        """
        return self._create(self._bin_sems, name, min(initial_value, 1), 1)

    def bin_sem_give(self, sem_id: int) -> None:
        """Make a semaphore full; the most urgent waiting task takes it (OS_BinSemGive).

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        if self._cost:
            self.kernel.charge(self._cost)
        record = self._bin_sems.lookup(sem_id)
        if record is None:
            raise self._bin_sems.missing(sem_id)
        record.semaphore.give()

    def bin_sem_flush(self, sem_id: int) -> None:
        """Wake every waiting task, and leave the semaphore unchanged (OS_BinSemFlush).

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        if self._cost:
            self.kernel.charge(self._cost)
        self._semaphore(self._bin_sems, sem_id).semaphore.flush()

    def bin_sem_take(self, sem_id: int) -> None:
        """Wait until the semaphore is full and empty it (OS_BinSemTake).

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        self._take(self._bin_sems, sem_id, OS_PEND)

    def bin_sem_timed_wait(self, sem_id: int, timeout_ms: int) -> bool:
        """Take a semaphore like `bin_sem_take`, waiting at most `timeout_ms` (OS_BinSemTimedWait).

        Returns:
            False after the timeout.

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERR_INVALID_ARGUMENT for a negative time.
        """
        return self._timed_wait(self._bin_sems, sem_id, timeout_ms)

    def bin_sem_delete(self, sem_id: int) -> None:
        """Delete a binary semaphore (OS_BinSemDelete).

        The call waits until no task waits for the semaphore, as pthread_cond_destroy does; no task can give it any
        more. In a safe mission it ends these waits with OS_ERR_INVALID_ID.

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        record = self._semaphore(self._bin_sems, sem_id)
        if record.semaphore.waits and self._is_strict:
            self._await_leaving(self._bin_sems, record, record.semaphore.waits)
        self._delete(self._bin_sems, sem_id)

    def bin_sem_get_id_by_name(self, name: str) -> int:
        """Return the id of a named binary semaphore, or OS_ERR_NAME_NOT_FOUND (OS_BinSemGetIdByName)."""
        return self._id_by_name(self._bin_sems, name)

    def bin_sem_get_info(self, sem_id: int) -> SemaphoreInfo:
        """Return facts about a binary semaphore, or OS_ERR_INVALID_ID (OS_BinSemGetInfo)."""
        return _info(self._semaphore(self._bin_sems, sem_id))

    def count_sem_create(self, name: str, initial_value: int, options: int = 0) -> int:
        """Make a counting semaphore (OS_CountSemCreate).

        Args:
            name: unique among counting semaphores, at most 19 characters.
            initial_value: 0 to SEM_VALUE_MAX.
            options: no effect, as in NASA's OSAL.

        Returns:
            The semaphore's id.

        Raises:
            OsalError: OS_ERR_NAME_TOO_LONG, OS_INVALID_SEM_VALUE, OS_ERR_NAME_TAKEN or OS_ERR_NO_FREE_IDS.
        """
        return self._create(self._count_sems, name, initial_value, None)

    def count_sem_give(self, sem_id: int) -> None:
        """Increment the count, or wake the most urgent waiter (OS_CountSemGive).

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_SEM_FAILURE at SEM_VALUE_MAX.
        """
        if self._cost:
            self.kernel.charge(self._cost)
        record = self._count_sems.lookup(sem_id)
        if record is None:
            raise self._count_sems.missing(sem_id)
        if record.semaphore.count >= SEM_VALUE_MAX:
            raise OsalError(OS_SEM_FAILURE, f"counting semaphore {record.name} is at its maximum")
        record.semaphore.give()

    def count_sem_take(self, sem_id: int) -> None:
        """Wait until the count is above 0, then decrement it (OS_CountSemTake).

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        self._take(self._count_sems, sem_id, OS_PEND)

    def count_sem_timed_wait(self, sem_id: int, timeout_ms: int) -> bool:
        """Take a semaphore like `count_sem_take`, waiting at most `timeout_ms` (OS_CountSemTimedWait).

        Returns:
            False after the timeout.

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERR_INVALID_ARGUMENT for a negative time.
        """
        return self._timed_wait(self._count_sems, sem_id, timeout_ms)

    def count_sem_delete(self, sem_id: int) -> None:
        """Delete a counting semaphore (OS_CountSemDelete).

        Tasks that wait for it wait on, to their time limit or forever, as on Linux. In a safe mission they get
        OS_ERR_INVALID_ID.

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        self._delete(self._count_sems, sem_id)

    def count_sem_get_id_by_name(self, name: str) -> int:
        """Return the id of a named counting semaphore, or OS_ERR_NAME_NOT_FOUND (OS_CountSemGetIdByName)."""
        return self._id_by_name(self._count_sems, name)

    def count_sem_get_info(self, sem_id: int) -> SemaphoreInfo:
        """Return facts about a counting semaphore, or OS_ERR_INVALID_ID (OS_CountSemGetInfo)."""
        return _info(self._semaphore(self._count_sems, sem_id))

    def _create(self, table: OsObjectTable[OsSemaphore], name: str, initial_value: int, maximum: int | None) -> int:
        if self._cost:
            self.kernel.charge(self._cost)
        table.check_free(name)
        if not 0 <= initial_value <= SEM_VALUE_MAX:
            raise OsalError(OS_INVALID_SEM_VALUE, f"invalid initial value {initial_value} of {table.kind} {name}")
        record = OsSemaphore(name, Semaphore(self.kernel, initial_value, maximum, name))
        return self._register(table, record, "semaphore", self._setup.sizes.semaphore)

    def _semaphore(self, table: OsObjectTable[OsSemaphore], sem_id: int) -> OsSemaphore:
        record = table.lookup(sem_id)
        if record is None:
            raise table.missing(sem_id)
        return record

    def _take(self, table: OsObjectTable[OsSemaphore], sem_id: int, timeout_ns: int) -> bool:
        if self._cost:
            self.kernel.charge(self._cost)
        record = table.lookup(sem_id)
        if record is None:
            raise table.missing(sem_id)
        try:
            if record.semaphore.take(timeout_ns):
                return True
        except BaseException:
            self._has_left(record, record.semaphore.waits)
            raise
        self._has_left(record, record.semaphore.waits)
        if record.deleted and self.config.safe:
            raise table.gone(record)
        return False

    def _timed_wait(self, table: OsObjectTable[OsSemaphore], sem_id: int, timeout_ms: int) -> bool:
        if timeout_ms < OS_CHECK:
            raise OsalError(OS_ERR_INVALID_ARGUMENT, f"invalid timeout: {timeout_ms} ms")
        return self._take(table, sem_id, timeout_ms * NS_PER_MS)

    def _delete(self, table: OsObjectTable[OsSemaphore], sem_id: int) -> None:
        record = self._semaphore(table, sem_id)
        self._unregister(table, record)
        if self.config.safe:
            self.kernel.wake_all(record.semaphore.waits, TIMEOUT)
        else:
            record.semaphore.waits.orphan()


def _info(record: OsSemaphore) -> SemaphoreInfo:
    return SemaphoreInfo(record.name, record.creator, record.semaphore.count)

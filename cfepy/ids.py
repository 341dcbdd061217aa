"""Resource ids: the numbers of tasks, queues, apps, pipes and other objects of OSAL and cFE (CFE_ResourceId, idmap).

An id is `base << 16 | serial`. The base identifies the kind of object. The serial number increases with every creation,
so the id of a deleted object is not reused soon. A record is in slot `serial % capacity` of its table. A base is the
small number here (app 0x11). C's CFE_ES_APPID_BASE and CFE_ResourceId_GetBase have it shifted (0x110000).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Generic, TypeVar

from cfepy.reading.texts import to_bytes
from cfepy.status import (
    CFE_ES_BAD_ARGUMENT,
    CFE_ES_ERR_RESOURCEID_NOT_VALID,
    CFE_ES_NO_RESOURCE_IDS_AVAILABLE,
    OS_ERR_INVALID_ID,
    OS_ERR_NO_FREE_IDS,
    CfeError,
    OsalError,
)

OS_TASK_BASE = 0x01
OS_QUEUE_BASE = 0x02
OS_COUNTSEM_BASE = 0x03
OS_BINSEM_BASE = 0x04
OS_MUTEX_BASE = 0x05
OS_STREAM_BASE = 0x06
OS_DIR_BASE = 0x07
OS_TIMEBASE_BASE = 0x08
OS_TIMECB_BASE = 0x09
OS_MODULE_BASE = 0x0A
OS_FILESYS_BASE = 0x0B
OS_CONSOLE_BASE = 0x0C
OS_CONDVAR_BASE = 0x0D
OS_RWLOCK_BASE = 0x0E
OS_USER_BASE = 0x10

ES_TASKID_BASE = OS_TASK_BASE
ES_APPID_BASE = OS_USER_BASE + 1
ES_LIBID_BASE = OS_USER_BASE + 2
ES_COUNTID_BASE = OS_USER_BASE + 3
ES_POOLID_BASE = OS_USER_BASE + 4
ES_CDSBLOCKID_BASE = OS_USER_BASE + 5
SB_PIPEID_BASE = OS_USER_BASE + 6
CONFIGID_BASE = OS_USER_BASE + 7
TBL_VALRESULTID_BASE = OS_USER_BASE + 8
TBL_DUMPCTRLID_BASE = OS_USER_BASE + 9
TBL_LOADBUFFID_BASE = OS_USER_BASE + 10
TBL_HANDLE_BASE = OS_USER_BASE + 11
TBL_REGID_BASE = OS_USER_BASE + 12

UNDEFINED = 0
RESERVED = 0xFFFFFFFF
SERIAL_MAX = 0xFFFF
SHIFT = 16

Record = TypeVar("Record")


def make(base: int, serial: int) -> int:
    """Return the id with a serial number and a base."""
    return base << SHIFT | serial


def get_base(resource_id: int) -> int:
    """Return the base of an id, e.g. 0x11 for an app (CFE_ResourceId_GetBase without the shift)."""
    return resource_id >> SHIFT


def get_serial(resource_id: int) -> int:
    """Return the serial number within the kind (CFE_ResourceId_GetSerial)."""
    return resource_id & SERIAL_MAX


def is_defined(resource_id: int) -> bool:
    """Return whether an id is not 0 (CFE_ResourceId_IsDefined)."""
    return resource_id != UNDEFINED


def equal(first: int, second: int) -> bool:
    """Return whether two ids are the same (CFE_ResourceId_Equal)."""
    return first == second


def to_integer(resource_id: int) -> int:
    """Return the id as a number for texts and packets; ids are plain integers here (CFE_ResourceId_ToInteger)."""
    return resource_id


def from_integer(value: int) -> int:
    """Return the id for a number from a packet (CFE_ResourceId_FromInteger)."""
    return value & 0xFFFFFFFF


def to_index(resource_id: int, base: int, capacity: int) -> int:
    """Return the slot of an id in a table of `capacity` slots (CFE_ResourceId_ToIndex).

    Raises:
        CfeError: CFE_ES_ERR_RESOURCEID_NOT_VALID when the id is of another kind or the table has no slots.
    """
    if get_base(resource_id) != base or capacity <= 0:
        raise CfeError(CFE_ES_ERR_RESOURCEID_NOT_VALID, f"id 0x{resource_id:x} is not one of base 0x{base:x}")
    return get_serial(resource_id) % capacity


def name_size(name: str) -> int:
    """Return the bytes of a name in C without its final NUL; limits of name lengths count these."""
    return len(to_bytes(name))


def find_next(start_id: int, capacity: int, is_used: Callable[[int], bool]) -> int:
    """Return the first unused id after `start_id`, trying each slot once (CFE_ResourceId_FindNext).

    Args:
        start_id: the id that was allocated last; the first id has serial number 1.
        capacity: slots of the table.
        is_used: returns whether the slot of an id is taken.

    Returns:
        The id, or 0 if every slot is taken.
    """
    base, serial = get_base(start_id), get_serial(start_id)
    for _ in range(capacity):
        serial += 1
        if serial >= SERIAL_MAX:
            serial %= capacity
        if not is_used(make(base, serial)):
            return make(base, serial)
    return UNDEFINED


def find_next_ex(start_id: int, increment: Callable[[int], int], is_used: Callable[[int], bool]) -> int:
    """Return the first unused id, with the caller's own increment (CFE_ResourceId_FindNextEx).

    Args:
        start_id: the id that was allocated last.
        increment: returns the id to try next, or 0 to give up.
        is_used: returns whether the slot of an id is taken.
    """
    candidate = increment(start_id)
    while is_defined(candidate) and is_used(candidate):
        candidate = increment(candidate)
    return candidate


class IdTable(Generic[Record]):
    """A table of records by id, with ids of one base; every OSAL and cFE object table is one.

    Args:
        base: one of the *_BASE numbers.
        capacity: maximum number of records.
        full: status raised if there is no free slot; by default OS_ERR_NO_FREE_IDS for an OSAL base, otherwise
            CFE_ES_NO_RESOURCE_IDS_AVAILABLE.
        invalid: status raised for an id that is not in the table; by default OS_ERR_INVALID_ID or
            CFE_ES_ERR_RESOURCEID_NOT_VALID.
    """

    __slots__ = ("_error", "_full", "_invalid", "_last_id", "_slots", "base", "capacity", "records")

    def __init__(self, base: int, capacity: int, full: int | None = None, invalid: int | None = None) -> None:
        if not 0 < base <= SERIAL_MAX or not 0 < capacity < SERIAL_MAX:
            raise CfeError(CFE_ES_BAD_ARGUMENT, f"invalid capacity of the id table of base 0x{base:x}: {capacity}")
        is_osal = base < OS_USER_BASE
        self.base = base
        self.capacity = capacity
        self._error: type[CfeError] = OsalError if is_osal else CfeError
        self._full = (OS_ERR_NO_FREE_IDS if is_osal else CFE_ES_NO_RESOURCE_IDS_AVAILABLE) if full is None else full
        default_invalid = OS_ERR_INVALID_ID if is_osal else CFE_ES_ERR_RESOURCEID_NOT_VALID
        self._invalid = default_invalid if invalid is None else invalid
        self._last_id = make(base, 0)
        self._slots: list[int] = [UNDEFINED] * capacity
        self.records: dict[int, Record] = {}

    def create(self, record: Record) -> int:
        """Put a record into the next free slot and return its id.

        Raises:
            CfeError: if there is no free slot (OsalError for an OSAL base).
        """
        new_id = self.skip()
        self._slots[self.index(new_id)] = new_id
        self.records[new_id] = record
        return new_id

    def skip(self) -> int:
        """Use up the next free id without a record, for a creation that failed after it reserved its slot.

        Returns:
            The id.

        Raises:
            CfeError: if there is no free slot (OsalError for an OSAL base).
        """
        new_id = find_next(self._last_id, self.capacity, lambda candidate: self._slots[self.index(candidate)] != 0)
        if not new_id:
            raise self._error(self._full, f"all {self.capacity} slots of base 0x{self.base:x} are taken")
        self._last_id = new_id
        return new_id

    def find(self, resource_id: int) -> Record | None:
        """Return the record of an id, or None if there is none."""
        return self.records.get(resource_id)

    def get(self, resource_id: int) -> Record:
        """Return the record of an id.

        Raises:
            CfeError: the id is not in the table (OsalError for an OSAL base).
        """
        record = self.records.get(resource_id)
        if record is None:
            raise self._error(self._invalid, f"invalid id 0x{resource_id:x}")
        return record

    def delete(self, resource_id: int) -> Record:
        """Remove a record and return it; its serial number is reused only after all others.

        Raises:
            CfeError: if the id is not in the table.
        """
        record = self.get(resource_id)
        # Clear the slot first. An interrupt between the two steps then leaves no id in a slot without a record, so
        # items() works.
        self._slots[self.index(resource_id)] = UNDEFINED
        del self.records[resource_id]
        return record

    def index(self, resource_id: int) -> int:
        """Return the slot of an id, 0 to capacity - 1, whether or not it is in use."""
        return get_serial(resource_id) % self.capacity

    def at(self, index: int) -> Record | None:
        """Return the record in a slot, or None when the slot is free or out of range."""
        return self.records.get(self._slots[index]) if 0 <= index < self.capacity else None

    def items(self) -> list[tuple[int, Record]]:
        """Return a copy of the table as a list of (id, record) in slot order.

        A record that is being deleted keeps its slot, but it is not in the list (OS_ObjectIdIsValid).
        """
        return [(used, self.records[used]) for used in self._slots if used in self.records]

    def __iter__(self) -> Iterator[Record]:
        return iter([record for _, record in self.items()])

    def __len__(self) -> int:
        return len(self.records)

    def __contains__(self, resource_id: object) -> bool:
        return resource_id in self.records

"""The common base of all parts of OSAL: the records of objects, the tables with their names, and the cost of calls.

An OSAL object is a record in a table of its kind. It has an id, a unique name and the task that created it
(osapi-idmap.c, OS_common_record_t). Each part of the interface is a class derived from `Core` in a module of its own.
`cfepy.osal.osal.Osal` combines them all.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, NoReturn, Protocol, TypeVar

from cfepy.config.platform import PlatformConfig
from cfepy.ids import OS_TIMEBASE_BASE, IdTable, get_base, name_size
from cfepy.osal.filesystem import FileSystem
from cfepy.osal.limits import (
    OS_EVENT_RESOURCE_ALLOCATED,
    OS_EVENT_RESOURCE_CREATED,
    OS_EVENT_RESOURCE_DELETED,
    OS_MAX_API_NAME,
    SIZE_MAX,
)
from cfepy.osal.network import Network
from cfepy.rtos import CpuCosts, Kernel, Task, WaitList
from cfepy.status import (
    OS_ERR_INCORRECT_OBJ_STATE,
    OS_ERR_INVALID_ID,
    OS_ERR_INVALID_SIZE,
    OS_ERR_NAME_NOT_FOUND,
    OS_ERR_NAME_TAKEN,
    OS_ERR_NAME_TOO_LONG,
    OS_ERROR,
    OsalError,
)
from cfepy.writing.console import Console


class Deleted:
    """The type of `DELETED`, the value of a wait that ends because its object is deleted."""

    def __bool__(self) -> bool:
        return False


DELETED = Deleted()


class Nobody:
    """The owner of tasks that belong to no application; its only instance is `NOBODY`."""

    name = "system"  # its name in the memory accounting and in messages


NOBODY = Nobody()


class Ledger(Protocol):
    """The memory accounting: the board's budget (`cfepy.psp.memory.MemoryBudget`)."""

    def claim(self, owner: str, kind: str, size: int) -> int:
        """Claim `size` bytes for an owner; return a token to release them with."""

    def release(self, token: int) -> None:
        """Release a claim."""

    @property
    def free(self) -> int | None:
        """Free bytes, or None if there is no limit."""


@dataclass(frozen=True, slots=True)
class ObjectSizes:
    """Bytes of memory that a board's operating system uses for each object; all 0 if memory is not accounted for."""

    task: int = 0  # the control block, without the stack
    queue: int = 0
    queue_slot: int = 0  # added to the message size
    semaphore: int = 0
    mutex: int = 0
    timer: int = 0


@dataclass(frozen=True, slots=True)
class Setup:
    """The parts and settings of an `Osal`.

    Args:
        kernel: the simulated real-time kernel.
        config: the limits.
        console: the output of OS_printf.
        files: the virtual file system.
        network: the virtual network of the sockets.
        memory: the account for stacks and objects; None does not account.
        sizes: memory used by each object.
        costs: virtual CPU time of a call, and of copying bytes through a queue, a file or a socket.
        epoch_ns: local time at virtual time 0, in ns since the mission's epoch.
    """

    kernel: Kernel
    config: PlatformConfig
    console: Console
    files: FileSystem = field(default_factory=FileSystem)
    network: Network = field(default_factory=Network)
    memory: Ledger | None = None
    sizes: ObjectSizes = field(default_factory=ObjectSizes)
    costs: CpuCosts = field(default_factory=CpuCosts)
    epoch_ns: int = 0


class OsObject:
    """The common part of every OSAL object.

    Args:
        name: at most 19 characters, unique among objects of the same kind.
    """

    __slots__ = ("claim", "creator", "deleted", "deleters", "id", "name", "owner", "users")

    def __init__(self, name: str) -> None:
        self.name = name
        self.id = 0
        self.creator = 0  # id of the task that created it, 0 for the system
        self.owner: Any = None  # the application that owned the creating task
        self.users: tuple[Any, ...] = ()  # the applications that looked up its id by its name
        self.claim = 0
        self.deleted = False
        self.deleters: WaitList | None = None  # the task that waits until it can delete the object

    @property
    def resource_name(self) -> str:
        """The result of OS_GetResourceName."""
        return self.name


Record = TypeVar("Record", bound=OsObject)
EventHandler = Callable[[int, int, Any], int | None]
"""Called for every object with OS_EVENT_*, the id and None. A status other than 0 refuses a new object
(OS_EventHandler_t).
"""


class OsObjectTable(IdTable[Record]):
    """All objects of one kind, by id and by name.

    Args:
        kind: for error texts, e.g. "queue".
        base: one of the OS_*_BASE numbers.
        capacity: maximum number of objects.
        name_limit: number of bytes at which a name is too long.
    """

    __slots__ = ("kind", "lookup", "name_limit", "names")

    def __init__(self, kind: str, base: int, capacity: int, name_limit: int = OS_MAX_API_NAME) -> None:
        super().__init__(base, capacity)
        self.kind = kind
        self.name_limit = name_limit
        self.names: dict[str, int] = {}
        self.lookup: Callable[[int], Record | None] = self.records.get

    def add(self, record: Record) -> int:
        """Add a record and return its id.

        Raises:
            OsalError: OS_ERR_NAME_TOO_LONG, OS_ERR_NAME_TAKEN or OS_ERR_NO_FREE_IDS.
        """
        self.check_free(record.name)
        record.id = self.create(record)
        self.names[record.name] = record.id
        return record.id

    def refuse(self, name: str, why: str) -> NoReturn:
        """Raise OS_ERROR for an object that the operating system refuses to create; this uses up its id."""
        self.check_free(name)
        self.skip()
        raise OsalError(OS_ERROR, why)

    def check_free(self, name: str) -> None:
        """Raise OS_ERR_NAME_TOO_LONG or OS_ERR_NAME_TAKEN for a name that a new object cannot have."""
        self.check_name(name)
        if name in self.names:
            raise OsalError(OS_ERR_NAME_TAKEN, f"{self.kind} {name!r} already exists")

    def drop(self, record: Record) -> None:
        """Remove a record and free its name."""
        self.delete(record.id)
        self.names.pop(record.name, None)
        record.deleted = True

    def named(self, name: str) -> int:
        """Return the id of a name.

        Raises:
            OsalError: OS_ERR_NAME_NOT_FOUND or OS_ERR_NAME_TOO_LONG.
        """
        self.check_name(name)
        found = self.names.get(name)
        if found is None:
            raise OsalError(OS_ERR_NAME_NOT_FOUND, f"unknown {self.kind} {name!r}")
        return found

    def check_name(self, name: str) -> None:
        """Raise OS_ERR_NAME_TOO_LONG for a name that is too long, by default more than 19 bytes."""
        if name_size(name) >= self.name_limit:
            raise OsalError(
                OS_ERR_NAME_TOO_LONG, f"{self.kind} name {name!r} must have at most {self.name_limit - 1} characters"
            )

    def missing(self, object_id: int) -> OsalError:
        """Return the error for an id that is not in the table."""
        return OsalError(OS_ERR_INVALID_ID, f"invalid {self.kind} id {object_id:#x}")

    def gone(self, record: Record) -> OsalError:
        """Return the error for a task whose wait ended because the object was deleted."""
        return OsalError(OS_ERR_INVALID_ID, f"{self.kind} {record.name} was deleted by another task")


class Core:
    """State and helpers of every part of the interface."""

    def __init__(self, setup: Setup) -> None:
        self.kernel = setup.kernel
        self.config = setup.config
        self.console = setup.console
        self._setup = setup
        self._costs = setup.costs
        self._cost = setup.costs.call_ns
        self._task_ids: dict[Task, int] = {}
        self._tables: dict[int, OsObjectTable[Any]] = {}
        self._event_handler: EventHandler | None = None
        self._is_shut_down = False

    def _table(self, kind: str, base: int, capacity: int, name_limit: int = OS_MAX_API_NAME) -> OsObjectTable[Any]:
        table: OsObjectTable[Any] = OsObjectTable(kind, base, capacity, name_limit)
        self._tables[base] = table
        return table

    def _register(self, table: OsObjectTable[Record], record: Record, kind: str, size: int, owner: Any = None) -> int:
        """Account for an object of an application, by default the current task's, and give it an id."""
        if self._is_shut_down:
            raise OsalError(OS_ERR_INCORRECT_OBJ_STATE, f"OSAL is shut down; cannot create a {table.kind}")
        task = self.kernel.current
        record.owner = task.owner if owner is None else owner
        record.creator = self._task_ids.get(task, 0)
        memory = self._setup.memory
        if memory is not None:
            record.claim = memory.claim(_owner_name(record.owner), kind, size)
        try:
            object_id = table.add(record)
        except OsalError:
            self._release(record)
            raise
        if self._event_handler is not None:
            self._announce(table, record)
        return object_id

    def _reserve(self, table: OsObjectTable[Record], record: Record) -> Record:
        """Add an object that cFE or the PSP makes for itself. It belongs to no application, and costs no memory here:
        a board's profile has the memory of cFE as a whole.
        """
        table.add(record)
        return record

    def _id_by_name(self, table: OsObjectTable[Record], name: str) -> int:
        """Return the id of a name, and record the caller's application as a user of the object."""
        object_id = table.named(name)
        record, owner = table.records[object_id], self.kernel.current.owner
        if owner not in record.users:
            record.users = (*record.users, owner)
        return object_id

    def _unregister(self, table: OsObjectTable[Record], record: Record) -> None:
        table.drop(record)
        self._release(record)
        self._notify(OS_EVENT_RESOURCE_DELETED, record.id)

    @property
    def _is_strict(self) -> bool:
        """Whether a call hangs or leaks as on NASA's Linux: in a task, of a mission that is not safe."""
        return not self.config.safe and self.kernel.current is not self.kernel.host

    def _await_leaving(self, table: OsObjectTable[Record], record: Record, waits: WaitList) -> None:
        """Wait until no task waits in a list of an object that is being deleted, as pthread_cond_destroy does.

        The object has no id meanwhile, so no task can wake the waiting ones.
        """
        del table.records[record.id]
        waits.is_orphaned = True
        waits.what += f", which {self.kernel.current.name} is deleting"
        record.deleters = WaitList(f"the tasks to leave {table.kind} {record.name}, which it deletes")
        record.deleters.holders = lambda: tuple(waits)
        try:
            self.kernel.wait_on(record.deleters)
        finally:
            table.records[record.id] = record

    def _has_left(self, record: OsObject, waits: WaitList) -> None:
        """Wake the task that deletes an object, if the caller was the last that waited for it."""
        if record.deleters is not None and not waits:
            self.kernel.wake_all(record.deleters)

    def _announce(self, table: OsObjectTable[Record], record: Record) -> None:
        """Report a new object to the event handler, which can refuse it (OS_ObjectIdAllocateNew)."""
        status = self._notify(OS_EVENT_RESOURCE_ALLOCATED, record.id)
        if status:
            table.drop(record)
            self._release(record)
            raise OsalError(status, f"the event handler refused {table.kind} {record.name}")
        self._notify(OS_EVENT_RESOURCE_CREATED, record.id)

    def _notify(self, event: int, object_id: int) -> int:
        """Return the event handler's status, or 0 without a handler (OS_NotifyEvent)."""
        return 0 if self._event_handler is None else self._event_handler(event, object_id, None) or 0

    def _release(self, record: OsObject) -> None:
        if self._setup.memory is not None and record.claim:
            self._setup.memory.release(record.claim)
            record.claim = 0

    def _refuse_in_callback(self, what: str) -> None:
        """Raise OS_ERR_INCORRECT_OBJ_STATE in a timer's callback, which must not manage timers."""
        if get_base(self._task_ids.get(self.kernel.current, 0)) == OS_TIMEBASE_BASE:
            raise OsalError(OS_ERR_INCORRECT_OBJ_STATE, f"{what} cannot be called from a timer callback")


def check_size(size: int, what: str) -> None:
    """Raise OS_ERR_INVALID_SIZE for a size of 0 or one that exceeds any memory."""
    if not 0 < size < SIZE_MAX:
        raise OsalError(OS_ERR_INVALID_SIZE, f"invalid size of {what}: {size} bytes")


def _owner_name(owner: Any) -> str:
    return str(getattr(owner, "name", "system"))

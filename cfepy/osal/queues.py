"""OSAL message queues (OS_Queue*): bounded, first in, first out. A writer never waits.

Messages are bytes. Immutable ones are passed by reference, others are copied.
"""

from __future__ import annotations

from typing import NamedTuple

from cfepy.ids import OS_QUEUE_BASE
from cfepy.osal.core import DELETED, Core, OsObject, OsObjectTable, Setup, check_size
from cfepy.osal.limits import OS_PEND
from cfepy.rtos import Queue
from cfepy.status import OS_ERR_INVALID_SIZE, OS_QUEUE_FULL, OS_QUEUE_INVALID_SIZE, OsalError
from cfepy.units import NS_PER_MS

POINTER_BYTES = 8
"""Size of the messages of a pipe's queue: pointers to buffers."""


class QueueInfo(NamedTuple):
    """The result of `queue_get_info` (OS_queue_prop_t)."""

    name: str
    creator: int


class OsQueue(OsObject):
    """The record of a queue."""

    __slots__ = ("data_size", "queue")

    def __init__(self, name: str, queue: Queue, data_size: int) -> None:
        super().__init__(name)
        self.queue = queue
        self.data_size = data_size


class QueueApi(Core):
    """The OS_Queue* functions."""

    def __init__(self, setup: Setup) -> None:
        super().__init__(setup)
        self._queues: OsObjectTable[OsQueue] = self._table("queue", OS_QUEUE_BASE, setup.config.os_max_queues)
        self._find_queue = self._queues.lookup

    def queue_create(self, name: str, depth: int, data_size: int, flags: int = 0) -> int:
        """Make a queue (OS_QueueCreate).

        Args:
            name: unique among queues, at most 19 characters.
            depth: maximum number of waiting messages, 1 to OS_QUEUE_MAX_DEPTH. As on Linux, 0 is refused later than a
                larger number.
            data_size: largest message in bytes.
            flags: no effect, as in NASA's OSAL.

        Returns:
            The queue's id.

        Raises:
            OsalError: OS_ERR_NAME_TOO_LONG, OS_ERR_INVALID_SIZE, OS_QUEUE_INVALID_SIZE, OS_ERR_NAME_TAKEN,
                OS_ERR_NO_FREE_IDS or OS_ERROR.
        """
        if self._cost:
            self.kernel.charge(self._cost)
        self._queues.check_name(name)
        check_size(data_size, f"messages of queue {name}")
        if not 0 <= depth <= self.config.os_queue_max_depth:
            raise OsalError(
                OS_QUEUE_INVALID_SIZE,
                f"depth of queue {name} must be 1 to {self.config.os_queue_max_depth}, not {depth}",
            )
        if not depth:
            self._queues.refuse(name, f"queue {name} has no room for a message")
        record = OsQueue(name, Queue(self.kernel, depth, name), data_size)
        sizes = self._setup.sizes
        return self._register(self._queues, record, "queue", sizes.queue + depth * (sizes.queue_slot + data_size))

    def pipe_queue_create(self, name: str, depth: int) -> int:
        """Make the queue behind a pipe, whose messages the Software Bus keeps itself.

        It takes a place, an id and a name among the queues, as the queue that CFE_SB_CreatePipe makes. The bus books
        its memory.

        Args:
            name: the pipe's name.
            depth: maximum number of waiting messages.

        Returns:
            The queue's id.

        Raises:
            OsalError: OS_ERR_NAME_TAKEN or OS_ERR_NO_FREE_IDS.
        """
        return self._register(self._queues, OsQueue(name, Queue(self.kernel, depth, name), POINTER_BYTES), "queue", 0)

    def pipe_queue_delete(self, queue_id: int) -> None:
        """Delete the queue behind a pipe, if no task has deleted it before."""
        record = self._queues.lookup(queue_id)
        if record is not None:
            self._unregister(self._queues, record)

    def queue_delete(self, queue_id: int) -> None:
        """Delete a queue and its messages (OS_QueueDelete).

        Tasks that wait for a message wait on, to their time limit or forever, as on Linux. In a safe mission they get
        OS_ERR_INVALID_ID.

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        record = self._queue(queue_id)
        self._unregister(self._queues, record)
        if self.config.safe:
            record.queue.close(DELETED)
        else:
            record.queue.abandon()

    def queue_put(self, queue_id: int, data: bytes | bytearray | memoryview, flags: int = 0) -> None:
        """Add a message; never waits (OS_QueuePut).

        Raises:
            OsalError: OS_QUEUE_FULL; OS_QUEUE_INVALID_SIZE for a message larger than the queue's; OS_ERR_INVALID_SIZE
                for an empty one; OS_ERR_INVALID_ID.
        """
        size = len(data)
        if self._cost:
            self.kernel.charge(self._costs.of(size))
        record = self._find_queue(queue_id)
        if record is None:
            raise self._queues.missing(queue_id)
        if not 0 < size <= record.data_size:
            status = OS_QUEUE_INVALID_SIZE if size else OS_ERR_INVALID_SIZE
            raise OsalError(
                status, f"a message for queue {record.name} must have 1 to {record.data_size} bytes, not {size}"
            )
        if not record.queue.put(data if type(data) is bytes else bytes(data)):
            raise OsalError(OS_QUEUE_FULL, f"queue {record.name} holds {record.queue.depth} messages")

    def queue_get(self, queue_id: int, timeout_ms: int = OS_PEND, size: int | None = None) -> bytes | None:
        """Take the oldest message (OS_QueueGet).

        Args:
            queue_id: the queue.
            timeout_ms: OS_PEND (-1) waits without limit, OS_CHECK (0) does not wait.
            size: size of the caller's buffer in bytes; None for enough.

        Returns:
            The message, or None after the timeout.

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_QUEUE_INVALID_SIZE for a buffer smaller than the queue's messages may be.
        """
        record = self._find_queue(queue_id)
        if record is None:
            raise self._queues.missing(queue_id)
        if size is not None and size < record.data_size:
            raise OsalError(
                OS_QUEUE_INVALID_SIZE,
                f"a buffer for queue {record.name} must have at least {record.data_size} bytes, not {size}",
            )
        item = record.queue.get(timeout_ms * NS_PER_MS if timeout_ms > 0 else timeout_ms)
        if item:
            if self._cost:
                self.kernel.charge(self._costs.of(len(item)))
            return item  # type: ignore[no-any-return]  # queues hold bytes, the kernel's queue anything
        if item is DELETED:
            raise self._queues.gone(record)
        if self._cost:
            self.kernel.charge(self._cost)
        return None

    def queue_get_id_by_name(self, name: str) -> int:
        """Return the id of a named queue (OS_QueueGetIdByName).

        Raises:
            OsalError: OS_ERR_NAME_NOT_FOUND or OS_ERR_NAME_TOO_LONG.
        """
        return self._queues.named(name)

    def queue_get_info(self, queue_id: int) -> QueueInfo:
        """Return facts about a queue (OS_QueueGetInfo).

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        record = self._queue(queue_id)
        return QueueInfo(record.name, record.creator)

    def _queue(self, queue_id: int) -> OsQueue:
        record = self._find_queue(queue_id)
        if record is None:
            raise self._queues.missing(queue_id)
        return record

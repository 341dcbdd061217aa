"""OS_Queue*: message queues for C."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.extra.c.api.osal_values import BAD, NAMED, check_size, new_id, properties
from cfepy.osal import OS_CHECK, OS_PEND
from cfepy.status import OS_ERROR, OS_QUEUE_EMPTY, OS_QUEUE_TIMEOUT, OsalError

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime


def declare(api: Declarations, c: CRuntime) -> None:
    os, memory = c.handle.os, c.memory

    def create(name: str, depth: int, data_size: int, flags: int) -> int:
        return os.queue_create(name, depth, data_size, flags)

    def get(queue_id: int, data: int, size: int, size_copied: int, timeout: int) -> None:
        check_size(size)
        # A negative timeout other than OS_PEND is in the past, so it ends at once.
        message = os.queue_get(queue_id, timeout if timeout >= OS_PEND else OS_CHECK, size=size)
        memory.put_u64(size_copied, len(message) if message is not None else 0)
        if message is None:
            raise OsalError(OS_QUEUE_EMPTY if timeout == OS_CHECK else OS_QUEUE_TIMEOUT)
        memory.poke(data, message)

    def put(queue_id: int, data: int, size: int, flags: int) -> None:
        check_size(size)
        os.queue_put(queue_id, memory.peek(data, size), flags)

    api.add("OS_QueueCreate", "=4SQQI", new_id(create, OS_ERROR), BAD)
    api.add("OS_QueueDelete", "I", os.queue_delete)
    api.add("OS_QueueGet", "$IPQPi", get, BAD)
    api.add("OS_QueuePut", "$IPQI", put, BAD)
    api.add("OS_QueueGetIdByName", "$4S", os.queue_get_id_by_name, BAD)
    api.add("OS_QueueGetInfo", "$IP", properties(memory, NAMED, os.queue_get_info), BAD)

"""OS_Task*: OSAL's tasks for C.

As with NASA's OSAL, such a task belongs to no application: it goes on when an application ends.
"""

from __future__ import annotations

from struct import Struct
from typing import TYPE_CHECKING

from cfepy.extra.c.api.osal_values import BAD, new_id, properties
from cfepy.ids import OS_TASK_BASE, get_base
from cfepy.osal import NOBODY
from cfepy.status import OS_ERR_INVALID_ID, OS_ERR_NAME_NOT_FOUND, OS_ERROR, OsalError

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

TASK_INFO = Struct("<20sIQB7x")
"""OS_task_prop_t."""
SYSTEM_DATA = 8
"""Bytes of the operating system's handle of a task (pthread_t); here its id."""


def declare(api: Declarations, c: CRuntime) -> None:
    os, memory = c.handle.os, c.memory

    def create(name: str, entry: int, stack: int, size: int, priority: int, flags: int) -> int:
        def run() -> int:
            return c.run(entry, stack=stack, size=size)

        return os.task_create(name, run, size, priority, flags, owner=NOBODY, brings_stack=bool(stack))

    def set_priority(task_id: int, priority: int) -> None:
        os.task_set_priority(task_id, priority)

    def install_delete_handler(function: int) -> None:
        os.task_install_delete_handler((lambda: c.run(function)) if function else None)

    def find_by_system_data(data: int, size: int) -> int:
        if not data or size != SYSTEM_DATA:
            raise OsalError(BAD, f"invalid size of system data: {size} bytes")
        task_id = memory.u64(data)
        try:
            os.task_get_info(task_id)
        except OsalError as error:
            status = OS_ERR_NAME_NOT_FOUND if error.status == OS_ERR_INVALID_ID else error.status
            raise OsalError(status, f"unknown system data {task_id:#x}") from error
        return task_id

    def own_system_data() -> int:
        task_id = os.task_get_id()
        return task_id if get_base(task_id) == OS_TASK_BASE else 0

    api.add("OS_TaskCreate", "=4SPpQBI", new_id(create, OS_ERROR), BAD)
    api.add("OS_TaskDelete", "I", os.task_delete)
    api.add("OS_TaskExit", "", os.task_exit)
    api.add("OS_TaskInstallDeleteHandler", "p", install_delete_handler)
    api.add("OS_TaskDelay", "I", os.task_delay)
    api.add("OS_TaskSetPriority", "IB", set_priority)
    api.add("OS_TaskGetId", "", os.task_get_id)
    api.add("OS_TaskGetIdByName", "$4S", os.task_get_id_by_name, BAD)
    api.add("OS_TaskGetInfo", "$IP", properties(memory, TASK_INFO, os.task_get_info), BAD)
    api.add("OS_TaskFindIdBySystemData", "4pQ", find_by_system_data, BAD)
    api.add("pthread_self", "", own_system_data)

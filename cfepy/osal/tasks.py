"""OSAL tasks (OS_Task*): kernel tasks with an id, a name, a stack in the memory accounting, and a delete handler."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from cfepy.ids import OS_TASK_BASE
from cfepy.osal.core import Core, OsObject, OsObjectTable, Setup, check_size
from cfepy.osal.limits import OS_EVENT_TASK_STARTUP, OS_MAX_TASK_PRIORITY
from cfepy.rtos import Task, WaitList
from cfepy.status import (
    OS_ERR_INVALID_ARGUMENT,
    OS_ERR_INVALID_PRIORITY,
    OS_ERR_NAME_NOT_FOUND,
    OS_INVALID_POINTER,
    OsalError,
)
from cfepy.units import NS_PER_MS

LEAST_STACK = 16384
"""PTHREAD_STACK_MIN of Linux, in bytes."""


class TaskProperties(NamedTuple):
    """The result of `task_get_info` (OS_task_prop_t)."""

    name: str
    creator: int
    stack_size: int
    priority: int


class OsTask(OsObject):
    """The record of a task."""

    __slots__ = ("entry", "on_delete", "priority", "stack_size", "task")

    def __init__(self, name: str, entry: Callable[[], object], stack_size: int, priority: int) -> None:
        super().__init__(name)
        self.entry = entry
        self.stack_size = stack_size
        self.priority = priority
        self.on_delete: Callable[[], object] | None = None
        self.task: Task | None = None


class TaskApi(Core):
    """The OS_Task* functions."""

    def __init__(self, setup: Setup) -> None:
        super().__init__(setup)
        self._tasks: OsObjectTable[OsTask] = self._table("task", OS_TASK_BASE, setup.config.os_max_tasks)

    def task_create(
        self,
        name: str,
        entry: Callable[[], object],
        stack_size: int,
        priority: int,
        flags: int = 0,
        *,
        owner: Any = None,
        brings_stack: bool = False,
    ) -> int:
        """Start a task (OS_TaskCreate). A task more urgent than the caller runs before this call returns.

        Args:
            name: unique among tasks, at most 19 characters.
            entry: called without arguments; when it returns, the task ends.
            stack_size: size in bytes, accounted for if the board limits memory.
            priority: 0 (most urgent) to 255.
            flags: OS_FP_ENABLED or 0; no effect here.
            owner: the application that owns it; None takes the caller's owner. In cFE every task that OS_TaskCreate
                starts belongs to NOBODY: the end of an application does not end it, CFE_ES_GetAppID fails in it and in
                its children, and an exception in it resets the processor.
            brings_stack: the caller provides the memory of the stack; Linux requires at least 16 KiB.

        Returns:
            The task's id.

        Raises:
            OsalError: OS_INVALID_POINTER, OS_ERR_NAME_TOO_LONG, OS_ERR_INVALID_SIZE, OS_ERR_INVALID_PRIORITY,
                OS_ERR_NAME_TAKEN or OS_ERR_NO_FREE_IDS; OS_ERROR for a stack that is too small.
        """
        if self._cost:
            self.kernel.charge(self._cost)
        if not callable(entry):
            raise OsalError(OS_INVALID_POINTER, f"the entry point of task {name} must be callable")
        self._tasks.check_name(name)
        check_size(stack_size, f"stack of task {name}")
        _check_priority(priority)
        if brings_stack and stack_size < LEAST_STACK:
            self._tasks.refuse(name, f"the stack of task {name} must have more than {stack_size} bytes")
        record = OsTask(name, entry, stack_size, priority)
        task_id = self._register(self._tasks, record, "stack", stack_size + self._setup.sizes.task, owner)
        record.task = self.kernel.spawn(name, lambda: self._live(record), priority, owner)
        return task_id

    def task_delete(self, task_id: int) -> None:
        """End a task and call its delete handler; objects that it created stay (OS_TaskDelete).

        The call does not return to a task that deletes itself. While the task waits for a mutex or a readers-writer
        lock, the caller waits: the task ends in its first wait of another kind after that, as a canceled thread of
        Linux does. In a safe mission it ends at once.

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        record = self._task(task_id)
        task = record.task
        if task is not None and task is not self.kernel.current:
            if self._is_strict and task.waits is not None and not task.waits.is_cancelable:
                self._join(task)
            self.kernel.kill(task)
        self._forget(record)
        self._call_delete_handler(record)
        if task is self.kernel.current:
            self.kernel.exit_task()

    def _join(self, task: Task) -> None:
        """Wait until a task that waits for a lock has got it, and waits for something else or has ended."""
        kernel = self.kernel
        while not task.done:
            if task.waits is not None and not task.waits.is_cancelable:
                if task.joiners is None:
                    task.joiners = WaitList(f"the end of task {task.name}")
                    task.joiners.holders = lambda: (task,)
                    task.joiners.is_cancelable = False
                kernel.wait_on(task.joiners)
            elif kernel.is_waiting(task):
                return
            else:
                kernel.delay(1)  # all tasks that are ready run before time passes

    def task_exit(self) -> None:
        """End the calling task; its delete handler is not called (OS_TaskExit)."""
        self.kernel.exit_task()

    def task_install_delete_handler(self, handler: Callable[[], object] | None) -> None:
        """Call `handler` when another task deletes the calling one (OS_TaskInstallDeleteHandler).

        Raises:
            OsalError: OS_ERR_INVALID_ID if the caller is not an OSAL task.
        """
        self._task(self.task_get_id()).on_delete = handler

    def task_delay(self, milliseconds: int) -> None:
        """Sleep (OS_TaskDelay). With 0 ms tasks of the same priority can run, and less urgent ones cannot.

        Raises:
            OsalError: OS_ERR_INVALID_ARGUMENT for a negative time.
        """
        if self._cost:
            self.kernel.charge(self._cost)
        if milliseconds < 0:
            raise OsalError(OS_ERR_INVALID_ARGUMENT, f"invalid delay: {milliseconds} ms")
        if milliseconds:
            self.kernel.delay(milliseconds * NS_PER_MS)
        else:
            self.kernel.delay_nothing(self._costs.polling_ns)

    def task_set_priority(self, task_id: int, priority: int) -> None:
        """Change a task's priority (OS_TaskSetPriority).

        Raises:
            OsalError: OS_ERR_INVALID_ID or OS_ERR_INVALID_PRIORITY.
        """
        if self._cost:
            self.kernel.charge(self._cost)
        _check_priority(priority)
        record = self._task(task_id)
        record.priority = priority
        if record.task is not None:
            self.kernel.set_priority(record.task, priority)

    def task_get_id(self) -> int:
        """Return the id of the calling task, of the time base in a timer callback, or 0 for any other caller
        (OS_TaskGetId).
        """
        return self._task_ids.get(self.kernel.current, 0)

    def task_get_id_by_name(self, name: str) -> int:
        """Return the id of a named task (OS_TaskGetIdByName).

        Raises:
            OsalError: OS_ERR_NAME_NOT_FOUND or OS_ERR_NAME_TOO_LONG.
        """
        return self._tasks.named(name)

    def task_get_info(self, task_id: int) -> TaskProperties:
        """Return facts about a task (OS_TaskGetInfo).

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        record = self._task(task_id)
        return TaskProperties(record.name, record.creator, record.stack_size, record.priority)

    def task_find_id_by_system_data(self, system_data: Task) -> int:
        """Return the id of the OSAL task that a kernel task runs (OS_TaskFindIdBySystemData).

        Raises:
            OsalError: OS_ERR_NAME_NOT_FOUND if there is none.
        """
        for task_id, record in self._tasks.items():
            if record.task is system_data:
                return task_id
        raise OsalError(OS_ERR_NAME_NOT_FOUND, f"{system_data!r} is not an OSAL task")

    def _task(self, task_id: int) -> OsTask:
        record = self._tasks.lookup(task_id)
        if record is None:
            raise self._tasks.missing(task_id)
        return record

    def _live(self, record: OsTask) -> None:
        """Run an OSAL task from start to end."""
        record.task = task = self.kernel.current
        self._task_ids[task] = task.number = record.id
        self._notify(OS_EVENT_TASK_STARTUP, record.id)
        try:
            record.entry()
        finally:
            self._forget(record)

    def _call_delete_handler(self, record: OsTask) -> None:
        """Call the delete handler; an error in it belongs to its application and does not stop further deletions."""
        if record.on_delete is None:
            return
        try:
            record.on_delete()
        except Exception as error:
            if record.task is None or not self.kernel.on_task_error(record.task, error):
                raise

    def _forget(self, record: OsTask) -> None:
        if record.deleted:
            return
        self._unregister(self._tasks, record)
        if record.task is not None:
            self._task_ids.pop(record.task, None)


def _check_priority(priority: int) -> None:
    if not 0 <= priority <= OS_MAX_TASK_PRIORITY:
        raise OsalError(OS_ERR_INVALID_PRIORITY, f"priority must be 0 to {OS_MAX_TASK_PRIORITY}, not {priority}")

"""Tasks that an application starts beside its main task (CFE_ES_*ChildTask)."""

from __future__ import annotations

from collections.abc import Callable

from cfepy.es.app_end import AppEnd
from cfepy.es.info import InfoApi
from cfepy.status import (
    CFE_ES_BAD_ARGUMENT,
    CFE_ES_ERR_CHILD_TASK_CREATE,
    CFE_ES_ERR_CHILD_TASK_DELETE_MAIN_TASK,
    CFE_ES_ERR_RESOURCEID_NOT_VALID,
    CfeError,
)


class ChildTaskApi(InfoApi, AppEnd):
    """The life of child tasks."""

    def create_child_task(
        self, name: str, entry: Callable[[], object], stack_size: int, priority: int, flags: int = 0
    ) -> int:
        """Start a task that belongs to the calling application (CFE_ES_CreateChildTask).

        Args:
            name: unique, 1 to 19 characters.
            entry: called without arguments, at least 50 ms later.
            stack_size: bytes.
            priority: 0 (most urgent) to 255.
            flags: not used.

        Returns:
            The TaskId.

        Raises:
            CfeError: CFE_ES_BAD_ARGUMENT (no name, no function), CFE_ES_ERR_RESOURCEID_NOT_VALID (the caller belongs
                to no application), CFE_ES_ERR_CHILD_TASK_CREATE (called by a child task),
                CFE_STATUS_EXTERNAL_RESOURCE_FAIL (OSAL cannot create it).
        """
        self._check_child(name, entry)
        app = self.app_of_caller()
        if app is None:
            self.write_to_sys_log(f"CFE_ES_CreateChildTask: Invalid calling context when creating Task '{name}'")
            raise CfeError(CFE_ES_ERR_RESOURCEID_NOT_VALID, f"child task {name!r} needs an application")
        if self.osal.task_get_id() != app.main_task_id:
            self.write_to_sys_log(f"CFE_ES_CreateChildTask: Error: Cannot call from a Child Task (for Task '{name}').")
            raise CfeError(CFE_ES_ERR_CHILD_TASK_CREATE, "only the main task of an application creates child tasks")
        return self.start_task(app, name, entry, stack_size, priority)

    def _check_child(self, name: str, entry: Callable[[], object]) -> None:
        if not name:
            text = "TaskName Parameter is NULL"
        elif not callable(entry):
            text = f"Function Pointer Parameter is NULL for Task '{name}'"
        else:
            return
        self.write_to_sys_log(f"CFE_ES_CreateChildTask: {text}")
        raise CfeError(CFE_ES_BAD_ARGUMENT, f"a child task needs a name and a function, not {name!r} and {entry!r}")

    def delete_child_task(self, task_id: int) -> None:
        """End a child task (CFE_ES_DeleteChildTask).

        Raises:
            CfeError: CFE_ES_ERR_RESOURCEID_NOT_VALID, CFE_ES_ERR_CHILD_TASK_DELETE_MAIN_TASK.
        """
        log = self.write_to_sys_log
        try:
            self.task_id_to_index(task_id)
        except CfeError:
            log(f"CFE_ES_DeleteChildTask: Error: Invalid Task ID: {task_id}")
            raise
        try:
            app, _ = self.find_task(task_id)
        except CfeError:
            log(f"CFE_ES_DeleteChildTask: Error: Task ID is not active: {task_id}")
            raise
        if task_id == app.main_task_id:
            log(f"CFE_ES_DeleteChildTask: Error: Task {task_id} is a cFE Main Task.")
            raise CfeError(CFE_ES_ERR_CHILD_TASK_DELETE_MAIN_TASK, f"task {task_id} is the main task of {app.name}")
        self.end_task(app, task_id)
        log(f"CFE_ES_DeleteChildTask: Task {task_id} Deleted")

    def exit_child_task(self) -> None:
        """End the calling child task; does not return (CFE_ES_ExitChildTask). A main task goes on, with a log entry."""
        app = self.app_of_caller()
        task_id = self.osal.task_get_id()
        if app is None:
            self.write_to_sys_log("CFE_ES_ExitChildTask: Called from invalid task context")
            return
        if task_id == app.main_task_id:
            self.write_to_sys_log(f"CFE_ES_ExitChildTask: Error: Cannot Call from a cFE App Main Task. ID = {task_id}")
            return
        record = app.tasks.pop(task_id, None)
        if record is not None and record.task is not None:
            self.history_of(app.name).cpu_ns += record.task.cpu_ns
        self.osal.task_exit()

"""Lookups: ids, names and properties of applications, libraries and tasks (CFE_ES_Get*)."""

from __future__ import annotations

from cfepy import ids
from cfepy.es.records import CORE, EXTERNAL, LIBRARY, AppInfo, AppRecord, LibRecord, TaskInfo, TaskRecord
from cfepy.es.tables import EsCore
from cfepy.status import (
    CFE_ES_ERR_NAME_NOT_FOUND,
    CFE_ES_ERR_RESOURCEID_NOT_VALID,
    CfeError,
    OsalError,
)


class InfoApi(EsCore):
    """The query functions of Executive Services."""

    # -- the caller ----------------------------------------------------------------------------------------------------

    def get_app_id(self) -> int:
        """Return the AppId of the calling application (CFE_ES_GetAppID); raises CFE_ES_ERR_RESOURCEID_NOT_VALID."""
        return self.calling_app().app_id

    def get_task_id(self) -> int:
        """Return the TaskId of the calling task (CFE_ES_GetTaskID); raises CFE_ES_ERR_RESOURCEID_NOT_VALID."""
        return self.find_task(self.osal.task_get_id())[1].task_id

    # -- names and ids ---------------------------------------------------------------------------------------------

    def get_app_id_by_name(self, name: str) -> int:
        """Return the AppId of a named application (CFE_ES_GetAppIDByName); raises CFE_ES_ERR_NAME_NOT_FOUND."""
        return self.require_app_named(name).app_id

    def get_app_name(self, app_id: int) -> str:
        """Return the name of an application (CFE_ES_GetAppName); raises CFE_ES_ERR_RESOURCEID_NOT_VALID."""
        return self.app(app_id).name

    def get_lib_id_by_name(self, name: str) -> int:
        """Return the LibId of a named library (CFE_ES_GetLibIDByName); raises CFE_ES_ERR_NAME_NOT_FOUND."""
        for lib in self.libs:
            if lib.name == name:
                return lib.lib_id
        raise CfeError(CFE_ES_ERR_NAME_NOT_FOUND, f"unknown library {name!r}")

    def get_lib_name(self, lib_id: int) -> str:
        """Return the name of a library (CFE_ES_GetLibName); raises CFE_ES_ERR_RESOURCEID_NOT_VALID."""
        return self.libs.get(lib_id).name

    def get_task_id_by_name(self, name: str) -> int:
        """Return the TaskId of a named task (CFE_ES_GetTaskIDByName); raises CFE_ES_ERR_NAME_NOT_FOUND."""
        try:
            return self.osal.task_get_id_by_name(name)
        except OsalError as error:
            raise CfeError(CFE_ES_ERR_NAME_NOT_FOUND, f"unknown task {name!r}") from error

    def get_task_name(self, task_id: int) -> str:
        """Return the name of a task, or of any OSAL object (CFE_ES_GetTaskName); raises
        CFE_ES_ERR_RESOURCEID_NOT_VALID.
        """
        try:
            return self.osal.get_resource_name(task_id)
        except OsalError as error:
            raise CfeError(CFE_ES_ERR_RESOURCEID_NOT_VALID, f"invalid task id 0x{task_id:x}") from error

    # -- ids as indices --------------------------------------------------------------------------------------------

    def app_id_to_index(self, app_id: int) -> int:
        """Return the index of an application, counted from 0, for arrays with a place for each (CFE_ES_AppID_ToIndex).

        Raises:
            CfeError: CFE_ES_ERR_RESOURCEID_NOT_VALID if it is not the id of an application; the application need not
                exist.
        """
        return ids.to_index(app_id, ids.ES_APPID_BASE, self.apps.capacity)

    def lib_id_to_index(self, lib_id: int) -> int:
        """Return the index of a library; see `app_id_to_index` (CFE_ES_LibID_ToIndex)."""
        return ids.to_index(lib_id, ids.ES_LIBID_BASE, self.libs.capacity)

    def task_id_to_index(self, task_id: int) -> int:
        """Return the index of a task; see `app_id_to_index` (CFE_ES_TaskID_ToIndex)."""
        return ids.to_index(task_id, ids.ES_TASKID_BASE, self.config.os_max_tasks)

    # -- properties ---------------------------------------------------------------------------------------------------

    def get_app_info(self, app_id: int) -> AppInfo:
        """Return the properties of an application (CFE_ES_GetAppInfo); raises CFE_ES_ERR_RESOURCEID_NOT_VALID."""
        app = self.apps.find(app_id)
        if app is None:
            self.write_to_sys_log(f"CFE_ES_GetAppInfo: App ID not active: {app_id}")
            return _describe_app(self.app(app_id))
        return _describe_app(app)

    def get_lib_info(self, lib_id: int) -> AppInfo:
        """Return the properties of a library (CFE_ES_GetLibInfo); raises CFE_ES_ERR_RESOURCEID_NOT_VALID."""
        lib = self.libs.find(lib_id)
        if lib is None:
            self.write_to_sys_log(f"CFE_ES_GetLibInfo: Lib ID not active: {lib_id}")
            return _describe_lib(self.libs.get(lib_id))
        return _describe_lib(lib)

    def get_module_info(self, resource_id: int) -> AppInfo:
        """Return the properties of an application or a library (CFE_ES_GetModuleInfo); raises
        CFE_ES_ERR_RESOURCEID_NOT_VALID.
        """
        base = ids.get_base(resource_id)
        if base == ids.ES_APPID_BASE:
            return self.get_app_info(resource_id)
        if base == ids.ES_LIBID_BASE:
            return self.get_lib_info(resource_id)
        self.write_to_sys_log(f"CFE_ES_GetModuleInfo: Resource ID not valid: {resource_id}")
        raise CfeError(CFE_ES_ERR_RESOURCEID_NOT_VALID, f"0x{resource_id:x} is not an AppId or a LibId")

    def get_task_info(self, task_id: int) -> TaskInfo:
        """Return the properties of a task (CFE_ES_GetTaskInfo); raises CFE_ES_ERR_RESOURCEID_NOT_VALID."""
        try:
            app, record = self.find_task(task_id)
        except CfeError:
            self.write_to_sys_log(f"CFE_ES_GetTaskInfo: Task ID Not Active: {task_id}")
            raise
        return _describe_task(app, record)

    def modules(self) -> list[AppInfo]:
        """Return all applications, then all libraries, in the order of their slots."""
        return [_describe_app(app) for app in self.apps] + [_describe_lib(lib) for lib in self.libs]

    def tasks(self) -> list[TaskInfo]:
        """Return all tasks of applications, in the order of their slots."""
        found = [_describe_task(app, record) for app in self.apps for record in app.tasks.values()]
        return sorted(found, key=lambda task: self.task_id_to_index(task.task_id))

    def increment_task_counter(self) -> None:
        """Count a cycle of the calling task (CFE_ES_IncrementTaskCounter)."""
        app = self.app_of_caller()
        record = app.tasks.get(self.osal.task_get_id()) if app is not None else None
        if record is not None:
            record.execution_counter += 1


def _describe_app(app: AppRecord) -> AppInfo:
    params, main = app.params, app.tasks.get(app.main_task_id)
    return AppInfo(
        app.app_id,
        CORE if app.is_core else EXTERNAL,
        app.name,
        params.symbol,
        params.file,
        params.stack_size,
        params.exception_action,
        params.priority,
        app.main_task_id,
        main.name if main is not None else "",
        main.execution_counter if main is not None else 0,
        max(0, len(app.tasks) - 1),
    )


def _describe_lib(lib: LibRecord) -> AppInfo:
    return AppInfo(lib.lib_id, LIBRARY, lib.name, lib.symbol, lib.file)


def _describe_task(app: AppRecord, task: TaskRecord) -> TaskInfo:
    return TaskInfo(
        task.task_id, task.name, app.app_id, app.name, task.stack_size, task.priority, task.execution_counter
    )

"""Applications and libraries: loading, starting, requests to end, and the end itself (cfe_es_apps.c).

An application that ends releases its resources. It can be started again.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from typing import TypeVar

from cfepy.es import events as ev
from cfepy.es.records import (
    APP_ERROR,
    APP_EXIT,
    APP_RUN,
    CORE_APP_INIT_ERROR,
    CORE_APP_RUNTIME_ERROR,
    RUNNING,
    STOPPED,
    SYS_DELETE,
    SYS_EXCEPTION,
    SYS_RELOAD,
    SYS_RESTART,
    AppRecord,
    Entry,
    LibRecord,
    StartParams,
    TaskRecord,
)
from cfepy.es.resets import ResetApi
from cfepy.ids import (
    OS_BINSEM_BASE,
    OS_COUNTSEM_BASE,
    OS_MUTEX_BASE,
    OS_QUEUE_BASE,
    OS_TASK_BASE,
    OS_TIMECB_BASE,
    get_base,
    name_size,
)
from cfepy.osal import OS_MAX_API_NAME
from cfepy.ports import Cleanup
from cfepy.psp import RST_TYPE_PROCESSOR
from cfepy.status import (
    CFE_ES_APP_CLEANUP_ERR,
    CFE_ES_BAD_ARGUMENT,
    CFE_ES_BIN_SEM_DELETE_ERR,
    CFE_ES_COUNT_SEM_DELETE_ERR,
    CFE_ES_ERR_CHILD_TASK_DELETE,
    CFE_ES_ERR_DUPLICATE_NAME,
    CFE_ES_ERR_RESOURCEID_NOT_VALID,
    CFE_ES_FILE_IO_ERR,
    CFE_ES_MUT_SEM_DELETE_ERR,
    CFE_ES_NO_RESOURCE_IDS_AVAILABLE,
    CFE_ES_QUEUE_DELETE_ERR,
    CFE_ES_TIMER_DELETE_ERR,
    CFE_STATUS_EXTERNAL_RESOURCE_FAIL,
    CfeError,
    OsalError,
)

MAX_NAME = OS_MAX_API_NAME - 1
NO_SYMBOLS = ("", "NULL")
MOST_OBJECTS = 0xFFFF_FFFF
Loaded = TypeVar("Loaded")
# The words of each request's event, and the event ids for success, for a failed new start and for a failed cleanup.
_REPORTS = {
    APP_EXIT: ("Exit", ev.EXIT_APP_INF_EID, ev.EXIT_APP_ERR_EID, ev.EXIT_APP_ERR_EID),
    APP_ERROR: ("Exit", ev.ERREXIT_APP_INF_EID, ev.ERREXIT_APP_ERR_EID, ev.ERREXIT_APP_ERR_EID),
    SYS_DELETE: ("Stop", ev.STOP_INF_EID, ev.STOP_ERR3_EID, ev.STOP_ERR3_EID),
    SYS_RESTART: ("Restart", ev.RESTART_APP_INF_EID, ev.RESTART_APP_ERR3_EID, ev.RESTART_APP_ERR4_EID),
    SYS_RELOAD: ("Reload", ev.RELOAD_APP_INF_EID, ev.RELOAD_APP_ERR3_EID, ev.RELOAD_APP_ERR4_EID),
}
_CLEANUP_ERRORS = {
    OS_TASK_BASE: CFE_ES_ERR_CHILD_TASK_DELETE,
    OS_QUEUE_BASE: CFE_ES_QUEUE_DELETE_ERR,
    OS_COUNTSEM_BASE: CFE_ES_COUNT_SEM_DELETE_ERR,
    OS_BINSEM_BASE: CFE_ES_BIN_SEM_DELETE_ERR,
    OS_MUTEX_BASE: CFE_ES_MUT_SEM_DELETE_ERR,
    OS_TIMECB_BASE: CFE_ES_TIMER_DELETE_ERR,
}
"""The status for an object that cannot be deleted, by its kind; for other kinds CFE_ES_APP_CLEANUP_ERR."""


def _no_init(lib_id: int) -> None:
    """Replace the init function of a library without one."""


class SymbolError(OsalError):
    """Exception for a module without an entry point of the given name."""


class AppServices(ResetApi):
    """The start of applications, and the requests for their end."""

    # -- starting --------------------------------------------------------------------------------------------------

    def create_app(self, name: str, params: StartParams, entry: Entry | None = None) -> int:
        """Load and start an application (CFE_ES_AppCreate).

        Args:
            name: at most 19 characters.
            params: the other fields of its line in the startup script.
            entry: for a core application, its main function; otherwise the loader finds it.

        Returns:
            The AppId.

        Raises:
            CfeError: CFE_ES_BAD_ARGUMENT (name), CFE_ES_ERR_DUPLICATE_NAME, CFE_ES_NO_RESOURCE_IDS_AVAILABLE,
                CFE_STATUS_EXTERNAL_RESOURCE_FAIL (the module cannot be loaded).
        """
        self._check_new_app(name)
        record = AppRecord(name, params, entry, is_core=entry is not None)
        record.app_id = self.apps.create(record)  # this comes first: as in C, a failed start uses up an id
        try:
            if entry is None:
                record.module_id, record.entry = self._load(
                    name,
                    params.file,
                    params.symbol,
                    lambda: self.loader.load(params.file, params.symbol, name),
                    lambda: None,
                )
            record.main_task_id = self.start_task(
                record, name, self._main_of(record), params.stack_size, params.priority
            )
        except CfeError as failure:
            self.apps.delete(record.app_id)
            self._unload_module(record.module_id)
            self._explain(failure)
            raise
        self.history_of(name)
        return record.app_id

    def _check_new_app(self, name: str) -> None:
        if name_size(name) > MAX_NAME:
            raise CfeError(CFE_ES_BAD_ARGUMENT, f"application name {name!r} must have at most {MAX_NAME} characters")
        if self.app_named(name) is not None:
            self.write_to_sys_log(f"CFE_ES_AppCreate: Duplicate app name '{name}'")
            raise CfeError(CFE_ES_ERR_DUPLICATE_NAME, f"application {name!r} is already running")
        if len(self.apps) >= self.apps.capacity:
            self.write_to_sys_log("CFE_ES_AppCreate: No free application slots available")
            raise CfeError(
                CFE_ES_NO_RESOURCE_IDS_AVAILABLE, f"the limit of {self.apps.capacity} applications is reached"
            )

    def _explain(self, failure: CfeError) -> None:
        """Print details about a failure, if there are any: the users of the board's memory."""
        if "\n" in failure.text:
            self.console.write(failure.text)

    def load_library(self, name: str, file: str, symbol: str) -> int:
        """Load a library and call its init function (CFE_ES_LoadLibrary).

        Returns:
            The LibId.

        Raises:
            CfeError: CFE_ES_BAD_ARGUMENT, CFE_ES_ERR_DUPLICATE_NAME, CFE_ES_NO_RESOURCE_IDS_AVAILABLE,
                CFE_STATUS_EXTERNAL_RESOURCE_FAIL (cannot be loaded) or the status of the init function.
        """
        self._check_new_library(name)
        record = LibRecord(name, file, symbol)
        record.lib_id = self.libs.create(record)
        try:
            self._init_library(record)
        except CfeError:
            self.libs.delete(record.lib_id)
            raise
        return record.lib_id

    def _check_new_library(self, name: str) -> None:
        if name_size(name) > MAX_NAME:
            raise CfeError(CFE_ES_BAD_ARGUMENT, f"library name {name!r} must have at most {MAX_NAME} characters")
        if any(lib.name == name for lib in self.libs) or self.app_named(name) is not None:
            self.write_to_sys_log(f"CFE_ES_LoadLibrary: Duplicate Lib name '{name}'")
            raise CfeError(
                CFE_ES_ERR_DUPLICATE_NAME, f"the name {name!r} is already used by a library or an application"
            )
        if len(self.libs) >= self.libs.capacity:
            self.write_to_sys_log("CFE_ES_LoadLibrary: No free library slots available")
            raise CfeError(CFE_ES_NO_RESOURCE_IDS_AVAILABLE, f"the limit of {self.libs.capacity} libraries is reached")

    def _init_library(self, lib: LibRecord) -> None:
        lib.module_id, init = self._load(
            lib.name, lib.file, lib.symbol, lambda: self.loader.load_library(lib.file, lib.symbol), lambda: _no_init
        )
        result = init(lib.lib_id)
        if isinstance(result, int) and result != 0:
            self._unload_module(lib.module_id)
            self.write_to_sys_log(f"CFE_ES_LoadLibrary: Load Shared Library Init Error = 0x{result & 0xFFFFFFFF:08x}")
            raise CfeError(result, f"init function of library {lib.name!r} returned {result}")

    def _load(
        self, name: str, file: str, symbol: str, load: Callable[[], Loaded], nameless: Callable[[], Loaded]
    ) -> tuple[int, Loaded]:
        """Load the code of an application or library, which takes a place among OSAL's modules (CFE_ES_LoadModule).

        Args:
            name: its name, which is also the module's.
            file: virtual path of the code.
            symbol: name of the entry point.
            load: returns the entry point.
            nameless: returns the entry point if the symbol is one of `NO_SYMBOLS`.

        Returns:
            The module's id and the entry point.
        """
        module_id = 0
        error: OsalError
        try:
            module_id = self.osal.module_reserve(name, file)
            return module_id, load()
        except SymbolError as missing:
            if symbol in NO_SYMBOLS:  # these names are not looked up
                return module_id, nameless()
            text, error = f"find symbol:{missing.text}. EC = {missing.status}", missing
        except OsalError as missing:
            text, error = f"load file:{file}. EC = {missing.status}", missing
        self._unload_module(module_id)
        self.write_to_sys_log(f"CFE_ES_LoadModule: Could not {text}")
        raise CfeError(CFE_STATUS_EXTERNAL_RESOURCE_FAIL, str(error)) from error

    def _unload_module(self, module_id: int) -> None:
        if module_id:
            with suppress(OsalError):  # a task has unloaded it before
                self.osal.module_unload(module_id)

    def start_task(self, app: AppRecord, name: str, entry: Entry, stack_size: int, priority: int) -> int:
        """Start a task of an application; its entry runs after NASA's start delay of 50 ms (CFE_ES_StartAppTask).

        Raises:
            CfeError: CFE_STATUS_EXTERNAL_RESOURCE_FAIL if OSAL cannot create it.
        """
        record = TaskRecord(0, name, stack_size, priority)

        def run() -> None:
            record.task = self.kernel.current
            self.osal.task_delay(self.config.es_startup_sync_poll_ms)
            entry()

        try:
            record.task_id = self.osal.task_create(name, run, stack_size, priority, owner=app)
        except CfeError as failure:
            self.write_to_sys_log(
                f"CFE_ES_StartAppTask: AppCreate Error: TaskCreate {name} Failed. EC = {failure.status}!"
            )
            raise CfeError(CFE_STATUS_EXTERNAL_RESOURCE_FAIL, failure.text) from failure
        app.tasks[record.task_id] = record
        return record.task_id

    def _main_of(self, app: AppRecord) -> Entry:
        def main() -> None:
            if app.entry is None:  # NASA's task waits for its function, and ends silently
                self.osal.task_delay(self.config.es_startup_script_timeout_ms)
                return
            app.entry()
            self.exit_app(APP_EXIT)  # in C the task would end without notice to ES

        return main

    # -- ending ----------------------------------------------------------------------------------------------------

    def exit_app(self, status: int = APP_EXIT) -> None:
        """End the calling application; does not return (CFE_ES_ExitApp).

        Args:
            status: the reason, one of APP_*, SYS_*, CORE_APP_*. A core application cannot end itself; only the last two
                have an effect for it.
        """
        app = self.calling_app()
        if not APP_RUN <= status <= CORE_APP_RUNTIME_ERROR:
            self.write_to_sys_log(f"CFE_ES_ExitApp: Called with invalid status ({status}).")
            status = APP_ERROR
        if app.control_request == APP_RUN:
            app.control_request = status  # keep a pending request
            if status == APP_ERROR:
                self.history_of(app.name).failed_ns = self.kernel.now
        if app.is_core:
            self._exit_core(app, status)
            return
        self.write_to_sys_log(f"CFE_ES_ExitApp: Application {app.name} called CFE_ES_ExitApp")
        app.state = STOPPED
        while True:  # until the background scan deletes the application together with this task
            self.osal.task_delay(500)

    def _exit_core(self, app: AppRecord, status: int) -> None:
        if status == CORE_APP_INIT_ERROR:
            self.write_to_sys_log(f"CFE_ES_ExitApp: CORE Application {app.name} Had an Init Error.")
            self.reset_cfe(RST_TYPE_PROCESSOR)
        elif status == CORE_APP_RUNTIME_ERROR:
            self.write_to_sys_log(f"CFE_ES_ExitApp: CORE Application {app.name} Had a Runtime Error.")
            self.osal.task_exit()
        else:
            self.write_to_sys_log(f"CFE_ES_ExitApp: Cannot Exit CORE Application {app.name}")

    def restart_app(self, app_id: int) -> None:
        """Request a cleanup and a new start of an application (CFE_ES_RestartApp).

        Raises:
            CfeError: CFE_ES_ERR_RESOURCEID_NOT_VALID (no such application, a core application, not running),
                CFE_ES_FILE_IO_ERR (its file no longer exists).
        """
        app = self._user_app(app_id, "Restart")
        self._require_file(app, app.params.file, "Restart")
        self.write_to_sys_log(f"CFE_ES_RestartApp: Restart Application {app.name} Initiated")
        app.control_request = SYS_RESTART

    def reload_app(self, app_id: int, file: str) -> None:
        """Request a new start of an application from another file; see `restart_app` (CFE_ES_ReloadApp).

        Args:
            app_id: the application.
            file: cFE's name of the module, "/cf/hk.so".
        """
        app = self._user_app(app_id, "Reload")
        self._require_file(app, file, "Reload")
        self.write_to_sys_log(f"CFE_ES_ReloadApp: Reload Application {app.name} Initiated. New filename = {file}")
        app.params.file = file
        app.control_request = SYS_RELOAD

    def delete_app(self, app_id: int) -> None:
        """Request the end and cleanup of an application (CFE_ES_DeleteApp).

        Raises:
            CfeError: CFE_ES_ERR_RESOURCEID_NOT_VALID (no such application, a core application, not running).
        """
        app = self._user_app(app_id, "Delete")
        self.write_to_sys_log(f"CFE_ES_DeleteApp: Delete Application {app.name} Initiated")
        app.control_request = SYS_DELETE

    def _user_app(self, app_id: int, action: str) -> AppRecord:
        """Return a running application that is not a core application (CFE_ES_LockUserAppRecord)."""
        app = self.apps.find(app_id)
        if app is None:
            text = f"Invalid Application ID received for {action}, AppID = {app_id}"
        elif app.is_core:
            text = f"Cannot {action} a CORE Application: {app.name}."
        elif app.state != RUNNING:
            text = f"Cannot {action} Application {app.name}, It is not running."
        else:
            return app
        self.write_to_sys_log(f"CFE_ES_LockUserAppRecord: {text}")
        raise CfeError(CFE_ES_ERR_RESOURCEID_NOT_VALID, text)

    def _require_file(self, app: AppRecord, file: str, action: str) -> None:
        if not self.loader.exists(file):
            self.write_to_sys_log(
                f"CFE_ES_{action}App: Cannot {action} Application {app.name}, File {file} does not exist."
            )
            raise CfeError(CFE_ES_FILE_IO_ERR, f"{file} does not exist")


class AppEnd(AppServices):
    """Cleaning up."""

    def process_control_request(self, app: AppRecord) -> None:
        """Clean up an application, start it again if requested, and report it (CFE_ES_ProcessControlRequest)."""
        request = app.control_request
        history = self.history_of(app.name)
        history.error_exits += request == APP_ERROR
        is_clean = self.cleanup_app(app)
        if request not in _REPORTS:
            self._report_odd_request(app.name, request)
            return
        action, event, not_started, not_clean = _REPORTS[request]
        detail, kind = "Completed.", ev.INFORMATION
        if not is_clean:
            event, kind = not_clean, ev.ERROR
            detail = f"Failed: CleanUpApp Error 0x{CFE_ES_APP_CLEANUP_ERR & 0xFFFFFFFF:08X}."
        if request in (SYS_RESTART, SYS_RELOAD):
            try:
                app_id = self.create_app(app.name, app.params)
                history.restarts += 1
                if is_clean:
                    detail = f"Completed, AppID={app_id}"
            except CfeError as failure:
                event, kind = not_started if is_clean else not_clean, ev.ERROR
                detail = f"Failed: AppCreate Error {failure.hex}."
        self.ports.evs.send_event(event, kind, f"{action} Application {app.name} {detail}")

    def _report_odd_request(self, name: str, request: int) -> None:
        if request == SYS_EXCEPTION:
            event, text = ev.PCR_ERR1_EID, f"ES_ProcControlReq: Invalid State Application {name} EXCEPTION"
        else:
            event, text = ev.PCR_ERR2_EID, f"ES_ProcControlReq: Unknown State Application {name} ( {request} )"
        self.ports.evs.send_event(event, ev.ERROR, text)

    def cleanup_app(self, app: AppRecord) -> bool:
        """End an application's tasks and release its resources (CFE_ES_CleanUpApp).

        The objects of a task are deleted before the task, as in NASA's ES. An object that cannot be deleted stays, with
        its name: a mutex that a task holds, a socket at which a task waits. In a safe mission the tasks end first, and
        nothing stays. The same holds for a ROS node, which is a process of its own on a robot.

        Returns:
            Whether everything was released.
        """
        main, others = app.main_task_id, [each for each in app.tasks if each != app.main_task_id]
        if self.config.safe or app.is_node:
            for task_id in (*others, main):
                self.end_task(app, task_id)
            self._end_other_tasks(app)
            self._clean_up_services(app)
            self.osal.delete_objects_of(app)
            statuses = [0]
        else:
            self._clean_up_services(app)
            statuses = [self._clean_up_task(app, task_id) for task_id in (main, *others)]
            self._end_other_tasks(app)
        self._release_pools(app)
        self._unload_module(app.module_id)
        self.apps.delete(app.app_id)
        self.loader.unload(app.name)
        return not any(statuses)

    def _clean_up_services(self, app: AppRecord) -> None:
        ports = self.ports
        services: dict[str, Cleanup] = {"EVS": ports.evs, "SB": ports.sb, "TBL": ports.tbl, "TIME": ports.time}
        for name in self.config.release.cleanup:
            services[name].cleanup_app(app.app_id)

    def _end_other_tasks(self, app: AppRecord) -> None:
        """End the tasks that ES does not know: of OS_TaskCreate, and of ROS nodes."""
        history = self.history_of(app.name)
        for task in [task for task in self.kernel.tasks if task.owner is app]:
            history.cpu_ns += task.cpu_ns
            self.kernel.kill(task)

    def _clean_up_task(self, app: AppRecord, task_id: int) -> int:
        """Delete a task's objects, then the task (CFE_ES_CleanupTaskResources).

        Returns:
            0, or the status of the first object that could not be deleted.
        """
        status, before, is_stuck = 0, MOST_OBJECTS, False
        while True:
            found = self.osal.clean_up_task(task_id)
            failed = [each for each in found if each.error is not None]
            for each in failed:
                assert each.error is not None
                self.write_to_sys_log(
                    f"CFE_ES_CleanupObjectCallback: Call to OSAL Delete Object (ID:{each.object_id}) failed. "
                    f"RC={each.error.status}"
                )
            if failed and not status:
                status = _CLEANUP_ERRORS.get(get_base(failed[0].object_id), CFE_ES_APP_CLEANUP_ERR)
            if not found or is_stuck:
                break
            is_stuck = len(failed) == len(found) or len(found) >= before
            before = len(found)
        self.end_task(app, task_id)
        if status:
            self.write_to_sys_log(
                f"CFE_ES_CleanUpApp: CleanUpTaskResources for Task ID:{task_id} returned Error: "
                f"0x{status & 0xFFFFFFFF:08X}"
            )
        return status

    def end_task(self, app: AppRecord, task_id: int) -> None:
        """End a task of an application."""
        record = app.tasks.pop(task_id, None)
        if record is None:
            return
        if record.task is not None:
            self.history_of(app.name).cpu_ns += record.task.cpu_ns
            record.task.cpu_ns = 0
        try:
            self.osal.task_delete(task_id)
        except OsalError:
            pass  # the task has already ended, so there is nothing to delete

    def _release_pools(self, app: AppRecord) -> None:
        for pool_id, (owner, claim) in list(self.pool_owners.items()):
            if owner is app:
                self.pools.delete(pool_id)
                self.ports.memory.release(claim)
                del self.pool_owners[pool_id]

"""Applications: starting, ending, cleaning up and restarting them (cfe_es_apps.c)."""

from __future__ import annotations

from collections.abc import Callable
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
    WAITING,
    AppRecord,
    Entry,
    LibRecord,
    StartParams,
    TaskRecord,
)
from cfepy.es.tables import EsCore
from cfepy.osal.limits import OS_MAX_API_NAME
from cfepy.psp.psp import RST_TYPE_PROCESSOR
from cfepy.status import (
    CFE_ES_BAD_ARGUMENT,
    CFE_ES_ERR_DUPLICATE_NAME,
    CFE_ES_ERR_LOAD_LIB,
    CFE_ES_LIB_ALREADY_LOADED,
    CFE_ES_NO_RESOURCE_IDS_AVAILABLE,
    CFE_STATUS_EXTERNAL_RESOURCE_FAIL,
    CfeError,
    OsalError,
)

MAX_NAME = OS_MAX_API_NAME - 1
Loaded = TypeVar("Loaded")


class SymbolError(OsalError):
    """A module has no entry point of that name."""


class AppServices(EsCore):
    """The life of applications."""

    # -- starting --------------------------------------------------------------------------------------------------

    def create_app(self, name: str, params: StartParams, entry: Entry | None = None) -> int:
        """Load and start an application (CFE_ES_AppCreate).

        Args:
            name: 1 to 19 characters.
            params: the rest of its line in the startup script.
            entry: for a core application, its main function; otherwise the loader finds it.

        Returns:
            The AppId.

        Raises:
            CfeError: CFE_ES_BAD_ARGUMENT (name), CFE_ES_ERR_DUPLICATE_NAME, CFE_ES_NO_RESOURCE_IDS_AVAILABLE,
                CFE_STATUS_EXTERNAL_RESOURCE_FAIL (the module cannot be loaded).
        """
        if not 0 < len(name) <= MAX_NAME:
            raise CfeError(CFE_ES_BAD_ARGUMENT, f"application name {name!r}: 1 to {MAX_NAME} characters")
        if self.app_named(name) is not None:
            self.write_to_sys_log(f"CFE_ES_AppCreate: Duplicate app name '{name}'")
            raise CfeError(CFE_ES_ERR_DUPLICATE_NAME, f"application {name!r} runs already")
        if len(self.apps) >= self.apps.capacity:
            self.write_to_sys_log("CFE_ES_AppCreate: No free application slots available")
            raise CfeError(CFE_ES_NO_RESOURCE_IDS_AVAILABLE, f"{self.apps.capacity} applications run already")
        is_core = entry is not None
        main = entry or self._load(params.file, lambda: self.loader.load(params.file, params.symbol, name))
        record = AppRecord(name, params, main, is_core)
        record.app_id = self.apps.create(record)
        try:
            record.main_task_id = self.start_task(
                record, name, self._main_of(record), params.stack_size, params.priority
            )
        except CfeError as failure:
            self.apps.delete(record.app_id)
            self.write_to_sys_log(
                f"CFE_ES_AppCreate: AppCreate Error: TaskCreate {name} Failed. EC = {failure.status}!"
            )
            self._explain(failure)
            raise CfeError(CFE_STATUS_EXTERNAL_RESOURCE_FAIL, str(failure)) from failure
        self.history_of(name)
        return record.app_id

    def _explain(self, failure: CfeError) -> None:
        """More than NASA's line says, where the cause has more to tell: who uses the board's memory."""
        if "\n" in failure.text:
            self.console.write(failure.text)

    def load_library(self, name: str, file: str, symbol: str) -> int:
        """Load a library and call its init function (CFE_ES_LoadLibrary).

        Returns:
            The LibId.

        Raises:
            CfeError: CFE_ES_BAD_ARGUMENT, CFE_ES_LIB_ALREADY_LOADED, CFE_ES_NO_RESOURCE_IDS_AVAILABLE,
                CFE_STATUS_EXTERNAL_RESOURCE_FAIL (cannot be loaded) or what the init function returned.
        """
        if not 0 < len(name) <= MAX_NAME:
            raise CfeError(CFE_ES_BAD_ARGUMENT, f"library name {name!r}: 1 to {MAX_NAME} characters")
        if any(lib.name == name for lib in self.libs):
            self.write_to_sys_log(f"CFE_ES_LoadLibrary: Duplicate Lib name '{name}'")
            raise CfeError(CFE_ES_LIB_ALREADY_LOADED, f"library {name!r} is loaded already")
        if len(self.libs) >= self.libs.capacity:
            self.write_to_sys_log("CFE_ES_LoadLibrary: No free library slots available")
            raise CfeError(CFE_ES_NO_RESOURCE_IDS_AVAILABLE, f"{self.libs.capacity} libraries are loaded already")
        init = self._load(file, lambda: self.loader.load_library(file, symbol))
        record = LibRecord(name, file)
        record.lib_id = self.libs.create(record)
        result = init(record.lib_id)
        if isinstance(result, int) and result != 0:
            self.libs.delete(record.lib_id)
            self.write_to_sys_log(f"CFE_ES_LoadLibrary: Load Shared Library Init Error = 0x{result & 0xFFFFFFFF:08x}")
            raise CfeError(CFE_ES_ERR_LOAD_LIB, f"init function of library {name!r} returned {result}")
        return record.lib_id

    def _load(self, file: str, load: Callable[[], Loaded]) -> Loaded:
        try:
            return load()
        except SymbolError as missing:
            self.write_to_sys_log(f"CFE_ES_LoadModule: Could not find symbol:{missing.text}. EC = {missing.status}")
            raise CfeError(CFE_STATUS_EXTERNAL_RESOURCE_FAIL, str(missing)) from missing
        except OsalError as missing:
            self.write_to_sys_log(f"CFE_ES_LoadModule: Could not load file:{file}. EC = {missing.status}")
            raise CfeError(CFE_STATUS_EXTERNAL_RESOURCE_FAIL, str(missing)) from missing

    def start_task(self, app: AppRecord, name: str, entry: Entry, stack_size: int, priority: int) -> int:
        """Start a task of an application; its entry runs after NASA's start delay of 50 ms."""
        record = TaskRecord(0, name, stack_size, priority)

        def run() -> None:
            record.task = self.kernel.current
            self.osal.task_delay(self.config.es_startup_sync_poll_ms)
            entry()

        record.task_id = self.osal.task_create(name, run, stack_size, priority, owner=app)
        app.tasks[record.task_id] = record
        return record.task_id

    def _main_of(self, app: AppRecord) -> Entry:
        def main() -> None:
            app.entry()
            self.exit_app(APP_EXIT)  # in C the task would end and ES never know

        return main

    # -- ending ----------------------------------------------------------------------------------------------------

    def exit_app(self, status: int = APP_EXIT) -> None:
        """End the calling application; does not return (CFE_ES_ExitApp).

        Args:
            status: APP_EXIT, APP_ERROR, or for a core application CORE_APP_INIT_ERROR, CORE_APP_RUNTIME_ERROR.
        """
        app = self.calling_app()
        if status not in (APP_EXIT, APP_ERROR, CORE_APP_INIT_ERROR, CORE_APP_RUNTIME_ERROR):
            self.write_to_sys_log(f"CFE_ES_ExitApp: Called with invalid status ({status}).")
            status = APP_ERROR
        if app.control_request == APP_RUN:
            app.control_request = status  # a request that is pending already stays
        if app.is_core:
            self._exit_core(app, status)
        self.write_to_sys_log(f"CFE_ES_ExitApp: Application {app.name} called CFE_ES_ExitApp")
        app.state = STOPPED
        while True:  # until the background scan deletes the application and this task with it
            self.osal.task_delay(500)

    def _exit_core(self, app: AppRecord, status: int) -> None:
        if status == CORE_APP_INIT_ERROR:
            self.write_to_sys_log(f"CFE_ES_ExitApp: CORE Application {app.name} Had an Init Error.")
            self.on_reset(RST_TYPE_PROCESSOR, f"core application {app.name} had an init error")
        elif status == CORE_APP_RUNTIME_ERROR:
            self.write_to_sys_log(f"CFE_ES_ExitApp: CORE Application {app.name} Had a Runtime Error.")
        else:
            self.write_to_sys_log(f"CFE_ES_ExitApp: Cannot Exit CORE Application {app.name}")

    def restart_app(self, app_id: int) -> None:
        """Ask for an application to be cleaned up and started again (CFE_ES_RestartApp)."""
        app = self._user_app(app_id, "Restart")
        if not self.loader.exists(app.params.file):
            self.write_to_sys_log(
                f"CFE_ES_RestartApp: Cannot Restart Application {app.name}, File {app.params.file} does not exist."
            )
            raise CfeError(CFE_STATUS_EXTERNAL_RESOURCE_FAIL, f"{app.params.file} does not exist")
        self.write_to_sys_log(f"CFE_ES_RestartApp: Restart Application {app.name} Initiated")
        app.control_request = SYS_RESTART

    def reload_app(self, app_id: int, file: str) -> None:
        """As `restart_app`, from another file (CFE_ES_ReloadApp)."""
        app = self._user_app(app_id, "Reload")
        if not self.loader.exists(file):
            self.write_to_sys_log(
                f"CFE_ES_ReloadApp: Cannot Reload Application {app.name}, File {file} does not exist."
            )
            raise CfeError(CFE_STATUS_EXTERNAL_RESOURCE_FAIL, f"{file} does not exist")
        self.write_to_sys_log(f"CFE_ES_ReloadApp: Reload Application {app.name} Initiated. New filename = {file}")
        app.params.file = file
        app.control_request = SYS_RELOAD

    def delete_app(self, app_id: int) -> None:
        """Ask for an application to be ended and cleaned up (CFE_ES_DeleteApp)."""
        app = self._user_app(app_id, "Delete")
        self.write_to_sys_log(f"CFE_ES_DeleteApp: Delete Application {app.name} Initiated")
        app.control_request = SYS_DELETE

    def _user_app(self, app_id: int, action: str) -> AppRecord:
        app = self.apps.find(app_id)
        if app is None:
            self.write_to_sys_log(f"CFE_ES_{action}App: Invalid Application ID received for {action}, AppID = {app_id}")
            return self.app(app_id)
        if app.is_core:
            self.write_to_sys_log(f"CFE_ES_{action}App: Cannot {action} a CORE Application: {app.name}.")
            raise CfeError(CFE_ES_BAD_ARGUMENT, f"{app.name} is a core application")
        if app.state != RUNNING:
            self.write_to_sys_log(f"CFE_ES_{action}App: Cannot {action} Application {app.name}, It is not running.")
            raise CfeError(CFE_ES_BAD_ARGUMENT, f"{app.name} is not running")
        return app

    # -- the background scan ---------------------------------------------------------------------------------------

    def scan_apps(self, elapsed_ms: int) -> bool:
        """One pass over the applications that change state (CFE_ES_RunAppTableScan); whether there are any."""
        pending = False
        due = []
        for app in self.apps:
            if app.is_core:
                continue
            if app.state > RUNNING:
                pending = True
                app.timer_ms = max(0, app.timer_ms - elapsed_ms)
                if app.timer_ms == 0:
                    due.append(app)
            elif app.state == RUNNING and app.control_request > APP_RUN:
                app.state = WAITING
                app.timer_ms = self.config.es_app_kill_timeout * self.config.es_app_scan_rate_ms
                pending = True
        for app in due:
            self.process_control_request(app)
        return pending

    def process_control_request(self, app: AppRecord) -> None:
        """Clean up an application, start it again if that was asked for, and say so (CFE_ES_ProcessControlRequest)."""
        request = app.control_request
        history = self.history_of(app.name)
        history.error_exits += request == APP_ERROR
        self.cleanup_app(app)
        detail, failed = "Completed.", False
        if request in (SYS_RESTART, SYS_RELOAD):
            try:
                detail = f"Completed, AppID={self.create_app(app.name, app.params)}"
                history.restarts += 1
            except CfeError as failure:
                failed = True
                detail = f"Failed: AppCreate Error {failure.hex}."
        action, done, error = {
            APP_EXIT: ("Exit", ev.EXIT_APP_INF_EID, ev.EXIT_APP_ERR_EID),
            APP_ERROR: ("Exit", ev.ERREXIT_APP_INF_EID, ev.ERREXIT_APP_ERR_EID),
            SYS_DELETE: ("Stop", ev.STOP_INF_EID, ev.STOP_ERR3_EID),
            SYS_RESTART: ("Restart", ev.RESTART_APP_INF_EID, ev.RESTART_APP_ERR4_EID),
            SYS_RELOAD: ("Reload", ev.RELOAD_APP_INF_EID, ev.RELOAD_APP_ERR4_EID),
            SYS_EXCEPTION: ("ES_ProcControlReq: Invalid State", ev.PCR_ERR1_EID, ev.PCR_ERR1_EID),
        }[request]
        event, kind = (error, ev.ERROR) if failed else (done, ev.INFORMATION)
        self.ports.evs.send_event(event, kind, f"{action} Application {app.name} {detail}")

    def cleanup_app(self, app: AppRecord) -> None:
        """End an application's tasks and give back everything it holds (CFE_ES_CleanUpApp).

        The tasks go first, so that their `finally` blocks still find what they clean up.
        """
        history = self.history_of(app.name)
        for task_id in [*(each for each in app.tasks if each != app.main_task_id), app.main_task_id]:
            self._end_task(app, task_id)
        for task in [task for task in self.kernel.tasks if task.owner is app]:
            history.cpu_ns += task.cpu_ns
            self.kernel.kill(task)
        for service in (self.ports.tbl, self.ports.sb, self.ports.time, self.ports.evs):
            service.cleanup_app(app.app_id)
        self.osal.delete_objects_of(app)
        self._release_pools(app)
        self.apps.delete(app.app_id)

    def _end_task(self, app: AppRecord, task_id: int) -> None:
        record = app.tasks.pop(task_id, None)
        if record is None:
            return
        if record.task is not None:
            self.history_of(app.name).cpu_ns += record.task.cpu_ns
            record.task.cpu_ns = 0
        try:
            self.osal.task_delete(task_id)
        except OsalError:
            pass  # the task ended by itself: nothing is left to delete

    def _release_pools(self, app: AppRecord) -> None:
        for pool_id, (owner, claim) in list(self.pool_owners.items()):
            if owner is app:
                self.pools.delete(pool_id)
                self.ports.memory.release(claim)
                del self.pool_owners[pool_id]

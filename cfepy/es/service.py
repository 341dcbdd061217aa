"""Executive Services: what an application asks of it (cfe_es_api.c)."""

from __future__ import annotations

from collections.abc import Callable

from cfepy.es.apps import AppServices
from cfepy.es.pools import MemPool, PoolBlock
from cfepy.es.records import (
    APP_RUN,
    LATE_INIT,
    RUNNING,
    SYSTEM_OPERATIONAL,
    AppInfo,
    AppRecord,
    Fault,
    TaskInfo,
)
from cfepy.fs import CRC_16, calculate_crc
from cfepy.ports import SYSTEM_CORE_READY
from cfepy.rtos import Task
from cfepy.status import (
    CFE_ES_BAD_ARGUMENT,
    CFE_ES_ERR_CHILD_TASK_CREATE,
    CFE_ES_ERR_CHILD_TASK_DELETE_MAIN_TASK,
    CFE_ES_ERR_NAME_NOT_FOUND,
    CFE_ES_ERR_RESOURCEID_NOT_VALID,
    CFE_ES_OPERATION_TIMED_OUT,
    CfeError,
)

CORE = 1
EXTERNAL = 2


class ExecutiveServices(AppServices):
    """One processor's ES; the arguments are those of `EsCore`."""

    # -- the run loop ----------------------------------------------------------------------------------------------

    def run_loop(self, status: int = APP_RUN) -> bool:
        """Whether the calling application shall go on; also tells ES that it runs (CFE_ES_RunLoop).

        Args:
            status: APP_RUN to go on; anything else makes the answer False.
        """
        app = self.app_of_caller()
        if app is None:
            self.write_to_sys_log("CFE_ES_RunLoop: Error getting AppID for the caller")
            return False
        if status != APP_RUN:
            return False
        if app.control_request != APP_RUN:
            return False
        if app.state < RUNNING:
            app.state = RUNNING
        self.increment_task_counter()
        return True

    def control_request(self) -> int:
        """What is asked of the calling application: APP_RUN, or why it shall end (C's *RunStatus after RunLoop)."""
        return self.calling_app().control_request

    def wait_for_system_state(self, state: int, timeout_ms: int) -> None:
        """Wait until the mission reached a system state, looking every 50 ms (CFE_ES_WaitForSystemState).

        Args:
            state: SYSTEM_*.
            timeout_ms: the longest time.

        Raises:
            CfeError: CFE_ES_OPERATION_TIMED_OUT.
        """
        app = self.calling_app()
        reached = LATE_INIT
        if state >= SYSTEM_OPERATIONAL or (app.is_core and state >= SYSTEM_CORE_READY):
            reached = RUNNING  # whoever waits for this has finished its own initialisation
        app.state = max(app.state, reached)
        waited = 0
        while self.system_state < state:
            if waited >= timeout_ms:
                raise CfeError(CFE_ES_OPERATION_TIMED_OUT, f"system state {state} not reached in {timeout_ms} ms")
            self.osal.task_delay(self.config.es_startup_sync_poll_ms)
            waited += self.config.es_startup_sync_poll_ms

    def wait_for_startup_sync(self, timeout_ms: int) -> None:
        """Wait until the mission is operational; a timeout is not an error (CFE_ES_WaitForStartupSync)."""
        try:
            self.wait_for_system_state(SYSTEM_OPERATIONAL, timeout_ms)
        except CfeError as late:
            if late.status != CFE_ES_OPERATION_TIMED_OUT:
                raise

    # -- who am I --------------------------------------------------------------------------------------------------

    def get_app_id(self) -> int:
        """AppId of the calling application (CFE_ES_GetAppID)."""
        return self.calling_app().app_id

    def get_task_id(self) -> int:
        """TaskId of the calling task (CFE_ES_GetTaskID)."""
        return self.osal.task_get_id()

    def get_app_id_by_name(self, name: str) -> int:
        """AppId of a named application (CFE_ES_GetAppIDByName)."""
        return self.require_app_named(name).app_id

    def get_app_name(self, app_id: int) -> str:
        """Name of an application (CFE_ES_GetAppName)."""
        return self.app(app_id).name

    def get_lib_id_by_name(self, name: str) -> int:
        """LibId of a named library (CFE_ES_GetLibIDByName)."""
        for lib in self.libs:
            if lib.name == name:
                return lib.lib_id
        raise CfeError(CFE_ES_ERR_NAME_NOT_FOUND, f"no library is called {name!r}")

    def get_lib_name(self, lib_id: int) -> str:
        """Name of a library (CFE_ES_GetLibName)."""
        return self.libs.get(lib_id).name

    def get_task_id_by_name(self, name: str) -> int:
        """TaskId of a named task (CFE_ES_GetTaskIDByName)."""
        for app in self.apps:
            for record in app.tasks.values():
                if record.name == name:
                    return record.task_id
        raise CfeError(CFE_ES_ERR_NAME_NOT_FOUND, f"no task is called {name!r}")

    def get_task_name(self, task_id: int) -> str:
        """Name of a task (CFE_ES_GetTaskName)."""
        return self.find_task(task_id)[1].name

    def get_app_info(self, app_id: int) -> AppInfo:
        """Facts about an application (CFE_ES_GetAppInfo)."""
        app = self.app(app_id)
        main = app.tasks.get(app.main_task_id)
        params = app.params
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

    def get_task_info(self, task_id: int) -> TaskInfo:
        """Facts about a task (CFE_ES_GetTaskInfo)."""
        app, record = self.find_task(task_id)
        return TaskInfo(
            task_id, record.name, app.app_id, app.name, record.stack_size, record.priority, record.execution_counter
        )

    def increment_task_counter(self) -> None:
        """Count one cycle of the calling task (CFE_ES_IncrementTaskCounter)."""
        app = self.app_of_caller()
        record = app.tasks.get(self.osal.task_get_id()) if app is not None else None
        if record is not None:
            record.execution_counter += 1

    # -- child tasks -----------------------------------------------------------------------------------------------

    def create_child_task(
        self, name: str, entry: Callable[[], object], stack_size: int, priority: int, flags: int = 0
    ) -> int:
        """Start a task that belongs to the calling application (CFE_ES_CreateChildTask).

        Args:
            name: unique, at most 19 characters.
            entry: called without arguments, at least 50 ms later.
            stack_size: bytes.
            priority: 0 (most urgent) to 255.
            flags: not used.

        Returns:
            The TaskId.

        Raises:
            CfeError: CFE_ES_BAD_ARGUMENT, CFE_ES_ERR_CHILD_TASK_CREATE (called by a child task).
            OsalError: the task cannot be created.
        """
        app = self.app_of_caller()
        if app is None or not name:
            self.write_to_sys_log(f"CFE_ES_CreateChildTask: Invalid calling context when creating Task '{name}'")
            raise CfeError(CFE_ES_BAD_ARGUMENT, f"child task {name!r} needs an application and a name")
        if self.osal.task_get_id() != app.main_task_id:
            self.write_to_sys_log(f"CFE_ES_CreateChildTask: Error: Cannot call from a Child Task (for Task '{name}').")
            raise CfeError(CFE_ES_ERR_CHILD_TASK_CREATE, "only the main task of an application creates child tasks")
        return self.start_task(app, name, entry, stack_size, priority)

    def delete_child_task(self, task_id: int) -> None:
        """End a child task (CFE_ES_DeleteChildTask).

        Raises:
            CfeError: CFE_ES_ERR_RESOURCEID_NOT_VALID, CFE_ES_ERR_CHILD_TASK_DELETE_MAIN_TASK.
        """
        app, _ = self.find_task(task_id)
        if task_id == app.main_task_id:
            self.write_to_sys_log(f"CFE_ES_DeleteChildTask: Error: Task {task_id} is a cFE Main Task.")
            raise CfeError(CFE_ES_ERR_CHILD_TASK_DELETE_MAIN_TASK, f"task {task_id} is the main task of {app.name}")
        self._end_task(app, task_id)
        self.write_to_sys_log(f"CFE_ES_DeleteChildTask: Task {task_id} Deleted")

    def exit_child_task(self) -> None:
        """End the calling child task; does not return (CFE_ES_ExitChildTask)."""
        app = self.calling_app()
        task_id = self.osal.task_get_id()
        if task_id == app.main_task_id:
            self.write_to_sys_log(f"CFE_ES_ExitChildTask: Error: Cannot Call from a cFE App Main Task. ID = {task_id}")
            return
        record = app.tasks.pop(task_id, None)
        if record is not None and record.task is not None:
            self.history_of(app.name).cpu_ns += record.task.cpu_ns
        self.osal.task_exit()

    # -- memory pools ----------------------------------------------------------------------------------------------

    def pool_create(self, size: int) -> int:
        """Make a memory pool for the calling application (CFE_ES_PoolCreate).

        Args:
            size: bytes.

        Returns:
            The pool's handle.
        """
        app = self.app_of_caller()
        owner = app.name if app is not None else "host"
        if size <= 0:
            raise CfeError(CFE_ES_BAD_ARGUMENT, f"pool of {size} bytes")
        claim = self.ports.memory.claim(owner, "memory pool", size)
        pool_id = self.pools.create(MemPool(owner, size))
        self.pool_owners[pool_id] = (app, claim)
        return pool_id

    def pool_delete(self, pool_id: int) -> None:
        """Delete a pool (CFE_ES_PoolDelete)."""
        self._pool(pool_id)
        self.pools.delete(pool_id)
        self.ports.memory.release(self.pool_owners.pop(pool_id)[1])

    def get_pool_buf(self, pool_id: int, size: int) -> PoolBlock:
        """Take a block out of a pool (CFE_ES_GetPoolBuf); see `MemPool.get`."""
        return self._pool(pool_id).get(size)

    def put_pool_buf(self, pool_id: int, block: PoolBlock) -> int:
        """Give a block back (CFE_ES_PutPoolBuf); its size in bytes."""
        return self._pool(pool_id).put(block)

    def get_mem_pool_stats(self, pool_id: int) -> dict[str, object]:
        """Fields of CFE_ES_MemPoolStats_t (CFE_ES_GetMemPoolStats)."""
        return self._pool(pool_id).statistics()

    def _pool(self, pool_id: int) -> MemPool:
        pool = self.pools.find(pool_id)
        if pool is None:
            raise CfeError(CFE_ES_ERR_RESOURCEID_NOT_VALID, f"no memory pool has the handle 0x{pool_id:x}")
        return pool

    # -- the rest --------------------------------------------------------------------------------------------------

    def calculate_crc(self, data: bytes, crc: int = 0, kind: int = CRC_16) -> int:
        """Check value of some bytes (CFE_ES_CalculateCRC); see `cfepy.fs.calculate_crc`."""
        return calculate_crc(data, crc, kind)

    def take_fault(self, task: Task, error: BaseException, reason: str) -> bool:
        """A task died of an exception: keep it for the background scan (CFE_PSP_Exception_*). False: not an app's."""
        app = task.owner
        if not isinstance(app, AppRecord):
            return False
        app.error = error
        history = self.history_of(app.name)
        history.deaths += 1
        history.last_error = error
        task_id = next((each.task_id for each in app.tasks.values() if each.task is task), 0)
        self.faults.append(Fault(app, task_id, reason))
        return True

    def apps_below(self, state: int) -> list[AppRecord]:
        """External applications that have not reached a state yet and have not ended either."""
        return [app for app in self.apps if not app.is_core and app.state < state]

    def reached(self, state: int) -> bool:
        """Whether all external applications reached a state."""
        return not self.apps_below(state)

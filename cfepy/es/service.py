"""Executive Services as applications see them (cfe_es_api.c), combined from their parts.

Child tasks (CFE_ES_*ChildTask) and generic counters (CFE_ES_*GenCount*) are in this module. A generic counter is a
32-bit number that any application can create, find by name and increment. The other parts have a module each.
"""

from __future__ import annotations

from collections.abc import Callable

from cfepy.es.apps import AppEnd
from cfepy.es.cds import CdsApi
from cfepy.es.exceptions import TaskExceptionApi
from cfepy.es.info import InfoApi
from cfepy.es.pool_api import PoolApi
from cfepy.es.records import (
    APP_RUN,
    EARLY_INIT,
    LATE_INIT,
    RUNNING,
    STOPPED,
    SYSTEM_APPS_INIT,
    SYSTEM_OPERATIONAL,
    SYSTEM_SHUTDOWN,
    AppRecord,
    GenCounter,
)
from cfepy.es.tables import EsCore
from cfepy.fs import CRC_16, calculate_crc
from cfepy.ids import ES_COUNTID_BASE, name_size, to_index
from cfepy.osal import OS_MAX_API_NAME
from cfepy.ports import SYSTEM_CORE_READY
from cfepy.status import (
    CFE_ES_BAD_ARGUMENT,
    CFE_ES_ERR_CHILD_TASK_CREATE,
    CFE_ES_ERR_CHILD_TASK_DELETE_MAIN_TASK,
    CFE_ES_ERR_DUPLICATE_NAME,
    CFE_ES_ERR_NAME_NOT_FOUND,
    CFE_ES_ERR_RESOURCEID_NOT_VALID,
    CFE_ES_NO_RESOURCE_IDS_AVAILABLE,
    CFE_ES_OPERATION_TIMED_OUT,
    CfeError,
    status_to_string,
)

_WORD = 0xFFFFFFFF


class ChildTaskApi(InfoApi, AppEnd):
    """The lifecycle of child tasks."""

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
            CfeError: CFE_ES_BAD_ARGUMENT (no name, no function), CFE_ES_ERR_RESOURCEID_NOT_VALID (the caller does not
                belong to an application), CFE_ES_ERR_CHILD_TASK_CREATE (called by a child task),
                CFE_STATUS_EXTERNAL_RESOURCE_FAIL (OSAL cannot create it).
        """
        self._check_child(name, entry)
        app = self.app_of_caller()
        if app is None:
            self.write_to_sys_log(f"CFE_ES_CreateChildTask: Invalid calling context when creating Task '{name}'")
            raise CfeError(CFE_ES_ERR_RESOURCEID_NOT_VALID, f"child task {name!r} requires an application")
        if self.osal.task_get_id() != app.main_task_id:
            self.write_to_sys_log(f"CFE_ES_CreateChildTask: Error: Cannot call from a Child Task (for Task '{name}').")
            raise CfeError(CFE_ES_ERR_CHILD_TASK_CREATE, "only the main task of an application can create child tasks")
        return self.start_task(app, name, entry, stack_size, priority)

    def _check_child(self, name: str | None, entry: Callable[[], object]) -> None:
        if name is None:
            text = "TaskName Parameter is NULL"
        elif not callable(entry):
            text = f"Function Pointer Parameter is NULL for Task '{name}'"
        else:
            return
        self.write_to_sys_log(f"CFE_ES_CreateChildTask: {text}")
        raise CfeError(CFE_ES_BAD_ARGUMENT, f"a child task requires a name and a function, not {name!r} and {entry!r}")

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
            raise CfeError(
                CFE_ES_ERR_CHILD_TASK_DELETE_MAIN_TASK,
                f"task {task_id} must be a child task, not the main task of {app.name}",
            )
        self.end_task(app, task_id)
        log(f"CFE_ES_DeleteChildTask: Task {task_id} Deleted")

    def exit_child_task(self) -> None:
        """End the calling child task; does not return (CFE_ES_ExitChildTask). A main task continues, with a
        log entry.
        """
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


class CounterApi(EsCore):
    """The generic counters of Executive Services. They belong to no application, and stay until they are deleted."""

    def register_gen_counter(self, name: str) -> int:
        """Make a counter with the value 0 (CFE_ES_RegisterGenCounter).

        Args:
            name: unique, at most 19 characters.

        Returns:
            The CounterId.

        Raises:
            CfeError: CFE_ES_BAD_ARGUMENT, CFE_ES_ERR_DUPLICATE_NAME, CFE_ES_NO_RESOURCE_IDS_AVAILABLE.
        """
        if name_size(name) >= OS_MAX_API_NAME:
            raise CfeError(
                CFE_ES_BAD_ARGUMENT, f"counter name {name!r} must have at most {OS_MAX_API_NAME - 1} characters"
            )
        if any(counter.name == name for counter in self.counters):
            self.write_to_sys_log(f"CFE_ES_RegisterGenCounter: Duplicate Counter name '{name}'")
            raise CfeError(CFE_ES_ERR_DUPLICATE_NAME, f"counter {name!r} already exists")
        if len(self.counters) >= self.counters.capacity:
            self.write_to_sys_log("CFE_ES_RegisterGenCounter: No free Counter slots available")
            text = f"there are {self.counters.capacity} counters already"
            raise CfeError(CFE_ES_NO_RESOURCE_IDS_AVAILABLE, text)
        return self.counters.create(GenCounter(name))

    def delete_gen_counter(self, counter_id: int) -> None:
        """Delete a counter (CFE_ES_DeleteGenCounter); raises CFE_ES_BAD_ARGUMENT."""
        self._counter(counter_id)
        self.counters.delete(counter_id)

    def increment_gen_counter(self, counter_id: int) -> None:
        """Increment a counter (CFE_ES_IncrementGenCounter); raises CFE_ES_BAD_ARGUMENT."""
        counter = self._counter(counter_id)
        counter.count = counter.count + 1 & _WORD

    def set_gen_count(self, counter_id: int, count: int) -> None:
        """Set a counter to a number of 32 bits (CFE_ES_SetGenCount); raises CFE_ES_BAD_ARGUMENT."""
        self._counter(counter_id).count = count & _WORD

    def get_gen_count(self, counter_id: int) -> int:
        """Return the value of a counter (CFE_ES_GetGenCount); raises CFE_ES_BAD_ARGUMENT."""
        return self._counter(counter_id).count

    def get_gen_counter_id_by_name(self, name: str) -> int:
        """Return the CounterId of a named counter (CFE_ES_GetGenCounterIDByName); raises CFE_ES_ERR_NAME_NOT_FOUND."""
        for counter_id, counter in self.counters.items():
            if counter.name == name:
                return counter_id
        raise CfeError(CFE_ES_ERR_NAME_NOT_FOUND, f"unknown counter {name!r}")

    def get_gen_counter_name(self, counter_id: int) -> str:
        """Return the name of a counter (CFE_ES_GetGenCounterName); raises CFE_ES_ERR_RESOURCEID_NOT_VALID."""
        return self.counters.get(counter_id).name

    def counter_id_to_index(self, counter_id: int) -> int:
        """Return the slot of a CounterId (CFE_ES_CounterID_ToIndex); raises CFE_ES_ERR_RESOURCEID_NOT_VALID."""
        return to_index(counter_id, ES_COUNTID_BASE, self.counters.capacity)

    def _counter(self, counter_id: int) -> GenCounter:
        """Return a counter; an invalid id has another status here than elsewhere in cFE."""
        counter = self.counters.find(counter_id)
        if counter is None:
            raise CfeError(CFE_ES_BAD_ARGUMENT, f"invalid counter id 0x{counter_id:x}")
        return counter


class ExecutiveServices(ChildTaskApi, TaskExceptionApi, CdsApi, CounterApi, PoolApi):
    """The Executive Services of one processor; see `EsCore` for the arguments."""

    status_to_string = staticmethod(status_to_string)

    # -- the run loop ----------------------------------------------------------------------------------------------

    def run_loop(self, status: int = APP_RUN) -> bool:
        """Return whether the calling application should continue, and record that it runs (CFE_ES_RunLoop).

        Args:
            status: APP_RUN to continue; any other value returns False.
        """
        self.increment_task_counter()
        if status != APP_RUN:
            return False
        app = self.app_of_caller()
        if app is None:
            self.write_to_sys_log("CFE_ES_RunLoop: Error getting AppID for the caller")
            return False
        app.state = max(app.state, RUNNING)
        return app.control_request == APP_RUN

    def control_request(self) -> int:
        """Return the request to the calling application: APP_RUN, or the reason to end (C's *RunStatus after
        RunLoop).
        """
        return self.calling_app().control_request

    def wait_for_system_state(self, state: int, timeout_ms: int) -> None:
        """Wait until the mission reaches a system state, checking every 50 ms (CFE_ES_WaitForSystemState).

        Args:
            state: SYSTEM_*. The call also marks the progress of the calling application: it waits for others, so it has
                finished its own part.
            timeout_ms: the longest time.

        Raises:
            CfeError: CFE_ES_OPERATION_TIMED_OUT.
        """
        app = self.app_of_caller()
        if app is not None:
            app.state = max(app.state, _state_of_who_waits_for(state, app.is_core))
        remaining = timeout_ms
        while self.system_state < state:
            if remaining <= 0:
                raise CfeError(CFE_ES_OPERATION_TIMED_OUT, f"system state {state} not reached in {timeout_ms} ms")
            pause = min(remaining, self.config.es_startup_sync_poll_ms)
            self.osal.task_delay(pause)
            remaining -= pause

    def wait_for_startup_sync(self, timeout_ms: int) -> None:
        """Wait until the mission is operational; a timeout is not an error (CFE_ES_WaitForStartupSync)."""
        try:
            self.wait_for_system_state(SYSTEM_OPERATIONAL, timeout_ms)
        except CfeError as late:
            if late.status != CFE_ES_OPERATION_TIMED_OUT:
                raise

    def apps_below(self, state: int) -> list[AppRecord]:
        """Return the external applications that have neither reached a state nor ended."""
        return [app for app in self.apps if not app.is_core and app.state < state]

    def reached(self, state: int) -> bool:
        """Return whether all external applications have reached a state."""
        return not self.apps_below(state)

    # -- the performance log ---------------------------------------------------------------------------------------

    def perf_log_add(self, marker: int, entry_exit: int) -> None:
        """Record a marker in the code, if data are being collected (CFE_ES_PerfLogAdd).

        Args:
            marker: number of the marker, 0 to 127.
            entry_exit: 0 at the entry of the code, 1 at its exit; only the last bit counts.
        """
        self.perf_log.add(marker, entry_exit)

    def perf_log_entry(self, marker: int) -> None:
        """Record the entry of marked code; see `perf_log_add` (CFE_ES_PerfLogEntry)."""
        self.perf_log.add(marker, 0)

    def perf_log_exit(self, marker: int) -> None:
        """Record the exit of marked code; see `perf_log_add` (CFE_ES_PerfLogExit)."""
        self.perf_log.add(marker, 1)

    # -- the rest --------------------------------------------------------------------------------------------------

    def calculate_crc(self, data: bytes, crc: int = 0, kind: int = CRC_16) -> int:
        """Return the check value of some bytes (CFE_ES_CalculateCRC); see `cfepy.fs.calculate_crc`."""
        return calculate_crc(data, crc, kind)


def _state_of_who_waits_for(system_state: int, is_core: bool) -> int:
    if is_core:
        return RUNNING if system_state >= SYSTEM_CORE_READY else EARLY_INIT
    if system_state >= SYSTEM_SHUTDOWN:
        return STOPPED
    if system_state >= SYSTEM_OPERATIONAL:
        return RUNNING
    return LATE_INIT if system_state >= SYSTEM_APPS_INIT else EARLY_INIT

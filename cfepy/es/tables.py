"""The tables of Executive Services and the lookups for all its parts (cfe_es_resource.c)."""

from __future__ import annotations

from cfepy.config.platform import PlatformConfig
from cfepy.es.erlog import MAX_CONTEXT, ExceptionResetLog
from cfepy.es.perf import PerformanceLog
from cfepy.es.pools import MemPool
from cfepy.es.records import (
    SYSTEM_EARLY_INIT,
    AppHistory,
    AppRecord,
    FailedTask,
    GenCounter,
    LibRecord,
    Loader,
    TaskRecord,
)
from cfepy.es.reset_data import ResetData
from cfepy.es.syslog import SystemLog
from cfepy.ids import ES_APPID_BASE, ES_COUNTID_BASE, ES_LIBID_BASE, ES_POOLID_BASE, IdTable
from cfepy.osal import Osal
from cfepy.ports import Ports
from cfepy.psp import Psp
from cfepy.rtos import Kernel, Semaphore
from cfepy.status import CFE_ES_ERR_NAME_NOT_FOUND, CFE_ES_ERR_RESOURCEID_NOT_VALID, CfeError, OsalError
from cfepy.units import NS_PER_MS
from cfepy.writing.console import Console


class EsCore:
    """State of Executive Services; the base of its parts.

    Args:
        kernel: the kernel of the processor.
        ports: the other services.
        config: limits.
        osal: creates tasks.
        psp: the board: the cause of its start, its retained memory, and resets.
        console: prints the system log.
        loader: finds the code of applications.
    """

    def __init__(
        self,
        kernel: Kernel,
        ports: Ports,
        config: PlatformConfig,
        osal: Osal,
        psp: Psp,
        console: Console,
        loader: Loader,
    ) -> None:
        self.kernel = kernel
        self.ports = ports
        self.config = config
        self.osal = osal
        self.psp = psp
        self.console = console
        self.loader = loader
        self.failed_tasks: list[FailedTask] = []  # until the exception scan has handled them
        self.reset = ResetData(config, psp.get_timer_ticks_per_second(), psp.get_timer_low32_rollover())
        self.syslog = SystemLog(ports, console, config)
        self.er_log = ExceptionResetLog(ports, self.reset, self._context_of)
        self.perf_log = PerformanceLog(
            self.reset.perf, config.es_perf_data_buffer_size, psp.get_timebase, self.syslog.write_to_sys_log
        )
        self.apps: IdTable[AppRecord] = IdTable(ES_APPID_BASE, config.es_max_applications)
        self.libs: IdTable[LibRecord] = IdTable(ES_LIBID_BASE, config.es_max_libraries)
        self.pools: IdTable[MemPool] = IdTable(ES_POOLID_BASE, config.es_max_memory_pools)
        self.pool_owners: dict[int, tuple[AppRecord | None, int]] = {}
        self.counters: IdTable[GenCounter] = IdTable(ES_COUNTID_BASE, config.es_max_gen_counters)
        self.history: dict[str, AppHistory] = {}
        self.system_state = SYSTEM_EARLY_INIT
        self._background = Semaphore(kernel, 0, 1, "ES_BG_SEM")

    def keep_in(self, reset: ResetData) -> None:
        """Use the logs and counters in the retained memory of the board."""
        self.reset = self.er_log.reset = reset
        self.syslog.data = reset.syslog
        self.perf_log.data = reset.perf

    def _context_of(self, context_id: int) -> bytes:
        """Return the processor context of an exception; empty if the board does not have it (any more)."""
        try:
            return self.psp.exception_copy_context(context_id, MAX_CONTEXT)
        except OsalError:
            return b""

    def write_to_sys_log(self, text: str) -> int:
        """Add a line to the system log (CFE_ES_WriteToSysLog); see `SystemLog.write_to_sys_log`."""
        return self.syslog.write_to_sys_log(text)

    def background_wakeup(self) -> None:
        """Wake the background task (CFE_ES_BackgroundWakeup)."""
        self._background.give()

    def background_wait(self, timeout_ms: int) -> None:
        """Wait for `background_wakeup`, or for at most `timeout_ms`."""
        self._background.take(timeout_ms * NS_PER_MS)

    def app_of_caller(self) -> AppRecord | None:
        """Return the application of the running task, or None."""
        owner = self.kernel.current.owner
        return owner if isinstance(owner, AppRecord) else None

    def calling_app(self) -> AppRecord:
        """Return the application of the running task.

        Raises:
            CfeError: CFE_ES_ERR_RESOURCEID_NOT_VALID if the task belongs to none.
        """
        app = self.app_of_caller()
        if app is None:
            raise CfeError(CFE_ES_ERR_RESOURCEID_NOT_VALID, "the caller is not a task of an application")
        return app

    def app(self, app_id: int) -> AppRecord:
        """Return an application by its id.

        Raises:
            CfeError: CFE_ES_ERR_RESOURCEID_NOT_VALID.
        """
        return self.apps.get(app_id)

    def app_named(self, name: str) -> AppRecord | None:
        """Return an application by its name, or None."""
        return next((app for app in self.apps if app.name == name), None)

    def require_app_named(self, name: str) -> AppRecord:
        """Return an application by its name.

        Raises:
            CfeError: CFE_ES_ERR_NAME_NOT_FOUND.
        """
        app = self.app_named(name)
        if app is None:
            raise CfeError(CFE_ES_ERR_NAME_NOT_FOUND, f"unknown application {name!r}")
        return app

    def find_task(self, task_id: int) -> tuple[AppRecord, TaskRecord]:
        """Return a task by its id, with its application.

        Raises:
            CfeError: CFE_ES_ERR_RESOURCEID_NOT_VALID.
        """
        for app in self.apps:
            record = app.tasks.get(task_id)
            if record is not None:
                return app, record
        raise CfeError(CFE_ES_ERR_RESOURCEID_NOT_VALID, f"invalid task id 0x{task_id:x}")

    def history_of(self, name: str) -> AppHistory:
        """Return the history of an application name."""
        return self.history.setdefault(name, AppHistory(name))

"""The tables of Executive Services and what every part of it needs to look things up (cfe_es_resource.c)."""

from __future__ import annotations

from collections.abc import Callable

from cfepy.config import PlatformConfig
from cfepy.console import Console
from cfepy.es.pools import MemPool
from cfepy.es.records import SYSTEM_EARLY_INIT, AppHistory, AppRecord, Fault, LibRecord, Loader, TaskRecord
from cfepy.es.syslog import SystemLog
from cfepy.ids import ES_APPID_BASE, ES_LIBID_BASE, ES_POOLID_BASE, IdTable
from cfepy.osal import Osal
from cfepy.ports import Ports
from cfepy.rtos import Kernel
from cfepy.status import CFE_ES_ERR_NAME_NOT_FOUND, CFE_ES_ERR_RESOURCEID_NOT_VALID, CfeError


class EsCore:
    """State of Executive Services; the base of its parts.

    Args:
        kernel: the processor.
        ports: the other services.
        config: limits.
        osal: where tasks are made.
        console: where the system log shows.
        loader: finds the code of applications.
    """

    def __init__(
        self, kernel: Kernel, ports: Ports, config: PlatformConfig, osal: Osal, console: Console, loader: Loader
    ) -> None:
        self.kernel = kernel
        self.ports = ports
        self.config = config
        self.osal = osal
        self.console = console
        self.loader = loader
        self.syslog = SystemLog(ports, console, config.es_system_log_size)
        self.apps: IdTable[AppRecord] = IdTable(ES_APPID_BASE, config.es_max_applications)
        self.libs: IdTable[LibRecord] = IdTable(ES_LIBID_BASE, config.es_max_libraries)
        self.pools: IdTable[MemPool] = IdTable(ES_POOLID_BASE, config.es_max_memory_pools)
        self.pool_owners: dict[int, tuple[AppRecord | None, int]] = {}
        self.history: dict[str, AppHistory] = {}
        self.faults: list[Fault] = []
        self.system_state = SYSTEM_EARLY_INIT
        self.on_reset: Callable[[int, str], object] = lambda reset_type, reason: (
            None
        )  # the mission resets the processor

    def write_to_sys_log(self, text: str) -> None:
        """Add a line to the system log (CFE_ES_WriteToSysLog)."""
        self.syslog.write_to_sys_log(text)

    def app_of_caller(self) -> AppRecord | None:
        """The application of the running task, or None."""
        owner = self.kernel.current.owner
        return owner if isinstance(owner, AppRecord) else None

    def calling_app(self) -> AppRecord:
        """The application of the running task.

        Raises:
            CfeError: CFE_ES_ERR_RESOURCEID_NOT_VALID: the task belongs to none.
        """
        app = self.app_of_caller()
        if app is None:
            raise CfeError(CFE_ES_ERR_RESOURCEID_NOT_VALID, "the caller is not a task of an application")
        return app

    def app(self, app_id: int) -> AppRecord:
        """An application by its id.

        Raises:
            CfeError: CFE_ES_ERR_RESOURCEID_NOT_VALID.
        """
        return self.apps.get(app_id)

    def app_named(self, name: str) -> AppRecord | None:
        """An application by its name, or None."""
        return next((app for app in self.apps if app.name == name), None)

    def require_app_named(self, name: str) -> AppRecord:
        """An application by its name.

        Raises:
            CfeError: CFE_ES_ERR_NAME_NOT_FOUND.
        """
        app = self.app_named(name)
        if app is None:
            raise CfeError(CFE_ES_ERR_NAME_NOT_FOUND, f"no application is called {name!r}")
        return app

    def find_task(self, task_id: int) -> tuple[AppRecord, TaskRecord]:
        """A task by its id, with its application.

        Raises:
            CfeError: CFE_ES_ERR_RESOURCEID_NOT_VALID.
        """
        for app in self.apps:
            record = app.tasks.get(task_id)
            if record is not None:
                return app, record
        raise CfeError(CFE_ES_ERR_RESOURCEID_NOT_VALID, f"no task has the id 0x{task_id:x}")

    def history_of(self, name: str) -> AppHistory:
        """The history of an application name."""
        return self.history.setdefault(name, AppHistory(name))

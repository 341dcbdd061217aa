"""The boot of the executive (CFE_ES_Main, cfe_es_start.c): RAM disk, core services, startup script, state by state."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

from cfepy.es.records import (
    LATE_INIT,
    RUNNING,
    SYSTEM_APPS_INIT,
    SYSTEM_CORE_STARTUP,
    SYSTEM_OPERATIONAL,
    AppRecord,
    Entry,
    StartParams,
)
from cfepy.es.service import ExecutiveServices
from cfepy.es.startup_script import CFE_LIB, EXCEPTION_PROC_RESTART, BadLine, StartupEntry, parse
from cfepy.es.tables import EsCore
from cfepy.ports import SYSTEM_CORE_READY
from cfepy.psp import RST_TYPE_POWERON, RST_TYPE_PROCESSOR
from cfepy.status import CFE_ES_OPERATION_TIMED_OUT, CfeError, OsalError

MOUNT_POINT = "/ram"
NONVOL_STARTUP_FILE = "/cf/cfe_es_startup.scr"
VOLATILE_STARTUP_FILE = "/ram/cfe_es_startup.scr"
PANIC_CORE_APP = 6  # CFE_PSP_PANIC_CORE_APP
PANIC_DELAY_MS = 500
BOOT_SOURCE = 1  # the value that NASA's Linux PSP passes to CFE_ES_Main


def initialize_file_systems(es: EsCore, start_type: int) -> None:
    """Prepare the RAM disk.

    Args:
        es: provides the board and the limits.
        start_type: RST_TYPE_*.
    """
    if start_type == RST_TYPE_POWERON:
        _format(es)
        return
    stat = es.osal.file_sys_stat_volume(MOUNT_POINT)
    percent = stat.blocks_free * 100 // stat.total_blocks
    log = "CFE_ES_InitializeFileSystems: "
    es.write_to_sys_log(f"{log}Volatile Disk has {percent} Percent free space.")
    if percent < es.config.es_ram_disk_percent_reserved:
        es.write_to_sys_log(f"{log}Insufficient Free Space on Volatile Disk, Reformatting.")
        _format(es)


def _format(es: EsCore) -> None:
    es.osal.files.volume(MOUNT_POINT).clear()


class CoreApp(NamedTuple):
    """A core application of the object table."""

    name: str
    entry: Entry
    priority: int


class ObjectTable(NamedTuple):
    """The calls and core applications before any other application (cfe_es_objtab.c).

    `calls` are functions with their names in the log. `failed` is the log text for a failed call, with its name and
    status.
    """

    calls: Sequence[tuple[str, Callable[[], object]]]
    core_apps: Sequence[CoreApp]
    failed: str


class Boot:
    """A boot of the executive.

    Args:
        es: Executive Services.
        table: the object table.
        script: the bytes of the startup script.
        on_operational: called when the mission is operational.
    """

    def __init__(
        self,
        es: ExecutiveServices,
        table: ObjectTable,
        script: bytes,
        on_operational: Callable[[], object] = lambda: None,
    ) -> None:
        self.es = es
        self.table = table
        self.script = script
        self.on_operational = on_operational
        self.log = es.write_to_sys_log

    def main(self) -> None:
        """Run the main task of the processor."""
        start = self.es.psp.get_restart_type()
        self.es.setup_reset_variables(start.reset_type, start.subtype, BOOT_SOURCE)
        self.log("CFE_ES_Main: CFE_ES_Main in EARLY_INIT state")
        initialize_file_systems(self.es, start.reset_type)
        self.es.psp.attach_exceptions()
        self._enter(SYSTEM_CORE_STARTUP, "CORE_STARTUP")
        self._create_objects()
        self._enter(SYSTEM_CORE_READY, "CORE_READY")
        self.start_applications(start.reset_type)
        if not self._wait_for_apps(LATE_INIT):
            self.log("CFE_ES_Main: Startup Sync failed - Applications may not have all initialized")
        self._enter(SYSTEM_APPS_INIT, "APPS_INIT")
        if not self._wait_for_apps(RUNNING):
            self.log("CFE_ES_Main: Startup Sync failed - Applications may not have all started")
        self._enter(SYSTEM_OPERATIONAL, "OPERATIONAL")
        self.on_operational()

    def _enter(self, state: int, name: str) -> None:
        self.log(f"CFE_ES_Main: CFE_ES_Main entering {name} state")
        self.es.system_state = state

    def _create_objects(self) -> None:
        self.log("CFE_ES_CreateObjects: Starting Object Creation calls.")
        for name, call in self.table.calls:
            self.log(f"CFE_ES_CreateObjects: Calling {name}")
            try:
                call()
            except CfeError as error:
                self._panic(self.table.failed.format(name, error.hex), error)
        for core in self.table.core_apps:
            try:
                self._start_core_app(core)
            except CfeError as error:
                self._panic(f"OS_TaskCreate error creating core App: {core.name}: EC = {error.hex}", error)
        self.log("CFE_ES_CreateObjects: Finished ES CreateObject table entries.")

    def _start_core_app(self, core: CoreApp) -> None:
        """Start a core application and wait until it runs."""
        stack_size = self.es.config.es_start_task_stack_size
        params = StartParams("", "", stack_size, core.priority, EXCEPTION_PROC_RESTART)
        app = self.es.app(self.es.create_app(core.name, params, core.entry))
        if not self._wait_until_running(app):
            raise CfeError(CFE_ES_OPERATION_TIMED_OUT, f"{core.name} did not start in time")

    def _panic(self, text: str, cause: CfeError) -> None:
        """Report that the executive cannot continue, and call the board's panic function."""
        self.log(f"CFE_ES_CreateObjects: {text}")
        self.es.osal.task_delay(PANIC_DELAY_MS)
        self.es.psp.panic(PANIC_CORE_APP, cause)

    def start_applications(self, reset_type: int) -> None:
        """Start the libraries and applications of the startup script (CFE_ES_StartApplications).

        Args:
            reset_type: RST_TYPE_*; after a processor reset a script on the RAM disk comes first.
        """
        script = self._volatile_script() if reset_type == RST_TYPE_PROCESSOR else None
        file = VOLATILE_STARTUP_FILE if script is not None else NONVOL_STARTUP_FILE
        self.log(f"CFE_ES_StartApplications: Opened ES App Startup file: {file}")
        longest = self.es.config.release.longest_entry
        for entry in parse(self.script if script is None else script, longest):
            if isinstance(entry, BadLine):
                for text in entry.log_texts:
                    self.log(text)
            else:
                self._start(entry)

    def _volatile_script(self) -> bytes | None:
        try:
            return self.es.osal.files.read_file(VOLATILE_STARTUP_FILE)
        except OsalError:
            self.log(
                f"CFE_ES_StartApplications: Cannot Open Volatile Startup file: {VOLATILE_STARTUP_FILE}, "
                "Trying Nonvolatile."
            )
            return None

    def _start(self, entry: StartupEntry) -> None:
        self.log(entry.log_text)
        try:
            if entry.kind == CFE_LIB:
                self.es.load_library(entry.name, entry.path, entry.symbol)
            else:
                params = StartParams(entry.path, entry.symbol, entry.stack_size, entry.priority, entry.exception_action)
                self.es.create_app(entry.name, params)
        except CfeError:
            pass  # the error is in the system log; as in cFE, the next entry is tried

    def _wait_until_running(self, app: AppRecord) -> bool:
        return self._wait(self.es.config.es_core_max_startup_ms, lambda: app.state >= RUNNING)

    def _wait_for_apps(self, state: int) -> bool:
        return self._wait(self.es.config.es_startup_script_timeout_ms, lambda: self.es.reached(state))

    def _wait(self, limit_ms: int, done: Callable[[], bool]) -> bool:
        """Wait until `done` returns true, checking every 50 ms (CFE_ES_MainTaskSyncDelay); return False after the time
        limit.
        """
        waited = 0
        while not done():
            if waited >= limit_ms:
                return False
            self.es.osal.task_delay(self.es.config.es_startup_sync_poll_ms)
            waited += self.es.config.es_startup_sync_poll_ms
        return True

"""The background task of Executive Services (cfe_es_backgroundtask.c): application scan and exception scan."""

from __future__ import annotations

from cfepy.es.records import Fault
from cfepy.es.service import ExecutiveServices
from cfepy.es.startup_script import EXCEPTION_RESTART_APP
from cfepy.psp.psp import RST_TYPE_POWERON, RST_TYPE_PROCESSOR
from cfepy.rtos import Semaphore
from cfepy.rtos.units import NS_PER_MS
from cfepy.status import CfeError

TASK_NAME = "ES_BG_TASK"
STACK_SIZE = 4096
PRIORITY = 200
ACTIVE_SCAN_DIVISOR = 4  # while an application changes state, scans come four times as often


class BackgroundTask:
    """Looks after applications that end or failed, once a second or when woken."""

    def __init__(self, es: ExecutiveServices) -> None:
        self.es = es
        self.wakeup = Semaphore(es.kernel, 0, 1, TASK_NAME)
        self.exceptions = 0
        self.processor_resets = 0

    def main(self) -> None:
        """The child task."""
        es = self.es
        idle = es.config.es_app_scan_rate_ms
        last = es.kernel.now
        while True:
            elapsed = (es.kernel.now - last) // NS_PER_MS
            last = es.kernel.now
            active = es.scan_apps(elapsed)
            self.scan_exceptions()
            es.increment_task_counter()
            self.wakeup.take((idle // ACTIVE_SCAN_DIVISOR if active else idle) * NS_PER_MS)

    def wake(self) -> None:
        """Let the next scan come at once (CFE_ES_BackgroundWakeup)."""
        self.wakeup.give()

    def scan_exceptions(self) -> None:
        """Deal with tasks that died of an exception (CFE_ES_RunExceptionScan)."""
        faults, self.es.faults[:] = self.es.faults[:], []
        for fault in faults:
            self._handle(fault)

    def _handle(self, fault: Fault) -> None:
        es = self.es
        context = 0x1110000 + self.exceptions
        self.exceptions += 1
        es.write_to_sys_log(
            f"CFE_ES_RunExceptionScan: ExceptionID 0x{context:x} in TaskID {fault.task_id}: {fault.reason}"
        )
        app = fault.app
        if es.apps.find(app.app_id) is not app:
            return  # it was on its way out already: a `finally` block failed
        if app.params.exception_action == EXCEPTION_RESTART_APP and not app.is_core:
            try:
                es.restart_app(app.app_id)
                self.wake()
                return
            except CfeError:
                pass  # not running yet, or its file is gone: as in cFE, the processor resets instead
        limit = es.config.es_max_processor_resets
        if self.processor_resets >= limit:
            es.write_to_sys_log(f"CFE_ES_RunExceptionScan: Maximum Processor Reset count reached ({limit})")
            reset_type = RST_TYPE_POWERON
        else:
            reset_type = RST_TYPE_PROCESSOR
            es.write_to_sys_log(
                f"CFE_ES_RunExceptionScan: Processor Reset count not reached ({self.processor_resets}/{limit})"
            )
        es.on_reset(reset_type, f"{app.name}: {fault.reason}")

"""The exception scan (CFE_ES_RunExceptionScan): what becomes of an application whose task died; a background job."""

from __future__ import annotations

from cfepy.es import erlog
from cfepy.es.apps import AppServices
from cfepy.es.records import APP_RESTART, AppRecord
from cfepy.es.startup_script import EXCEPTION_RESTART_APP
from cfepy.psp.exceptions import ExceptionSummary
from cfepy.psp.psp import RST_SUBTYPE_EXCEPTION, RST_TYPE_POWERON, RST_TYPE_PROCESSOR
from cfepy.status import CfeError


class ExceptionScan:
    """Deals with one exception at a time.

    Args:
        es: the applications.
    """

    def __init__(self, es: AppServices) -> None:
        self._es = es

    def run(self, elapsed_ms: int) -> bool:
        """One call of the background task; whether there was an exception."""
        es = self._es
        if es.psp.exception_get_count() == 0:
            return False
        fault = es.psp.exception_get_summary()
        es.write_to_sys_log(
            f"CFE_ES_RunExceptionScan: ExceptionID 0x{fault.context_id:x} in TaskID {fault.task_id}: {fault.reason}"
        )
        faulty = next((each for each in es.faulty_apps if each[0] == fault.task_id), None)
        if faulty is not None:
            es.faulty_apps.remove(faulty)
            app = faulty[1]
            if es.apps.find(app.app_id) is app:  # else it failed while it was being ended anyway
                self._answer(app, fault)
        return True

    def _answer(self, app: AppRecord, fault: ExceptionSummary) -> None:
        """Restart the application, as its line in the startup script says; else, or if that fails, the processor."""
        reason = fault.reason
        if app.params.exception_action == EXCEPTION_RESTART_APP:
            self._log(erlog.APPLICATION, APP_RESTART, reason, app, fault)
            try:
                self._es.restart_app(app.app_id)
                return
            except CfeError:
                reason = "App Restart Failed"
        reset_type = self._count_reset()
        self._log(erlog.CORE, reset_type, reason, app, fault)
        self._es.psp.restart(reset_type, f"{app.name}: {fault.reason}", fault=True)

    def _log(self, entry_type: int, reset_type: int, reason: str, app: AppRecord, fault: ExceptionSummary) -> None:
        self._es.er_log.write(entry_type, reset_type, RST_SUBTYPE_EXCEPTION, reason, app.app_id, fault.context_id)

    def _count_reset(self) -> int:
        """The type of the reset: a power-on reset when there were too many processor resets."""
        variables = self._es.reset.variables
        count, limit = variables.processor_reset_count, variables.max_processor_reset_count
        log = "CFE_ES_RunExceptionScan: "
        if count >= limit:
            self._es.write_to_sys_log(f"{log}Maximum Processor Reset count reached ({limit})")
            return RST_TYPE_POWERON
        self._es.write_to_sys_log(f"{log}Processor Reset count not reached ({count}/{limit})")
        variables.processor_reset_count += 1
        variables.es_caused_reset = True
        return RST_TYPE_PROCESSOR

"""Exceptions that end tasks: stored at once, handled by the background task.

`TaskExceptionApi` passes an exception to the board's storage when it occurs (CFE_ES_ProcessAsyncEvent).
`ExceptionScan`, a background job, restarts the application or the processor (CFE_ES_RunExceptionScan).
"""

from __future__ import annotations

from pathlib import PurePath

from cfepy.es import erlog
from cfepy.es.apps import AppServices
from cfepy.es.erlog import MAX_CONTEXT
from cfepy.es.records import APP_RESTART, AppRecord, FailedTask
from cfepy.es.startup_script import EXCEPTION_RESTART_APP
from cfepy.es.tables import EsCore
from cfepy.ids import UNDEFINED
from cfepy.osal import Nobody
from cfepy.psp import RST_SUBTYPE_EXCEPTION, RST_TYPE_POWERON, RST_TYPE_PROCESSOR, ExceptionSummary
from cfepy.reading.texts import to_bytes
from cfepy.rtos import Task
from cfepy.status import CfeError


class TaskExceptionApi(EsCore):
    """The handling of an exception when it occurs."""

    def take_fault(self, task: Task, error: BaseException, reason: str) -> bool:
        """Store an exception that ended a task, and wake the background task to handle it.

        Args:
            task: the ended task.
            error: the exception.
            reason: a description of it.

        Returns:
            False if the task does not belong to the simulated computer, but to host code that acts as a task.
        """
        app = self._note_death(task.owner, error) if isinstance(task.owner, AppRecord) else None
        if app is None and not isinstance(task.owner, Nobody):
            return False
        if self.psp.store_exception(task.number, reason, _places(error)):
            self.failed_tasks.append(FailedTask(task.number, task.name, app))
        self.process_async_event()
        return True

    def _note_death(self, app: AppRecord, error: BaseException) -> AppRecord:
        app.error = error
        history = self.history_of(app.name)
        history.deaths += 1
        history.last_error = error
        history.failed_ns = self.kernel.now
        return app

    def process_async_event(self) -> None:
        """Wake the background task after an asynchronous event (CFE_ES_ProcessAsyncEvent)."""
        self.background_wakeup()


def _places(error: BaseException) -> bytes:
    """Return the files and lines that an exception passed through, the innermost first: "arm.py:13 main.py:7"."""
    places: list[str] = []
    trace = error.__traceback__
    while trace is not None:
        places.insert(0, f"{PurePath(trace.tb_frame.f_code.co_filename).name}:{trace.tb_lineno}")
        trace = trace.tb_next
    return to_bytes(" ".join(places))[:MAX_CONTEXT]


class ExceptionScan:
    """Handles one exception at a time.

    Args:
        es: the applications.
    """

    def __init__(self, es: AppServices) -> None:
        self._es = es

    def run(self, elapsed_ms: int) -> bool:
        """Run one call of the background task; return whether there was an exception."""
        es = self._es
        if es.psp.exception_get_count() == 0:
            return False
        fault = es.psp.exception_get_summary()
        es.write_to_sys_log(
            f"CFE_ES_RunExceptionScan: ExceptionID 0x{fault.context_id:x} in TaskID {fault.task_id}: {fault.reason}"
        )
        failed = next((each for each in es.failed_tasks if each.task_id == fault.task_id), None)
        if failed is not None:
            es.failed_tasks.remove(failed)
            app = failed.app
            if app is None:
                self._reset_processor(f"task {failed.name}", UNDEFINED, fault.reason, fault)
            elif es.apps.find(app.app_id) is app:  # otherwise it failed while it was being ended anyway
                self._answer(app, fault)
        return True

    def _answer(self, app: AppRecord, fault: ExceptionSummary) -> None:
        """Restart the application if its line in the startup script requests it; otherwise, or if that fails, reset the
        processor.
        """
        reason = fault.reason
        if app.params.exception_action == EXCEPTION_RESTART_APP:
            self._log(erlog.APPLICATION, APP_RESTART, reason, app.app_id, fault)
            try:
                self._es.restart_app(app.app_id)
                return
            except CfeError:
                reason = "App Restart Failed"
        self._reset_processor(app.name, app.app_id, reason, fault)

    def _reset_processor(self, who: str, app_id: int, logged: str, fault: ExceptionSummary) -> None:
        """Reset the processor for an exception.

        Args:
            who: the failed application or task, for reports.
            app_id: id of the application; UNDEFINED for a task without one.
            logged: text for the exception and reset log.
            fault: the exception.
        """
        reset_type = self._count_reset()
        self._log(erlog.CORE, reset_type, logged, app_id, fault)
        self._es.psp.restart(reset_type, f"{who}: {fault.reason}", fault=True)

    def _log(self, entry_type: int, reset_type: int, reason: str, app_id: int, fault: ExceptionSummary) -> None:
        self._es.er_log.write(entry_type, reset_type, RST_SUBTYPE_EXCEPTION, reason, app_id, fault.context_id)

    def _count_reset(self) -> int:
        """Count the reset and return its type: a power-on reset after too many processor resets."""
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

"""Exceptions that end tasks: stored at once, answered by the background task.

`TaskExceptionApi` hands an exception to the board's storage when it happens (CFE_ES_ProcessAsyncEvent);
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
    """What becomes of an exception at the moment it happens."""

    def take_fault(self, task: Task, error: BaseException, reason: str) -> bool:
        """An exception came out of a task: store it, and let the background task deal with it.

        Args:
            task: that died.
            error: the exception.
            reason: the same in words.

        Returns:
            False: the task is none of the simulated computer's: host code that plays a task.
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
        """Something happened that the background task has to see at once (CFE_ES_ProcessAsyncEvent)."""
        self.background_wakeup()


def _places(error: BaseException) -> bytes:
    """Files and lines that an exception went through, innermost first: "arm.py:13 main.py:7"."""
    places: list[str] = []
    trace = error.__traceback__
    while trace is not None:
        places.insert(0, f"{PurePath(trace.tb_frame.f_code.co_filename).name}:{trace.tb_lineno}")
        trace = trace.tb_next
    return to_bytes(" ".join(places))[:MAX_CONTEXT]


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
        failed = next((each for each in es.failed_tasks if each.task_id == fault.task_id), None)
        if failed is not None:
            es.failed_tasks.remove(failed)
            app = failed.app
            if app is None:
                self._reset_processor(f"task {failed.name}", UNDEFINED, fault.reason, fault)
            elif es.apps.find(app.app_id) is app:  # else it failed while it was being ended anyway
                self._answer(app, fault)
        return True

    def _answer(self, app: AppRecord, fault: ExceptionSummary) -> None:
        """Restart the application, as its line in the startup script says; else, or if that fails, the processor."""
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
            who: failed, in the words of reports.
            app_id: of the application; UNDEFINED for a task without one.
            logged: what the exception and reset log says.
            fault: the exception.
        """
        reset_type = self._count_reset()
        self._log(erlog.CORE, reset_type, logged, app_id, fault)
        self._es.psp.restart(reset_type, f"{who}: {fault.reason}", fault=True)

    def _log(self, entry_type: int, reset_type: int, reason: str, app_id: int, fault: ExceptionSummary) -> None:
        self._es.er_log.write(entry_type, reset_type, RST_SUBTYPE_EXCEPTION, reason, app_id, fault.context_id)

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

"""Exceptions that end tasks: handed to the board's storage, and to the background task (CFE_ES_ProcessAsyncEvent)."""

from __future__ import annotations

from pathlib import PurePath

from cfepy.es.erlog import MAX_CONTEXT
from cfepy.es.records import AppRecord
from cfepy.es.tables import EsCore
from cfepy.rtos import Task


class FaultApi(EsCore):
    """What becomes of an exception at the moment it happens."""

    def take_fault(self, task: Task, error: BaseException, reason: str) -> bool:
        """An exception came out of a task: store it, and let the background task deal with it.

        Args:
            task: that died.
            error: the exception.
            reason: the same in words.

        Returns:
            False: the task was no application's.
        """
        app = task.owner
        if not isinstance(app, AppRecord):
            return False
        app.error = error
        history = self.history_of(app.name)
        history.deaths += 1
        history.last_error = error
        if self.psp.store_exception(task.number, reason, _places(error)):
            self.faulty_apps.append((task.number, app))
        self.process_async_event()
        return True

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
    return " ".join(places).encode("utf-8", "replace")[:MAX_CONTEXT]

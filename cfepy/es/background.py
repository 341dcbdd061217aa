"""The background task of Executive Services (cfe_es_backgroundtask.c): jobs that take turns at low priority.

One of the jobs is in this module: the scan for applications that end or should end (CFE_ES_RunAppTableScan).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

from cfepy.es.apps import AppEnd
from cfepy.es.info import InfoApi
from cfepy.es.records import APP_RUN, RUNNING, WAITING, AppRecord
from cfepy.units import NS_PER_MS

TASK_NAME = "ES_BG_TASK"
STACK_SIZE = 4096
PRIORITY = 200
MAX_IDLE_DELAY_MS = 30000


class Job(NamedTuple):
    """A job that is called repeatedly.

    `run` gets the ms since the last call and returns whether there is more to do. `active_ms` and `idle_ms` are the
    times to the next call if there is or is not.
    """

    run: Callable[[int], bool]
    active_ms: int
    idle_ms: int


class BackgroundTask:
    """Calls its jobs when they are due, and all of them when it is woken.

    Args:
        es: the services that own the task.
        jobs: the jobs, in the order of the calls.
    """

    def __init__(self, es: InfoApi, jobs: Sequence[Job]) -> None:
        self._es = es
        self._jobs = jobs

    def main(self) -> None:
        """Run the child task."""
        es = self._es
        last = es.kernel.now
        while True:
            elapsed = (es.kernel.now - last) // NS_PER_MS
            last = es.kernel.now
            pauses = [job.active_ms if job.run(elapsed) else job.idle_ms for job in self._jobs]
            es.background_wait(min(pauses, default=MAX_IDLE_DELAY_MS))


class AppScan:
    """Scans once per scan period, at once after a command, and at every call while an application ends.

    Args:
        es: the applications.
        command_count: returns the number of accepted commands.
    """

    def __init__(self, es: AppEnd, command_count: Callable[[], int]) -> None:
        self._es = es
        self._command_count = command_count
        self._last_count = 0
        self._timer_ms = 0
        self._pending = False

    def run(self, elapsed_ms: int) -> bool:
        """Run one call of the background task; return whether an application is about to end."""
        config, count = self._es.config, self._command_count()
        if not self._pending and count == self._last_count and self._timer_ms > elapsed_ms:
            self._timer_ms -= elapsed_ms
            return False
        self._timer_ms, self._last_count = config.es_app_scan_rate_ms, count
        external = [app for app in self._es.apps if not app.is_core]
        ending = [app for app in external if app.state > RUNNING]
        self._pending = bool(ending)
        for app in external:
            if app.state == RUNNING and app.control_request != APP_RUN:
                app.state = WAITING
                app.timer_ms = config.es_app_kill_timeout * config.es_app_scan_rate_ms
        for app in [app for app in ending if _is_over(app, elapsed_ms)]:
            self._es.process_control_request(app)
        return self._pending


def _is_over(app: AppRecord, elapsed_ms: int) -> bool:
    """Return whether an application's time to end has passed."""
    app.timer_ms = max(0, app.timer_ms - elapsed_ms)
    return app.timer_ms == 0

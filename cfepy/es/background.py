"""The background task of Executive Services (cfe_es_backgroundtask.c): jobs that take turns at low priority."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

from cfepy.es.info import InfoApi
from cfepy.rtos.units import NS_PER_MS

TASK_NAME = "ES_BG_TASK"
STACK_SIZE = 4096
PRIORITY = 200
MAX_IDLE_DELAY_MS = 30000


class Job(NamedTuple):
    """Something to call again and again.

    `run` gets the ms that passed since the last call and says whether there is more to do; `active_ms` and `idle_ms`
    are how soon it wants to be called again then.
    """

    run: Callable[[int], bool]
    active_ms: int
    idle_ms: int


class BackgroundTask:
    """Calls its jobs when one of them wants to be called, and all of them when woken.

    Args:
        es: whose task it is.
        jobs: in the order in which they are called.
    """

    def __init__(self, es: InfoApi, jobs: Sequence[Job]) -> None:
        self._es = es
        self._jobs = jobs

    def main(self) -> None:
        """The child task."""
        es = self._es
        last = es.kernel.now
        while True:
            elapsed = (es.kernel.now - last) // NS_PER_MS
            last = es.kernel.now
            pauses = [job.active_ms if job.run(elapsed) else job.idle_ms for job in self._jobs]
            es.background_wait(min(pauses, default=MAX_IDLE_DELAY_MS))

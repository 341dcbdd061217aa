"""The OSAL objects that cFE and the PSP make for themselves, with NASA's names, in the order of their ids.

They count against OSAL's limits, take names and ids, and OS_ForEachObject reports them. Nothing in cfepy waits for
them: cfepy's services run between two calls of the kernel, so they need no mutexes.

Observed on NASA's cFE 7.0.1 on Linux, with OS_ForEachObject. The queues of pipes and the modules of applications come
later, with their owners.
"""

from __future__ import annotations

from cfepy.osal.locks import MutexApi, OsMutex
from cfepy.osal.semaphores import OsSemaphore, SemaphoreApi
from cfepy.osal.timers import OsTimer, TimerApi
from cfepy.rtos import Mutex, Semaphore

MUTEXES = (
    *(f"DriverMutex-{number:02}" for number in range(1, 8)),
    "ES_DATA_MUTEX",
    "ES_PERF_MUTEX",
    "CDS_MUTEX",
    "CFE_EVS_DataMutex",
    "CFE_FS_SharedMutex",
    "CFE_SB_DataMutex",
    "TBL_REG_MUT",
    "TBL_WRK_MUT",
)
"""The mutexes of the PSP's drivers and of cFE's services. The next one is the mutex of the table services' pool."""

BINARY_SEMAPHORES = ("ES_BG_SEM", "TIME_TONE_SEM", "TIME_ONEHZ_SEM")
"""The semaphores of the background task and of Time Services."""

ONE_HZ_TIMER = "cFS-1Hz"
ONE_HZ_US = 1_000_000


class CoreObjectApi(SemaphoreApi, MutexApi, TimerApi):
    """Adds these objects; a mission calls it once for each start of a processor."""

    def add_core_objects(self) -> None:
        """Add the mutexes and semaphores."""
        for name in MUTEXES:
            self._reserve(self._mutexes, OsMutex(name, Mutex(self.kernel, name, stays_locked=not self.config.safe)))
        for name in BINARY_SEMAPHORES:
            self._reserve(self._bin_sems, OsSemaphore(name, Semaphore(self.kernel, 0, 1, name)))

    def add_one_hz_timer(self, timebase_id: int) -> None:
        """Add the timer of Time Services to the time base of the PSP. It never expires: TIME keeps its own seconds."""
        timebase = self._time_base(timebase_id)
        timer = self._reserve(self._timers, OsTimer(ONE_HZ_TIMER, timebase, lambda _: None, False))
        timer.interval_us = ONE_HZ_US
        timebase.timers.append(timer)

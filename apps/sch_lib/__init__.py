"""SCH's library: lets other apps hold the schedule temporarily (sch_api.c).

An app finds a function with `cfe.os.symbol_lookup` and calls it with its own handle. The number of holds is the value
of a counting semaphore, which is the library's only state.
"""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.osal import OS_CHECK
from cfepy.status import CFE_SUCCESS

SEMAPHORE = "SCH_LIB"


def SCH_LibInit(cfe: Cfe) -> int:
    """Return the init function that the startup script names: the schedule is not held."""
    cfe.os.count_sem_create(SEMAPHORE, 0)
    return CFE_SUCCESS


def SCH_DisableProcessing(cfe: Cfe) -> None:
    """Hold the schedule until `SCH_EnableProcessing` was called as often as this."""
    cfe.os.count_sem_give(cfe.os.count_sem_get_id_by_name(SEMAPHORE))


def SCH_EnableProcessing(cfe: Cfe) -> None:
    """Release one hold, if there is one."""
    cfe.os.count_sem_timed_wait(cfe.os.count_sem_get_id_by_name(SEMAPHORE), OS_CHECK)


def SCH_GetProcessingState(cfe: Cfe) -> bool:
    """Return whether the schedule is running."""
    return cfe.os.count_sem_get_info(cfe.os.count_sem_get_id_by_name(SEMAPHORE)).value == 0

"""SCH's library: lets other apps hold the schedule for a while (sch_api.c).

An app finds a function with `cfe.os.symbol_lookup` and calls it with its own handle. How often the schedule is held is
the value of a counting semaphore, which is all that the library keeps.
"""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.osal import OS_CHECK
from cfepy.status import CFE_SUCCESS

SEMAPHORE = "SCH_LIB"


def SCH_LibInit(cfe: Cfe) -> int:
    """The init function that the startup script names: the schedule is not held."""
    cfe.os.count_sem_create(SEMAPHORE, 0)
    return CFE_SUCCESS


def SCH_DisableProcessing(cfe: Cfe) -> None:
    """Hold the schedule until `SCH_EnableProcessing` was called as often as this."""
    cfe.os.count_sem_give(cfe.os.count_sem_get_id_by_name(SEMAPHORE))


def SCH_EnableProcessing(cfe: Cfe) -> None:
    """Take one hold back; nothing happens when there is none."""
    cfe.os.count_sem_timed_wait(cfe.os.count_sem_get_id_by_name(SEMAPHORE), OS_CHECK)


def SCH_GetProcessingState(cfe: Cfe) -> bool:
    """Whether the schedule goes on."""
    return cfe.os.count_sem_get_info(cfe.os.count_sem_get_id_by_name(SEMAPHORE)).value == 0

"""OS_BinSem*, OS_CountSem*, OS_MutSem*: semaphores and mutexes for C.

Tasks could pass the processor to each other forever with these calls, so each call costs virtual time.
"""

from __future__ import annotations

from struct import Struct
from typing import TYPE_CHECKING

from cfepy.extra.c.api.osal_values import BAD, NAMED, in_time, new_id, properties
from cfepy.status import OS_INVALID_SEM_VALUE, OS_SEM_TIMEOUT

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

SEMAPHORE_INFO = Struct("<20sIi")
"""OS_bin_sem_prop_t and OS_count_sem_prop_t."""


def declare(api: Declarations, c: CRuntime) -> None:
    _declare_binary(api, c)
    _declare_counting(api, c)
    _declare_mutexes(api, c)


def _declare_binary(api: Declarations, c: CRuntime) -> None:
    os = c.handle.os
    api.add("OS_BinSemCreate", "=4SiI", new_id(os.bin_sem_create, OS_INVALID_SEM_VALUE), BAD)
    api.add("OS_BinSemFlush", "$I", os.bin_sem_flush)
    api.add("OS_BinSemGive", "$I", os.bin_sem_give)
    api.add("OS_BinSemTake", "$I", os.bin_sem_take)
    api.add("OS_BinSemTimedWait", "$II", in_time(os.bin_sem_timed_wait, OS_SEM_TIMEOUT))
    api.add("OS_BinSemDelete", "I", os.bin_sem_delete)
    api.add("OS_BinSemGetIdByName", "$4S", os.bin_sem_get_id_by_name, BAD)
    api.add("OS_BinSemGetInfo", "$IP", properties(c.memory, SEMAPHORE_INFO, os.bin_sem_get_info), BAD)


def _declare_counting(api: Declarations, c: CRuntime) -> None:
    os = c.handle.os
    api.add("OS_CountSemCreate", "=4SiI", new_id(os.count_sem_create, OS_INVALID_SEM_VALUE), BAD)
    api.add("OS_CountSemGive", "$I", os.count_sem_give)
    api.add("OS_CountSemTake", "$I", os.count_sem_take)
    api.add("OS_CountSemTimedWait", "$II", in_time(os.count_sem_timed_wait, OS_SEM_TIMEOUT))
    api.add("OS_CountSemDelete", "I", os.count_sem_delete)
    api.add("OS_CountSemGetIdByName", "$4S", os.count_sem_get_id_by_name, BAD)
    api.add("OS_CountSemGetInfo", "$IP", properties(c.memory, SEMAPHORE_INFO, os.count_sem_get_info), BAD)


def _declare_mutexes(api: Declarations, c: CRuntime) -> None:
    os = c.handle.os
    api.add("OS_MutSemCreate", "4SI", os.mut_sem_create, BAD)
    api.add("OS_MutSemGive", "$I", os.mut_sem_give)
    api.add("OS_MutSemTake", "$I", os.mut_sem_take)
    api.add("OS_MutSemDelete", "I", os.mut_sem_delete)
    api.add("OS_MutSemGetIdByName", "$4S", os.mut_sem_get_id_by_name, BAD)
    api.add("OS_MutSemGetInfo", "$IP", properties(c.memory, NAMED, os.mut_sem_get_info), BAD)

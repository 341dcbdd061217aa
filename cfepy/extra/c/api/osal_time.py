"""OS_GetLocalTime and related functions, OS_TimeBase*, OS_Timer*: the clock, time bases and timers for C.

Code may wait by reading a clock repeatedly, so each reading costs virtual time. Other functions for an OS_time_t are
inline functions of its header. Callbacks run in the task of the time base.
"""

from __future__ import annotations

from struct import Struct
from typing import TYPE_CHECKING

from cfepy.extra.c.api.osal_values import BAD, properties
from cfepy.osal import OsTime

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

INFO = Struct("<20sIIII")
"""OS_timebase_prop_t: nominal interval, free run time, accuracy. OS_timer_prop_t: start, interval, accuracy. In us."""
_32_BITS = 0xFFFFFFFF


def declare(api: Declarations, c: CRuntime) -> None:
    _declare_clock(api, c)
    _declare_time_bases(api, c)
    _declare_timers(api, c)


def _declare_clock(api: Declarations, c: CRuntime) -> None:
    os, memory = c.handle.os, c.memory

    def set_local_time(time: int) -> None:
        os.set_local_time(OsTime(memory.i64(time)))

    def to_relative(time: int) -> int:
        return os.time_to_relative_milliseconds(OsTime(time))

    api.add("OS_GetMonotonicTime", "$8", os.get_monotonic_time, BAD)
    api.add("OS_GetLocalTime", "$8", os.get_local_time, BAD)
    api.add("OS_SetLocalTime", "P", set_local_time, BAD)
    api.add("OS_TimeFromRelativeMilliseconds", "$i", os.time_from_relative_milliseconds)
    api.add("OS_TimeToRelativeMilliseconds", "$q", to_relative)


def _declare_time_bases(api: Declarations, c: CRuntime) -> None:
    os = c.handle.os

    def create(name: str, sync: int) -> int:
        return os.time_base_create(name, (lambda base_id: c.run(sync, base_id) & _32_BITS) if sync else None)

    def free_run(base_id: int, at: int) -> None:
        c.memory.put_u32(at, os.time_base_get_free_run(base_id))

    api.add("OS_TimeBaseCreate", "4Sp", create, BAD)
    api.add("OS_TimeBaseSet", "III", os.time_base_set)
    api.add("OS_TimeBaseDelete", "I", os.time_base_delete)
    api.add("OS_TimeBaseGetIdByName", "$4S", os.time_base_get_id_by_name, BAD)
    api.add("OS_TimeBaseGetInfo", "$IP", properties(c.memory, INFO, os.time_base_get_info), BAD)
    api.add("OS_TimeBaseGetFreeRun", "$IP", free_run, BAD)


def _declare_timers(api: Declarations, c: CRuntime) -> None:
    os = c.handle.os

    def create(name: str, callback: int) -> tuple[int, int]:
        timer_id = os.timer_create(name, lambda expired: c.run(callback, expired))
        return timer_id, os.timer_get_info(timer_id).accuracy

    def add(name: str, base_id: int, callback: int, argument: int) -> int:
        return os.timer_add(name, base_id, lambda timer_id, arg: c.run(callback, timer_id, arg), argument)

    api.add("OS_TimerCreate", "4S4P", create, BAD)
    api.add("OS_TimerAdd", "4SIPp", add, BAD)
    api.add("OS_TimerSet", "III", os.timer_set)
    api.add("OS_TimerDelete", "I", os.timer_delete)
    api.add("OS_TimerGetIdByName", "$4S", os.timer_get_id_by_name, BAD)
    api.add("OS_TimerGetInfo", "$IP", properties(c.memory, INFO, os.timer_get_info), BAD)

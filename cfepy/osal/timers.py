"""OSAL timers (OS_Timer*): callbacks at the ticks of a time base, once or periodically.

May import cfepy.rtos, ids, status and its neighbours in cfepy.osal.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from cfepy.ids import OS_TIMECB_BASE
from cfepy.osal.core import ObjectTable, Setup
from cfepy.osal.timebases import OsTimeBase, OsTimer, TimeBaseApi
from cfepy.status import OS_INVALID_POINTER, OS_TIMER_ERR_INVALID_ARGS, OsalError

TIMER_LIMIT_US = 0x7FFFFFFF


class TimerInfo(NamedTuple):
    """What `timer_get_info` tells (OS_timer_prop_t); times in us."""

    name: str
    creator: int
    start_time: int
    interval_time: int
    accuracy: int


class TimerApi(TimeBaseApi):
    """The OS_Timer* functions."""

    def __init__(self, setup: Setup) -> None:
        super().__init__(setup)
        self._timers: ObjectTable[OsTimer] = self._table("timer", OS_TIMECB_BASE, setup.config.os_max_timers)

    def timer_create(self, name: str, callback: Callable[[int], object]) -> int:
        """Make a timer with a time base of its own (OS_TimerCreate).

        NASA's clock_accuracy is in `timer_get_info`.

        Args:
            name: unique among timers and among time bases, at most 19 characters.
            callback: called with the timer's id at every expiry, in the task of the time base: it must not wait.

        Returns:
            The timer's id.

        Raises:
            OsalError: OS_INVALID_POINTER, OS_ERR_NAME_TOO_LONG, OS_ERR_NAME_TAKEN, OS_ERR_NO_FREE_IDS, or
                OS_ERR_INCORRECT_OBJ_STATE in a timer callback.
        """
        _check_callback(callback)
        timebase_id = self.time_base_create(name)
        try:
            return self._add(name, self._time_base(timebase_id), callback, True)
        except OsalError:
            self.time_base_delete(timebase_id)
            raise

    def timer_add(
        self, name: str, timebase_id: int, callback: Callable[[int, Any], object], callback_arg: Any = None
    ) -> int:
        """Make a timer on an existing time base (OS_TimerAdd).

        Args:
            name: unique among timers, at most 19 characters.
            timebase_id: the time base.
            callback: called with the timer's id and `callback_arg` at every expiry; it must not wait.
            callback_arg: handed to the callback.

        Returns:
            The timer's id.

        Raises:
            OsalError: as `timer_create`, and OS_ERR_INVALID_ID.
        """
        _check_callback(callback)
        self._timers.check_name(name)
        self._refuse_in_callback("OS_TimerAdd")
        return self._add(name, self._time_base(timebase_id), lambda timer_id: callback(timer_id, callback_arg), False)

    def timer_set(self, timer_id: int, start_time: int, interval_time: int) -> None:
        """Start a timer (OS_TimerSet).

        Args:
            timer_id: the timer.
            start_time: us until the first expiry, rounded up to a tick; 0 for one interval.
            interval_time: us between expiries; 0 for one expiry only.

        Raises:
            OsalError: OS_TIMER_ERR_INVALID_ARGS, OS_ERR_INVALID_ID, OS_ERR_INCORRECT_OBJ_STATE in a timer callback.
        """
        if self._cost:
            self.kernel.charge(self._cost)
        valid = 0 <= start_time < TIMER_LIMIT_US and 0 <= interval_time < TIMER_LIMIT_US
        if not valid or not (start_time or interval_time):
            raise OsalError(OS_TIMER_ERR_INVALID_ARGS, f"timer of {start_time} us, then every {interval_time} us")
        self._refuse_in_callback("OS_TimerSet")
        timer = self._timer(timer_id)
        timer.start_us, timer.interval_us = start_time, interval_time
        timer.due = timer.timebase.freerun() + (start_time or interval_time)
        if timer.dedicated:
            self.time_base_set(timer.timebase.id, start_time, interval_time)
        else:
            timer.timebase.poke()

    def timer_delete(self, timer_id: int) -> None:
        """Delete a timer, and its time base if that is its own (OS_TimerDelete).

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERR_INCORRECT_OBJ_STATE in a timer callback.
        """
        self._refuse_in_callback("OS_TimerDelete")
        timer = self._timer(timer_id)
        self._unregister(self._timers, timer)
        timer.timebase.timers.remove(timer)
        if timer.dedicated:
            self.time_base_delete(timer.timebase.id)

    def timer_get_id_by_name(self, name: str) -> int:
        """Id of a named timer (OS_TimerGetIdByName).

        Raises:
            OsalError: OS_ERR_NAME_NOT_FOUND, OS_ERR_NAME_TOO_LONG, OS_ERR_INCORRECT_OBJ_STATE in a timer callback.
        """
        self._refuse_in_callback("OS_TimerGetIdByName")
        return self._timers.named(name)

    def timer_get_info(self, timer_id: int) -> TimerInfo:
        """Facts about a timer (OS_TimerGetInfo).

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERR_INCORRECT_OBJ_STATE in a timer callback.
        """
        self._refuse_in_callback("OS_TimerGetInfo")
        timer = self._timer(timer_id)
        accuracy = 0 if timer.timebase.sync is not None else self._accuracy_us
        return TimerInfo(timer.name, timer.creator, timer.start_us, timer.interval_us, accuracy)

    def _add(self, name: str, timebase: OsTimeBase, callback: Callable[[int], object], dedicated: bool) -> int:
        timer = OsTimer(name, timebase, callback, dedicated)
        timer_id = self._register(self._timers, timer, "timer", self._setup.sizes.timer)
        timebase.timers.insert(0, timer)
        return timer_id

    def _timer(self, timer_id: int) -> OsTimer:
        timer = self._timers.lookup(timer_id)
        if timer is None:
            raise self._timers.missing(timer_id)
        return timer


def _check_callback(callback: object) -> None:
    if not callable(callback):
        raise OsalError(OS_INVALID_POINTER, f"a timer's callback must be callable, not {callback!r}")

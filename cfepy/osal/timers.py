"""OSAL time bases and timers (OS_TimeBase*, OS_Timer*): sources of ticks, and callbacks at ticks, once or periodically.

Each time base has a task that runs the callbacks of its timers. The task has the highest priority (0) and is tickless:
it sleeps until the tick at which its next timer is due. So an idle time base costs nothing, and ticks are counted from
the clock. A time base with its own sync function follows the return value of that function instead.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from cfepy.ids import OS_TIMEBASE_BASE, OS_TIMECB_BASE
from cfepy.osal.core import NOBODY, Core, OsObject, OsObjectTable, Setup
from cfepy.rtos import FOREVER, Kernel, Task, WaitList
from cfepy.status import OS_ERR_OBJECT_IN_USE, OS_INVALID_POINTER, OS_TIMER_ERR_INVALID_ARGS, OsalError
from cfepy.units import NS_PER_MS, NS_PER_US

TIMEBASE_PRIORITY = 0
TIMEBASE_LIMIT_US = 1_000_000_000
FREERUN_MASK = 0xFFFFFFFF
IDLE_SYNCS = 4  # a sync function may return 0 this often in a row before it is slowed down
SLOW_SYNC_MS = 10
TIMER_LIMIT_US = 0x7FFFFFFF
LINUX_TICK_US = 10_000
"""The tick that NASA's OSAL reports on Linux (_SC_CLK_TCK), though its timers are finer."""
US_PER_SECOND = 1_000_000


class TimeBaseInfo(NamedTuple):
    """The result of `time_base_get_info` (OS_timebase_prop_t); times in us."""

    name: str
    creator: int
    nominal_interval_time: int
    freerun_time: int
    accuracy: int


class OsTimer(OsObject):
    """The record of a timer; see `cfepy.osal.timers`."""

    __slots__ = ("backlog_resets", "callback", "dedicated", "due", "interval_us", "timebase")

    def __init__(self, name: str, timebase: OsTimeBase, callback: Callable[[int], object], dedicated: bool) -> None:
        super().__init__(name)
        self.timebase = timebase
        self.callback = callback
        self.dedicated = dedicated
        self.interval_us = 0
        self.due: int | None = None  # free run time of the time base at which it expires
        self.backlog_resets = 0

    def expire(self, freerun: int) -> None:
        """Run the callback as often as it is due, and set the next expiry.

        An interval shorter than the time base's leads to several calls at one tick, but a backlog is at most one
        interval.
        """
        if self.due is None or self.due > freerun:
            return
        left, calls = self.due - freerun, 0
        while left <= 0:
            calls += 1
            if not self.interval_us:
                break
            left += self.interval_us
            if left < -self.interval_us:
                self.backlog_resets += 1
                left = -self.interval_us
        self.due = freerun + left if self.interval_us else None
        for _ in range(calls):
            if not self.deleted:
                self.callback(self.id)


class OsTimeBase(OsObject):
    """The record of a time base. It ticks at `first_ns`, then every `interval_us`."""

    __slots__ = (
        "accuracy_us",
        "base",
        "first_ns",
        "interval_us",
        "kernel",
        "start_us",
        "sync",
        "task",
        "timers",
        "waits",
        "wakes_at",
    )

    def __init__(self, name: str, kernel: Kernel, sync: Callable[[int], int] | None) -> None:
        super().__init__(name)
        tick_us = kernel.tick_ns // NS_PER_US if kernel.tick_ns else LINUX_TICK_US
        self.accuracy_us = 0 if sync is not None else max(1, tick_us)
        self.kernel = kernel
        self.sync = sync
        self.timers: list[OsTimer] = []  # newest first, as in NASA's ring
        self.start_us = 0
        self.interval_us = 0
        self.first_ns = 0
        self.base = 0  # free run time before the tick at `first_ns`
        self.waits = WaitList(f"timer of time base {name}")
        self.wakes_at: int | None = None
        self.task: Task | None = None

    def set(self, start_us: int, interval_us: int) -> None:
        """Start to tick, first after `start_us`; 0 stops the ticks, as a POSIX timer does."""
        self.base = self.freerun()
        self.start_us = start_us
        self.interval_us = interval_us
        if self.sync is None and not self.kernel.tick_ns:  # as NASA's for Linux: the interval without whole seconds
            self.accuracy_us = (interval_us or start_us) % US_PER_SECOND
        self.first_ns = self.kernel.now + self.start_us * NS_PER_US
        self.poke()

    def freerun(self) -> int:
        """Return the time of the ticks so far, in us."""
        since = self.kernel.now - self.first_ns
        if self.sync is not None or not self.start_us or since < 0:
            return self.base
        ticks = since // (self.interval_us * NS_PER_US) if self.interval_us else 0
        return self.base + self.start_us + ticks * self.interval_us

    def instant_of(self, freerun: int) -> int | None:
        """Return the virtual time of the first tick with a free run time of at least `freerun`, in ns; None
        for never.
        """
        beyond = freerun - self.base - self.start_us
        if not self.start_us:
            return None
        if beyond <= 0:
            return self.first_ns
        if not self.interval_us:
            return None
        return self.first_ns - (-beyond // self.interval_us) * self.interval_us * NS_PER_US

    def next_instant(self) -> int | None:
        """Return the virtual time at which the next timer is due, in ns."""
        instants = [self.instant_of(timer.due) for timer in self.timers if timer.due is not None]
        return min((instant for instant in instants if instant is not None), default=None)

    def poke(self) -> None:
        """Wake the task after a change of a timer or the ticks, if it would sleep too long."""
        instant = self.next_instant()
        if instant is not None and (self.wakes_at is None or instant < self.wakes_at):
            self.kernel.wake_first(self.waits)

    def expire(self, freerun: int) -> None:
        """Run the callbacks that are due. An error in one belongs to its application, and stops only that timer."""
        task = self.kernel.current
        for timer in tuple(self.timers):
            try:
                timer.expire(freerun)
            except (Exception, SystemExit) as error:
                timer.due = None
                task.owner = timer.owner
                if not self.kernel.on_task_error(task, error):
                    raise
                task.owner = NOBODY

    def run_by_clock(self) -> None:
        """Run the task of a time base that follows the kernel's clock."""
        kernel = self.kernel
        while not self.deleted:
            self.wakes_at = instant = self.next_instant()
            if instant is None:
                kernel.wait_on(self.waits, FOREVER)
            elif instant > kernel.now:
                kernel.wait_on(self.waits, instant - kernel.now)
            else:
                self.expire(self.freerun())

    def run_by_sync(self, sync: Callable[[int], int]) -> None:
        """Run the task of a time base with a sync function, which waits and returns the elapsed us."""
        idle = 0
        while not self.deleted:
            elapsed = sync(self.id)
            idle = 0 if elapsed else idle + 1
            if idle > IDLE_SYNCS:
                self.kernel.delay(SLOW_SYNC_MS * NS_PER_MS)
            self.base += elapsed
            self.expire(self.base)


class TimeBaseApi(Core):
    """The OS_TimeBase* functions."""

    def __init__(self, setup: Setup) -> None:
        super().__init__(setup)
        self._time_bases: OsObjectTable[OsTimeBase] = self._table(
            "time base", OS_TIMEBASE_BASE, setup.config.os_max_timebases
        )

    def time_base_create(self, name: str, external_sync: Callable[[int], int] | None = None) -> int:
        """Make a time base (OS_TimeBaseCreate).

        Args:
            name: unique among time bases, at most 19 characters.
            external_sync: called with the id repeatedly in the time base's task; it waits for the next tick and returns
                the elapsed us. None follows the kernel's clock.

        Returns:
            The time base's id.

        Raises:
            OsalError: OS_ERR_NAME_TOO_LONG, OS_ERR_NAME_TAKEN, OS_ERR_NO_FREE_IDS, or OS_ERR_INCORRECT_OBJ_STATE in a
                timer callback.
        """
        self._refuse_in_callback("OS_TimeBaseCreate")
        record = OsTimeBase(name, self.kernel, external_sync)
        time_base_id = self._register(self._time_bases, record, "time base", self._setup.sizes.timer)
        record.task = self.kernel.spawn(name, lambda: self._serve(record), TIMEBASE_PRIORITY)
        return time_base_id

    def time_base_set(self, timebase_id: int, start_time: int, interval_time: int) -> None:
        """Start the ticks of a time base (OS_TimeBaseSet).

        Args:
            timebase_id: the time base.
            start_time: us until the first tick; with 0 it never ticks, as on NASA's Linux.
            interval_time: us between ticks; 0 for one tick only.

        Raises:
            OsalError: OS_TIMER_ERR_INVALID_ARGS for a time of 1000 s or more; OS_ERR_INVALID_ID;
                OS_ERR_INCORRECT_OBJ_STATE in a timer callback.
        """
        if not 0 <= start_time < TIMEBASE_LIMIT_US or not 0 <= interval_time < TIMEBASE_LIMIT_US:
            raise OsalError(
                OS_TIMER_ERR_INVALID_ARGS, f"invalid time base: {start_time} us, then every {interval_time} us"
            )
        self._refuse_in_callback("OS_TimeBaseSet")
        self._time_base(timebase_id).set(start_time, interval_time)

    def time_base_delete(self, timebase_id: int) -> None:
        """Delete a time base that has no timers (OS_TimeBaseDelete).

        Raises:
            OsalError: OS_ERR_OBJECT_IN_USE, OS_ERR_INVALID_ID, OS_ERR_INCORRECT_OBJ_STATE in a timer callback.
        """
        self._refuse_in_callback("OS_TimeBaseDelete")
        record = self._time_base(timebase_id)
        if record.timers:
            raise OsalError(OS_ERR_OBJECT_IN_USE, f"time base {record.name} still has timer {record.timers[0].name}")
        self._unregister(self._time_bases, record)
        if record.task is not None:
            self._task_ids.pop(record.task, None)
            self.kernel.kill(record.task)

    def time_base_get_id_by_name(self, name: str) -> int:
        """Return the id of a named time base (OS_TimeBaseGetIdByName).

        Raises:
            OsalError: OS_ERR_NAME_NOT_FOUND, OS_ERR_NAME_TOO_LONG, OS_ERR_INCORRECT_OBJ_STATE in a timer callback.
        """
        self._refuse_in_callback("OS_TimeBaseGetIdByName")
        return self._time_bases.named(name)

    def time_base_get_info(self, timebase_id: int) -> TimeBaseInfo:
        """Return facts about a time base (OS_TimeBaseGetInfo).

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERR_INCORRECT_OBJ_STATE in a timer callback.
        """
        self._refuse_in_callback("OS_TimeBaseGetInfo")
        record = self._time_base(timebase_id)
        freerun = record.freerun() & FREERUN_MASK
        return TimeBaseInfo(record.name, record.creator, record.interval_us, freerun, record.accuracy_us)

    def time_base_get_free_run(self, timebase_id: int) -> int:
        """Return the us of its ticks so far, modulo 2**32 (OS_TimeBaseGetFreeRun).

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        return self._time_base(timebase_id).freerun() & FREERUN_MASK

    def _time_base(self, timebase_id: int) -> OsTimeBase:
        record = self._time_bases.lookup(timebase_id)
        if record is None:
            raise self._time_bases.missing(timebase_id)
        return record

    def _serve(self, record: OsTimeBase) -> None:
        task = self.kernel.current
        record.task = task
        task.owner = NOBODY
        self._task_ids[task] = record.id  # to recognize a callback, as in NASA's OSAL
        try:
            if record.sync is not None:
                record.run_by_sync(record.sync)
            else:
                record.run_by_clock()
        except Exception:
            task.owner = NOBODY  # a sync function whose application may have ended: ES resets the processor
            raise
        finally:
            self._task_ids.pop(task, None)


class TimerInfo(NamedTuple):
    """The result of `timer_get_info` (OS_timer_prop_t); times in us. OSAL leaves `start_time` 0."""

    name: str
    creator: int
    start_time: int
    interval_time: int
    accuracy: int


class TimerApi(TimeBaseApi):
    """The OS_Timer* functions."""

    def __init__(self, setup: Setup) -> None:
        super().__init__(setup)
        self._timers: OsObjectTable[OsTimer] = self._table("timer", OS_TIMECB_BASE, setup.config.os_max_timers)

    def timer_create(self, name: str, callback: Callable[[int], object]) -> int:
        """Make a timer with its own time base (OS_TimerCreate).

        NASA's clock_accuracy is in `timer_get_info`.

        Args:
            name: unique among timers and among time bases, at most 19 characters.
            callback: called with the timer's id at every expiry, in the task of the time base: the callback must not
                wait.

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
            callback_arg: second argument of the callback.

        Returns:
            The timer's id.

        Raises:
            OsalError: see `timer_create`, and OS_ERR_INVALID_ID.
        """
        _check_callback(callback)
        self._timers.check_name(name)
        self._refuse_in_callback("OS_TimerAdd")
        return self._add(name, self._time_base(timebase_id), lambda timer_id: callback(timer_id, callback_arg), False)

    def timer_set(self, timer_id: int, start_time: int, interval_time: int) -> None:
        """Start a timer (OS_TimerSet).

        Args:
            timer_id: the timer.
            start_time: us until the first expiry, rounded up to a tick. With 0, a timer from `timer_create` never
                expires, as on NASA's Linux; one from `timer_add` does after one interval.
            interval_time: us between expiries; 0 for one expiry only.

        Raises:
            OsalError: OS_TIMER_ERR_INVALID_ARGS, OS_ERR_INVALID_ID, OS_ERR_INCORRECT_OBJ_STATE in a timer callback.
        """
        if self._cost:
            self.kernel.charge(self._cost)
        valid = 0 <= start_time < TIMER_LIMIT_US and 0 <= interval_time < TIMER_LIMIT_US
        if not valid or not (start_time or interval_time):
            raise OsalError(OS_TIMER_ERR_INVALID_ARGS, f"invalid timer: {start_time} us, then every {interval_time} us")
        self._refuse_in_callback("OS_TimerSet")
        timer = self._timer(timer_id)
        timer.interval_us = interval_time
        timer.due = timer.timebase.freerun() + (start_time or interval_time)
        if timer.dedicated:
            self.time_base_set(timer.timebase.id, start_time, interval_time)
        else:
            timer.timebase.poke()

    def timer_delete(self, timer_id: int) -> None:
        """Delete a timer, and its time base if it has its own (OS_TimerDelete).

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
        """Return the id of a named timer (OS_TimerGetIdByName).

        Raises:
            OsalError: OS_ERR_NAME_NOT_FOUND, OS_ERR_NAME_TOO_LONG, OS_ERR_INCORRECT_OBJ_STATE in a timer callback.
        """
        self._refuse_in_callback("OS_TimerGetIdByName")
        return self._timers.named(name)

    def timer_get_info(self, timer_id: int) -> TimerInfo:
        """Return facts about a timer (OS_TimerGetInfo).

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERR_INCORRECT_OBJ_STATE in a timer callback.
        """
        self._refuse_in_callback("OS_TimerGetInfo")
        timer = self._timer(timer_id)
        return TimerInfo(timer.name, timer.creator, 0, timer.interval_us, timer.timebase.accuracy_us)

    def has_timer(self, owner: object) -> bool:
        """Return whether an application has a timer, whose callback runs in a task of OSAL."""
        return any(timer.owner is owner for timer in self._timers)

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

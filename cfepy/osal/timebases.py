"""OSAL time bases (OS_TimeBase*): sources of ticks, each with a task that runs the callbacks of its timers.

The task of a time base is the most urgent of all (priority 0) and tickless: it sleeps until the tick at which the next
of its timers is due, so an idle time base costs nothing, and ticks are counted from the clock. A time base with a sync
function of its own is driven by what that returns instead. May import cfepy.rtos, ids, status and its neighbours in
cfepy.osal.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from cfepy.ids import OS_TIMEBASE_BASE
from cfepy.osal.core import Core, ObjectTable, OsObject, Setup
from cfepy.rtos import FOREVER, Kernel, Task, WaitList
from cfepy.rtos.units import NS_PER_MS, NS_PER_US
from cfepy.status import OS_ERR_OBJECT_IN_USE, OS_TIMER_ERR_INVALID_ARGS, OsalError

TIMEBASE_PRIORITY = 0
TIMEBASE_LIMIT_US = 1_000_000_000
FREERUN_MASK = 0xFFFFFFFF
IDLE_SYNCS = 4  # a sync function may return 0 this often in a row before it is slowed down
SLOW_SYNC_MS = 10


class TimeBaseInfo(NamedTuple):
    """What `time_base_get_info` tells (OS_timebase_prop_t); times in us."""

    name: str
    creator: int
    nominal_interval_time: int
    freerun_time: int
    accuracy: int


class OsTimer(OsObject):
    """The record of a timer; see `cfepy.osal.timers`."""

    __slots__ = ("backlog_resets", "callback", "dedicated", "due", "interval_us", "start_us", "timebase")

    def __init__(self, name: str, timebase: OsTimeBase, callback: Callable[[int], object], dedicated: bool) -> None:
        super().__init__(name)
        self.timebase = timebase
        self.callback = callback
        self.dedicated = dedicated
        self.start_us = 0
        self.interval_us = 0
        self.due: int | None = None  # free run time of the time base at which it expires
        self.backlog_resets = 0

    def expire(self, freerun: int) -> None:
        """Call back as often as is due, and set the next expiry.

        An interval shorter than the time base's makes several calls at one tick, but never for a backlog of more than
        one interval.
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
    """The record of a time base. Ticks: one at `first_ns`, then one every `interval_us`."""

    __slots__ = ("base", "first_ns", "interval_us", "kernel", "start_us", "sync", "task", "timers", "waits", "wakes_at")

    def __init__(self, name: str, kernel: Kernel, sync: Callable[[int], int] | None) -> None:
        super().__init__(name)
        self.kernel = kernel
        self.sync = sync
        self.timers: list[OsTimer] = []  # the one added last comes first, as in NASA's ring
        self.start_us = 0
        self.interval_us = 0
        self.first_ns = 0
        self.base = 0  # free run time before the tick at `first_ns`
        self.waits = WaitList(f"timer of time base {name}")
        self.wakes_at: int | None = None
        self.task: Task | None = None

    def set(self, start_us: int, interval_us: int) -> None:
        """Begin to tick, the first time after `start_us`."""
        self.base = self.freerun()
        self.start_us = start_us or interval_us
        self.interval_us = interval_us
        self.first_ns = self.kernel.now + self.start_us * NS_PER_US
        self.poke()

    def freerun(self) -> int:
        """Time in us that the ticks so far stand for."""
        since = self.kernel.now - self.first_ns
        if self.sync is not None or not self.start_us or since < 0:
            return self.base
        ticks = since // (self.interval_us * NS_PER_US) if self.interval_us else 0
        return self.base + self.start_us + ticks * self.interval_us

    def instant_of(self, freerun: int) -> int | None:
        """Virtual time in ns of the first tick at which the free run time is at least `freerun`; None for never."""
        beyond = freerun - self.base - self.start_us
        if not self.start_us:
            return None
        if beyond <= 0:
            return self.first_ns
        if not self.interval_us:
            return None
        return self.first_ns - (-beyond // self.interval_us) * self.interval_us * NS_PER_US

    def next_instant(self) -> int | None:
        """Virtual time in ns at which the next timer is due."""
        instants = [self.instant_of(timer.due) for timer in self.timers if timer.due is not None]
        return min((instant for instant in instants if instant is not None), default=None)

    def poke(self) -> None:
        """A timer or the ticks changed: let the task look again when it would sleep too long."""
        instant = self.next_instant()
        if instant is not None and (self.wakes_at is None or instant < self.wakes_at):
            self.kernel.wake_first(self.waits)

    def expire(self, freerun: int) -> None:
        """Run the callbacks that are due; an error in one is its application's, and stops only that timer."""
        task = self.kernel.current
        for timer in tuple(self.timers):
            task.owner = timer.owner
            try:
                timer.expire(freerun)
            except (Exception, SystemExit) as error:
                timer.due = None
                if not self.kernel.on_task_error(task, error):
                    raise
        task.owner = None

    def run_by_clock(self) -> None:
        """The task of a time base that follows the kernel's clock."""
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
        """The task of a time base with a sync function, which waits and returns the us that went by."""
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
        self._time_bases: ObjectTable[OsTimeBase] = self._table(
            "time base", OS_TIMEBASE_BASE, setup.config.os_max_timebases
        )
        self._accuracy_us = max(1, setup.kernel.tick_ns // NS_PER_US)

    def time_base_create(self, name: str, external_sync: Callable[[int], int] | None = None) -> int:
        """Make a time base (OS_TimeBaseCreate).

        Args:
            name: unique among time bases, at most 19 characters.
            external_sync: called with the id again and again in the time base's task; it waits for the next tick and
                returns how many us that is. None follows the kernel's clock.

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
        """Let it tick (OS_TimeBaseSet).

        Args:
            timebase_id: the time base.
            start_time: us until the first tick; 0 for one interval.
            interval_time: us between ticks; 0 for one tick only.

        Raises:
            OsalError: OS_TIMER_ERR_INVALID_ARGS for a time of 1000 s or more; OS_ERR_INVALID_ID;
                OS_ERR_INCORRECT_OBJ_STATE in a timer callback.
        """
        if not 0 <= start_time < TIMEBASE_LIMIT_US or not 0 <= interval_time < TIMEBASE_LIMIT_US:
            raise OsalError(OS_TIMER_ERR_INVALID_ARGS, f"time base of {start_time} us, then every {interval_time} us")
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
        """Id of a named time base (OS_TimeBaseGetIdByName).

        Raises:
            OsalError: OS_ERR_NAME_NOT_FOUND, OS_ERR_NAME_TOO_LONG, OS_ERR_INCORRECT_OBJ_STATE in a timer callback.
        """
        self._refuse_in_callback("OS_TimeBaseGetIdByName")
        return self._time_bases.named(name)

    def time_base_get_info(self, timebase_id: int) -> TimeBaseInfo:
        """Facts about a time base (OS_TimeBaseGetInfo).

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERR_INCORRECT_OBJ_STATE in a timer callback.
        """
        self._refuse_in_callback("OS_TimeBaseGetInfo")
        record = self._time_base(timebase_id)
        accuracy = 0 if record.sync is not None else self._accuracy_us
        return TimeBaseInfo(record.name, record.creator, record.interval_us, record.freerun() & FREERUN_MASK, accuracy)

    def time_base_get_free_run(self, timebase_id: int) -> int:
        """The us that its ticks so far stand for, modulo 2**32 (OS_TimeBaseGetFreeRun).

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
        task.owner = None
        self._task_ids[task] = record.id  # so a callback is known for what it is, as in NASA's
        try:
            if record.sync is not None:
                record.run_by_sync(record.sync)
            else:
                record.run_by_clock()
        finally:
            self._task_ids.pop(task, None)

"""time, clock_gettime, usleep and related functions of POSIX, in virtual time.

The date is OSAL's local time, and the other clocks are its monotonic time. Code may wait by reading a clock, so each
reading costs virtual time. Clocks of CPU time are absent, because code between two calls takes none.
"""

from __future__ import annotations

import errno
from struct import Struct
from typing import TYPE_CHECKING

from cfepy.osal import OS_TIME_TICKS_PER_SECOND
from cfepy.units import NS_PER_S, NS_PER_US

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

FAILED = -1
_TICK_NS = NS_PER_S // OS_TIME_TICKS_PER_SECOND
PAIR = Struct("<qq")
"""struct timespec and struct timeval: seconds, and nanoseconds or microseconds."""
REALTIME, MONOTONIC, MONOTONIC_RAW, REALTIME_COARSE, MONOTONIC_COARSE, BOOTTIME = 0, 1, 4, 5, 6, 7
DATES = (REALTIME, REALTIME_COARSE)
CLOCKS = (*DATES, MONOTONIC, MONOTONIC_RAW, MONOTONIC_COARSE, BOOTTIME)
TIMER_ABSTIME = 1
TIME_UTC = 1


class PosixTime:
    """The clocks and waits of one processor.

    Args:
        c: its C side.
    """

    def __init__(self, c: CRuntime) -> None:
        self._c = c

    def _now(self, clock: int) -> int:
        os = self._c.handle.os
        return (os.get_local_time() if clock in DATES else os.get_monotonic_time()) * _TICK_NS

    def time(self, at: int) -> int:
        seconds = self._now(REALTIME) // NS_PER_S
        if at:
            self._c.memory.put_u64(at, seconds)
        return seconds

    def time_of_day(self, at: int, zone: int) -> int:
        seconds, rest = divmod(self._now(REALTIME), NS_PER_S)
        self._c.memory.poke(at, PAIR.pack(seconds, rest // NS_PER_US))
        return 0

    def clock(self, clock: int, at: int) -> int:
        if clock not in CLOCKS:
            return self._fail(errno.EINVAL)
        self._c.memory.poke(at, PAIR.pack(*divmod(self._now(clock), NS_PER_S)))
        return 0

    def resolution(self, clock: int, at: int) -> int:
        if clock not in CLOCKS:
            return self._fail(errno.EINVAL)
        if at:
            self._c.memory.poke(at, PAIR.pack(0, 1))
        return 0

    def timespec(self, at: int, base: int) -> int:
        if base != TIME_UTC:
            return 0
        self.clock(REALTIME, at)
        return base

    def sleep(self, seconds: int) -> int:
        self._delay(seconds * NS_PER_S)
        return 0

    def sleep_us(self, microseconds: int) -> int:
        self._delay(microseconds * NS_PER_US)
        return 0

    def sleep_ns(self, wanted: int, rest: int) -> int:
        status = self.sleep_by(MONOTONIC, 0, wanted, rest)
        return self._fail(status) if status else 0

    def sleep_by(self, clock: int, flags: int, wanted: int, rest: int) -> int:
        """Wait for a time or until one. Returns an error number."""
        seconds, nanoseconds = PAIR.unpack(self._c.memory.peek(wanted, PAIR.size))
        if clock not in CLOCKS or seconds < 0 or not 0 <= nanoseconds < NS_PER_S:
            return errno.EINVAL
        end = seconds * NS_PER_S + nanoseconds
        self._delay(max(end - self._now(clock), 0) if flags & TIMER_ABSTIME else end)
        return 0

    def _delay(self, duration_ns: int) -> None:
        if duration_ns:
            self._c.kernel.delay(duration_ns)
        else:
            self._c.kernel.delay_nothing(self._c.polling_ns)

    def _fail(self, number: int) -> int:
        self._c.memory.put_u32(self._c.thread_locals.errno(), number)
        return FAILED


def declare(api: Declarations, c: CRuntime) -> None:
    posix = PosixTime(c)
    api.add("time", "$p", posix.time)
    api.add("gettimeofday", "$Pp", posix.time_of_day, FAILED)
    api.add("clock_gettime", "$iP", posix.clock, FAILED)
    api.add("clock_getres", "ip", posix.resolution)
    api.add("timespec_get", "$Pi", posix.timespec)
    api.add("sleep", "$I", posix.sleep)
    api.add("usleep", "$I", posix.sleep_us)
    api.add("nanosleep", "$Pp", posix.sleep_ns, FAILED)
    api.add("clock_nanosleep", "$iiPp", posix.sleep_by, errno.EFAULT)

"""OSAL's clock and its time arithmetic (osapi-clock.h).

OS_time_t is a plain integer here, `OsTime`, in ticks of 100 ns. The monotonic clock is the kernel's virtual clock. The
local clock adds an offset that `set_local_time` changes. Divisions round towards zero, as in C.
"""

from __future__ import annotations

from typing import NewType

from cfepy.osal.core import Core, Setup
from cfepy.osal.limits import OS_CHECK, OS_PEND
from cfepy.status import OS_ERR_INVALID_ARGUMENT, OsalError

OsTime = NewType("OsTime", int)

OS_TIME_TICK_RESOLUTION_NS = 100
OS_TIME_TICKS_PER_SECOND = 10_000_000
OS_TIME_TICKS_PER_MSEC = 10_000
OS_TIME_TICKS_PER_USEC = 10
OS_TIME_MAX = OsTime((1 << 63) - 1)
OS_TIME_ZERO = OsTime(0)
OS_TIME_MIN = OsTime(-(1 << 63))
_INT32_MAX = 0x7FFFFFFF
_U32_MAX = 0xFFFFFFFF
_QUARTER_SECOND = OS_TIME_TICKS_PER_SECOND >> 2


def _quotient(number: int, divisor: int) -> int:
    return number // divisor if number >= 0 else -(-number // divisor)


def time_get_total_seconds(time: OsTime) -> int:
    """Return whole seconds (OS_TimeGetTotalSeconds)."""
    return _quotient(time, OS_TIME_TICKS_PER_SECOND)


def time_from_total_seconds(seconds: int) -> OsTime:
    """Return a time from seconds (OS_TimeFromTotalSeconds)."""
    return OsTime(seconds * OS_TIME_TICKS_PER_SECOND)


def time_get_total_milliseconds(time: OsTime) -> int:
    """Return whole milliseconds (OS_TimeGetTotalMilliseconds)."""
    return _quotient(time, OS_TIME_TICKS_PER_MSEC)


def time_from_total_milliseconds(milliseconds: int) -> OsTime:
    """Return a time from milliseconds (OS_TimeFromTotalMilliseconds)."""
    return OsTime(milliseconds * OS_TIME_TICKS_PER_MSEC)


def time_get_total_microseconds(time: OsTime) -> int:
    """Return whole microseconds (OS_TimeGetTotalMicroseconds)."""
    return _quotient(time, OS_TIME_TICKS_PER_USEC)


def time_from_total_microseconds(microseconds: int) -> OsTime:
    """Return a time from microseconds (OS_TimeFromTotalMicroseconds)."""
    return OsTime(microseconds * OS_TIME_TICKS_PER_USEC)


def time_get_total_nanoseconds(time: OsTime) -> int:
    """Return nanoseconds (OS_TimeGetTotalNanoseconds)."""
    return time * OS_TIME_TICK_RESOLUTION_NS


def time_from_total_nanoseconds(nanoseconds: int) -> OsTime:
    """Return a time from nanoseconds, rounded towards zero to 100 ns (OS_TimeFromTotalNanoseconds)."""
    return OsTime(_quotient(nanoseconds, OS_TIME_TICK_RESOLUTION_NS))


def time_get_fractional_part(time: OsTime) -> int:
    """Return the ticks beyond the whole seconds, with the sign of the time (OS_TimeGetFractionalPart)."""
    return time - time_get_total_seconds(time) * OS_TIME_TICKS_PER_SECOND


def time_get_subseconds_part(time: OsTime) -> int:
    """Return the fraction of a second in units of 2**-32 s, rounded up (OS_TimeGetSubsecondsPart)."""
    raised = (time_get_fractional_part(time) << 30) + _QUARTER_SECOND
    return _quotient(raised - 1, _QUARTER_SECOND) & 0xFFFFFFFF


def time_get_milliseconds_part(time: OsTime) -> int:
    """Return the milliseconds beyond the whole seconds (OS_TimeGetMillisecondsPart)."""
    return (time_get_fractional_part(time) & 0xFFFFFFFF) // OS_TIME_TICKS_PER_MSEC


def time_get_microseconds_part(time: OsTime) -> int:
    """Return the microseconds beyond the whole seconds (OS_TimeGetMicrosecondsPart)."""
    return (time_get_fractional_part(time) & 0xFFFFFFFF) // OS_TIME_TICKS_PER_USEC


def time_get_nanoseconds_part(time: OsTime) -> int:
    """Return the nanoseconds beyond the whole seconds (OS_TimeGetNanosecondsPart)."""
    return (time_get_fractional_part(time) & 0xFFFFFFFF) * OS_TIME_TICK_RESOLUTION_NS & 0xFFFFFFFF


def time_assemble_from_nanoseconds(seconds: int, nanoseconds: int) -> OsTime:
    """Return a time from seconds and nanoseconds (OS_TimeAssembleFromNanoseconds)."""
    return OsTime(seconds * OS_TIME_TICKS_PER_SECOND + nanoseconds // OS_TIME_TICK_RESOLUTION_NS)


def time_assemble_from_microseconds(seconds: int, microseconds: int) -> OsTime:
    """Return a time from seconds and microseconds, which wrap at 2**32 ticks (OS_TimeAssembleFromMicroseconds)."""
    return OsTime(seconds * OS_TIME_TICKS_PER_SECOND + (microseconds * OS_TIME_TICKS_PER_USEC & _U32_MAX))


def time_assemble_from_milliseconds(seconds: int, milliseconds: int) -> OsTime:
    """Return a time from seconds and milliseconds, which wrap at 2**32 ticks (OS_TimeAssembleFromMilliseconds)."""
    return OsTime(seconds * OS_TIME_TICKS_PER_SECOND + (milliseconds * OS_TIME_TICKS_PER_MSEC & _U32_MAX))


def time_assemble_from_subseconds(seconds: int, subseconds: int) -> OsTime:
    """Return a time from seconds and units of 2**-32 s, rounded down (OS_TimeAssembleFromSubseconds)."""
    return OsTime(seconds * OS_TIME_TICKS_PER_SECOND + (subseconds * _QUARTER_SECOND >> 30))


def time_add(first: OsTime, second: OsTime) -> OsTime:
    """Return the sum (OS_TimeAdd)."""
    return OsTime(first + second)


def time_subtract(first: OsTime, second: OsTime) -> OsTime:
    """Return the difference (OS_TimeSubtract)."""
    return OsTime(first - second)


def time_equal(first: OsTime, second: OsTime) -> bool:
    """Return whether two times are equal (OS_TimeEqual)."""
    return first == second


def time_get_sign(time: OsTime) -> int:
    """Return -1, 0 or 1 (OS_TimeGetSign)."""
    return (time > 0) - (time < 0)


def time_compare(first: OsTime, second: OsTime) -> int:
    """Return -1 if the first time is earlier, 0 if both are equal, otherwise 1 (OS_TimeCompare)."""
    return time_get_sign(time_subtract(first, second))


class ClockApi(Core):
    """The functions that read and set clocks, and the arithmetic above as static methods."""

    time_get_total_seconds = staticmethod(time_get_total_seconds)
    time_from_total_seconds = staticmethod(time_from_total_seconds)
    time_get_total_milliseconds = staticmethod(time_get_total_milliseconds)
    time_from_total_milliseconds = staticmethod(time_from_total_milliseconds)
    time_get_total_microseconds = staticmethod(time_get_total_microseconds)
    time_from_total_microseconds = staticmethod(time_from_total_microseconds)
    time_get_total_nanoseconds = staticmethod(time_get_total_nanoseconds)
    time_from_total_nanoseconds = staticmethod(time_from_total_nanoseconds)
    time_get_fractional_part = staticmethod(time_get_fractional_part)
    time_get_subseconds_part = staticmethod(time_get_subseconds_part)
    time_get_milliseconds_part = staticmethod(time_get_milliseconds_part)
    time_get_microseconds_part = staticmethod(time_get_microseconds_part)
    time_get_nanoseconds_part = staticmethod(time_get_nanoseconds_part)
    time_assemble_from_nanoseconds = staticmethod(time_assemble_from_nanoseconds)
    time_assemble_from_microseconds = staticmethod(time_assemble_from_microseconds)
    time_assemble_from_milliseconds = staticmethod(time_assemble_from_milliseconds)
    time_assemble_from_subseconds = staticmethod(time_assemble_from_subseconds)
    time_add = staticmethod(time_add)
    time_subtract = staticmethod(time_subtract)
    time_equal = staticmethod(time_equal)
    time_get_sign = staticmethod(time_get_sign)
    time_compare = staticmethod(time_compare)

    def __init__(self, setup: Setup) -> None:
        super().__init__(setup)
        self._local_offset = setup.epoch_ns // OS_TIME_TICK_RESOLUTION_NS

    def get_monotonic_time(self) -> OsTime:
        """Return the time since the start of the run, which never goes back (OS_GetMonotonicTime)."""
        if self._cost:
            self.kernel.charge(self._cost)
        return OsTime(self.kernel.now // OS_TIME_TICK_RESOLUTION_NS)

    def get_local_time(self) -> OsTime:
        """Return the local clock (OS_GetLocalTime)."""
        if self._cost:
            self.kernel.charge(self._cost)
        return OsTime(self.kernel.now // OS_TIME_TICK_RESOLUTION_NS + self._local_offset)

    def set_local_time(self, time: OsTime) -> None:
        """Set the local clock (OS_SetLocalTime).

        Raises:
            OsalError: OS_ERR_INVALID_ARGUMENT for a time before the epoch.
        """
        if time < 0:
            raise OsalError(OS_ERR_INVALID_ARGUMENT, f"invalid local time {time}")
        self._local_offset = time - self.kernel.now // OS_TIME_TICK_RESOLUTION_NS

    def time_from_relative_milliseconds(self, milliseconds: int) -> OsTime:
        """Return the local time a number of ms from now (OS_TimeFromRelative...).

        OS_PEND gives OS_TIME_MAX, and OS_CHECK gives 0.
        """
        if milliseconds == OS_CHECK:
            return OS_TIME_ZERO
        if milliseconds < 0:
            return OS_TIME_MAX
        return time_add(self.get_local_time(), time_from_total_milliseconds(milliseconds))

    def time_to_relative_milliseconds(self, time: OsTime) -> int:
        """Return the milliseconds left until a local time: OS_CHECK if it has passed, OS_PEND if the number is too
        large.
        """
        if time == OS_TIME_MAX:
            return OS_PEND
        left = time_subtract(time, self.get_local_time()) if time > 0 else time
        if left <= 0:
            return OS_CHECK
        milliseconds = time_get_total_milliseconds(left)
        return milliseconds if milliseconds <= _INT32_MAX else OS_PEND

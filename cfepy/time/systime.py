"""Spacecraft time values and their arithmetic (CFE_TIME_SysTime_t, CFE_TIME_Add and its relatives).

A time is 32 bits of seconds and 32 bits of 2**-32 s. Time Services use one 64-bit integer of 2**-32 s for it, called
ticks here, so addition with carry and rollover is a single addition. All functions are pure.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import NamedTuple

from cfepy.msg import sys_time_fields
from cfepy.status import CFE_TIME_BAD_ARGUMENT, CfeError
from cfepy.units import NS_PER_S, US_PER_S

MASK_32 = 0xFFFFFFFF
MASK_64 = 0xFFFFFFFFFFFFFFFF
EPOCH_YEAR = 1980

A_LT_B = -1
EQUAL = 0
A_GT_B = 1
"""The results of `compare` (CFE_TIME_Compare_t)."""

_HALF_RANGE = 0x80000000
_SECONDS_PER_DAY = 86400


class SysTime(NamedTuple):
    """Seconds and subseconds of 2**-32 s, each 0 to 2**32 - 1 (CFE_TIME_SysTime_t)."""

    seconds: int
    subseconds: int


def to_ticks(time: tuple[int, int]) -> int:
    """Return a time as one integer of 2**-32 s."""
    return (time[0] << 32) + time[1] & MASK_64


def from_ticks(ticks: int) -> SysTime:
    """Return the time for an integer of 2**-32 s; it wraps at 64 bits."""
    return SysTime(ticks >> 32 & MASK_32, ticks & MASK_32)


def ticks_of_ns(duration_ns: int) -> int:
    """Return nanoseconds as 2**-32 s, rounded up, so that the conversion back is exact (OS_TimeGetSubsecondsPart)."""
    return -(-(duration_ns << 32) // NS_PER_S)


def copy(time: tuple[int, int]) -> SysTime:
    """Return a copy of a time (the macro CFE_TIME_Copy); a SysTime never changes, so sharing it works too."""
    return SysTime(*time)


def add(first: tuple[int, int], second: tuple[int, int]) -> SysTime:
    """Return the sum; seconds wrap at 32 bits (CFE_TIME_Add)."""
    return from_ticks(to_ticks(first) + to_ticks(second))


def subtract(first: tuple[int, int], second: tuple[int, int]) -> SysTime:
    """Return `first` minus `second`; a negative result wraps (CFE_TIME_Subtract)."""
    return from_ticks(to_ticks(first) - to_ticks(second))


def compare(first: tuple[int, int], second: tuple[int, int]) -> int:
    """Return which time is later: A_LT_B (-1), EQUAL (0) or A_GT_B (1) (CFE_TIME_Compare).

    If the seconds differ by more than 2**31, the clock is assumed to have wrapped in between, so the smaller one is
    later.
    """
    if first[0] != second[0]:
        later = first[0] > second[0]
        if abs(first[0] - second[0]) > _HALF_RANGE:
            later = not later
        return A_GT_B if later else A_LT_B
    return (first[1] > second[1]) - (first[1] < second[1])


def sub2micro_secs(subseconds: int) -> int:
    """Return subseconds of 2**-32 s as microseconds, rounded down (CFE_TIME_Sub2MicroSecs).

    Raises:
        CfeError: CFE_TIME_BAD_ARGUMENT if it is not within 32 bits.
    """
    if not 0 <= subseconds <= MASK_32:
        raise CfeError(CFE_TIME_BAD_ARGUMENT, f"subseconds must be 0 to {MASK_32}, not {subseconds}")
    return subseconds * US_PER_S >> 32


def micro2sub_secs(microseconds: int) -> int:
    """Return microseconds as subseconds of 2**-32 s, rounded up; a second or more gives 0xFFFFFFFF
    (CFE_TIME_Micro2SubSecs).

    Raises:
        CfeError: CFE_TIME_BAD_ARGUMENT if it is negative.
    """
    if microseconds < 0:
        raise CfeError(CFE_TIME_BAD_ARGUMENT, f"microseconds must not be negative: {microseconds}")
    if microseconds >= US_PER_S:
        return MASK_32
    return -(-(microseconds << 32) // US_PER_S)


def print_(time: tuple[int, int]) -> str:
    """Return a time as text since the epoch 1980-001, year-day-hour:minute:second.10us (CFE_TIME_Print).

    >>> print_((1001000, 0))
    '1980-012-14:03:20.00000'
    """
    days, second = divmod(time[0], _SECONDS_PER_DAY)
    minutes, second = divmod(second, 60)
    hour, minute = divmod(minutes, 60)
    return f"{_date(days)}-{hour:02}:{minute:02}:{second:02}.{sub2micro_secs(time[1]) // 10:05}"


@lru_cache(maxsize=64)
def _date(days: int) -> str:
    """Return the year and the day of the year, a number of days after the epoch."""
    year = EPOCH_YEAR
    while days >= (length := _days_of(year)):
        days -= length
        year += 1
    return f"{year}-{days + 1:03}"


def _days_of(year: int) -> int:
    is_leap = year % 4 == 0 and (year % 100 != 0 or year % 400 == 0)
    return 366 if is_leap else 365


def fields_of(ticks: int) -> dict[str, int]:
    """Return a time as the fields of CFE_TIME_SysTime_t."""
    return sys_time_fields(from_ticks(ticks))


def ticks_of(fields: Mapping[str, int]) -> int:
    """Return the time in the fields of a CFE_TIME_SysTime_t, in ticks."""
    return to_ticks((fields["Seconds"], fields["Subseconds"]))

"""Arithmetic on times, conversions, and times as text."""

from __future__ import annotations

from datetime import datetime, timedelta

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from cfepy.status import CFE_TIME_BAD_ARGUMENT, CfeError
from cfepy.time import (
    A_GT_B,
    A_LT_B,
    EQUAL,
    SysTime,
    add,
    compare,
    copy,
    micro2sub_secs,
    print_,
    sub2micro_secs,
    subtract,
)
from cfepy.time.systime import from_ticks, ticks_of_ns, to_ticks

U32 = st.integers(0, 0xFFFFFFFF)
TIMES = st.builds(SysTime, U32, U32)


@pytest.mark.parametrize(
    ("first", "second", "total"),
    [
        ((0, 0), (0, 0), (0, 0)),
        ((1, 0x80000000), (2, 0x80000000), (4, 0)),
        ((0xFFFFFFFF, 0xFFFFFFFF), (0, 1), (0, 0)),
        ((500, 4294967295), (1, 4294967295), (502, 4294967294)),
    ],
)
def test_add(first: tuple[int, int], second: tuple[int, int], total: tuple[int, int]) -> None:
    """cTIME2007: subseconds carry into seconds, seconds roll over."""
    assert add(first, second) == total
    assert subtract(total, second) == first


@given(TIMES, TIMES)
def test_subtraction_reverses_addition(first: SysTime, second: SysTime) -> None:
    assert subtract(add(first, second), second) == first
    assert add(subtract(first, second), second) == first
    assert add(first, second) == add(second, first)


@pytest.mark.parametrize(
    ("first", "second", "result"),
    [
        ((1, 5), (1, 5), EQUAL),
        ((1, 6), (1, 5), A_GT_B),
        ((1, 5), (2, 0), A_LT_B),
        ((0x80000000, 0), (0, 0), A_GT_B),
        ((0x80000001, 0), (0, 0), A_LT_B),
        ((0xFFFFFFFF, 0xFFFFFFFF), (0, 0), A_LT_B),
    ],
)
def test_compare(first: tuple[int, int], second: tuple[int, int], result: int) -> None:
    """cTIME2010: more than half the range apart means that the clock rolled over."""
    assert compare(first, second) == result


@given(TIMES, TIMES)
@example(SysTime(0, 0), SysTime(0x80000000, 0))
@example(SysTime(0, 0), SysTime(0x80000001, 0))
def test_swapped_comparison_gives_the_opposite(first: SysTime, second: SysTime) -> None:
    assert compare(first, second) == -compare(second, first)
    assert (compare(first, second) == EQUAL) == (first == second)


@given(TIMES, st.integers(1, 0x7FFFFFFF << 32))
def test_time_is_earlier_than_a_later_one(time: SysTime, later_by: int) -> None:
    assert compare(time, add(time, from_ticks(later_by))) == A_LT_B


@given(TIMES, TIMES, TIMES)
def test_addition_is_commutative(first: SysTime, second: SysTime, third: SysTime) -> None:
    assert add(add(first, second), third) == add(first, add(second, third))


@given(TIMES)
def test_a_copy_is_equal(time: SysTime) -> None:
    assert copy(tuple(time)) == time  # type: ignore[arg-type]


@given(TIMES)
def test_ticks_convert_back_to_the_time(time: SysTime) -> None:
    assert from_ticks(to_ticks(time)) == time


# -- conversions ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("subseconds", "micros"), [(0, 0), (4294, 0), (4295, 1), (31000, 7), (0x80000000, 500000), (0xFFFFFFFF, 999999)]
)
def test_sub2micro_secs(subseconds: int, micros: int) -> None:
    assert sub2micro_secs(subseconds) == micros


@pytest.mark.parametrize(
    ("micros", "subseconds"),
    [
        (0, 0),
        (1, 4295),
        (64512, 277076931),
        (20000, 0x051EB852),
        (200000, 0x33333334),
        (999999, 0xFFFFEF3A),
        (1000000, 0xFFFFFFFF),
    ],
)
def test_micro2sub_secs(micros: int, subseconds: int) -> None:
    """The values of the real diagnostic packet (tone limit, elapsed limit) are among them."""
    assert micro2sub_secs(micros) == subseconds


@given(st.integers(0, 999_999))
def test_microseconds_survive_conversion_to_subseconds_and_back(micros: int) -> None:
    assert sub2micro_secs(micro2sub_secs(micros)) == micros


@given(U32, U32)
def test_microseconds_grow_with_subseconds(first: int, second: int) -> None:
    less, more = sorted((first, second))
    assert sub2micro_secs(less) <= sub2micro_secs(more)


@given(st.integers(0, 1_100_000), st.integers(0, 1_100_000))
def test_subseconds_grow_with_microseconds(first: int, second: int) -> None:
    less, more = sorted((first, second))
    assert micro2sub_secs(less) <= micro2sub_secs(more)


@given(U32)
def test_subseconds_survive_conversion_to_microseconds_within_one_microsecond(subseconds: int) -> None:
    """A microsecond is 4294.97 subseconds, so the loss is less than that."""
    assert 0 <= subseconds - micro2sub_secs(sub2micro_secs(subseconds)) + 1 <= 4295


@given(st.integers(0, 2**62))
def test_nanoseconds_survive_conversion_to_ticks_and_back(duration_ns: int) -> None:
    assert ticks_of_ns(duration_ns) * 10**9 >> 32 == duration_ns


@pytest.mark.parametrize(
    "convert", [lambda: sub2micro_secs(-1), lambda: sub2micro_secs(1 << 32), lambda: micro2sub_secs(-1)]
)
def test_conversions_refuse_values_beyond_a_second(convert: object) -> None:
    with pytest.raises(CfeError) as caught:
        convert()  # type: ignore[operator]
    assert caught.value.status == CFE_TIME_BAD_ARGUMENT


# -- text ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("time", "text"),
    [
        ((0, 0), "1980-001-00:00:00.00000"),
        ((1001000, 0), "1980-012-14:03:20.00000"),
        ((1001000, 0x0CF2 << 16), "1980-012-14:03:20.05056"),
        ((59, 0xFFFFFFFF), "1980-001-00:00:59.99999"),
        ((366 * 86400, 0), "1981-001-00:00:00.00000"),
        ((0xFFFFFFFF, 0xFFFFFFFF), "2116-038-06:28:15.99999"),
    ],
)
def test_print(time: tuple[int, int], text: str) -> None:
    """cTIME2020: the texts of the real system; the third is an event of its log file."""
    assert print_(time) == text


@given(U32)
def test_print_uses_the_calendar(seconds: int) -> None:
    date = datetime(1980, 1, 1) + timedelta(seconds=seconds)
    assert print_((seconds, 0)) == f"{date:%Y-%j-%H:%M:%S}.00000"


@given(TIMES, TIMES)
def test_later_time_has_no_earlier_text(first: SysTime, second: SysTime) -> None:
    earlier, later = sorted((first, second))
    assert print_(earlier) <= print_(later)

"""OSAL's clock and OS_time_t arithmetic."""

from __future__ import annotations

import pytest

from cfepy.osal import Osal
from cfepy.osal.clock import OS_TIME_MAX, OsTime
from cfepy.osal.limits import OS_CHECK, OS_PEND
from cfepy.status import OS_ERR_INVALID_ARGUMENT
from tests.osal.helpers import Bench
from tests.osal.test_queues import status_of

T = OsTime(12_345_678_9)  # 12.3456789 s


def test_the_monotonic_clock_is_virtual_time(bench: Bench) -> None:
    assert bench.run(lambda: (bench.os.task_delay(1500), bench.os.get_monotonic_time())[1]) == 15_000_000


def test_the_local_clock_can_be_set(bench: Bench) -> None:
    bench.os.set_local_time(OsTime(70_000_000))
    assert bench.run(lambda: (bench.os.task_delay(1000), bench.os.get_local_time())[1]) == 80_000_000
    assert bench.os.get_monotonic_time() == bench.kernel.now // 100
    assert status_of(bench.os.set_local_time, OsTime(-1)) == OS_ERR_INVALID_ARGUMENT


def test_the_epoch_of_the_local_clock() -> None:
    bench = Bench(epoch_ns=5_000_000_000)
    assert bench.os.get_local_time() == 50_000_000


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("time_get_total_seconds", 12),
        ("time_get_total_milliseconds", 12_345),
        ("time_get_total_microseconds", 12_345_678),
        ("time_get_total_nanoseconds", 12_345_678_900),
        ("time_get_fractional_part", 3_456_789),
        ("time_get_milliseconds_part", 345),
        ("time_get_microseconds_part", 345_678),
        ("time_get_nanoseconds_part", 345_678_900),
        ("time_get_subseconds_part", 1_484_679_571),
        ("time_get_sign", 1),
    ],
)
def test_parts_of_a_time(name: str, expected: int) -> None:
    assert getattr(Osal, name)(T) == expected


def test_negative_times_are_divided_as_in_c() -> None:
    assert Osal.time_get_total_seconds(OsTime(-15_000_000)) == -1
    assert Osal.time_get_fractional_part(OsTime(-15_000_000)) == -5_000_000
    assert Osal.time_get_sign(OsTime(-1)) == -1


@pytest.mark.parametrize("unit", ["seconds", "milliseconds", "microseconds", "nanoseconds"])
def test_totals_there_and_back(unit: str) -> None:
    value = 86_400_000
    time = getattr(Osal, f"time_from_total_{unit}")(value)
    assert getattr(Osal, f"time_get_total_{unit}")(time) == value


def test_assembling() -> None:
    assert Osal.time_assemble_from_nanoseconds(12, 345_678_999) == T
    assert Osal.time_assemble_from_microseconds(12, 345_678) == T - 9
    assert Osal.time_assemble_from_milliseconds(0, 0xFFFFFFFF) == 0xFFFFD8F0
    assert Osal.time_assemble_from_microseconds(0, 0xFFFFFFFF) == 0xFFFFFFF6
    assert Osal.time_assemble_from_milliseconds(12, 345) == T - 6_789
    assert Osal.time_assemble_from_subseconds(12, Osal.time_get_subseconds_part(T)) == T


def test_arithmetic() -> None:
    assert Osal.time_subtract(Osal.time_add(T, T), T) == T
    assert Osal.time_compare(T, OsTime(T + 1)) == -1
    assert Osal.time_compare(T, T) == 0
    assert Osal.time_equal(T, OsTime(int(T)))


def test_relative_times(bench: Bench) -> None:
    os = bench.os
    os.set_local_time(T)
    assert os.time_from_relative_milliseconds(OS_CHECK) == 0
    assert os.time_from_relative_milliseconds(OS_PEND) == OS_TIME_MAX
    assert os.time_from_relative_milliseconds(100) == T + 1_000_000
    assert os.time_to_relative_milliseconds(OsTime(T + 1_000_000)) == 100
    assert os.time_to_relative_milliseconds(T) == OS_CHECK
    assert os.time_to_relative_milliseconds(OsTime(-5)) == OS_CHECK
    assert os.time_to_relative_milliseconds(OS_TIME_MAX) == OS_PEND
    assert os.time_to_relative_milliseconds(OsTime(T + (1 << 62))) == OS_PEND

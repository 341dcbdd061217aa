"""SCH's calculation of the slots of a wake-up, whatever the clock did since the one before."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from apps.sch.packets import SLOTS
from apps.sch.slots import MAX_LAG, MAX_PER_WAKEUP, Due, due, is_due, slot_of_us


class Clockwork:
    """A scheduler that only counts."""

    def __init__(self) -> None:
        self.following = 0
        self.behind = 0
        self.done: list[int] = []

    def wake(self, current: int) -> Due:
        """Wake up when it is slot `current`, which counts on over the end of the table."""
        found = due(current % SLOTS, self.following % SLOTS, self.behind)
        self.behind = found.behind
        if found.skipped:
            self.following += found.skipped
        self.done += range(self.following, self.following + found.todo)
        self.following += found.todo
        return found


def test_wake_up_on_time_processes_one_slot() -> None:
    clockwork = Clockwork()
    assert all(clockwork.wake(now)[:1] == (1,) for now in range(3 * SLOTS))
    assert clockwork.done == list(range(3 * SLOTS))


@pytest.mark.parametrize("wakes", [(0, 1, 2, 4, 4, 5), (0, 1, 2, 2, 4, 5)], ids=["late once", "early once"])
def test_wake_up_that_is_slightly_off_is_compensated(wakes: tuple[int, ...]) -> None:
    clockwork = Clockwork()
    found = [clockwork.wake(now) for now in wakes]
    assert [each.todo for each in found] == [1] * 6
    assert not any(each.same or each.skipped for each in found)
    assert clockwork.done == list(range(6))


def test_slot_that_does_not_advance_twice_is_counted() -> None:
    clockwork = Clockwork()
    found = [clockwork.wake(now) for now in (0, 0, 1, 2)]
    assert [each.todo for each in found] == [1, 1, 0, 1]
    assert [each.same for each in found] == [False, False, True, False]


@given(lag=st.integers(1, MAX_LAG - 1))
def test_late_scheduling_loses_no_slot(lag: int) -> None:
    clockwork = Clockwork()
    start = 7
    for now in range(start + 1):
        clockwork.wake(now)
    now = start + lag
    for _ in range(lag // (MAX_PER_WAKEUP - 1) + 3):
        now += 1
        found = clockwork.wake(now)
        assert 1 <= found.todo <= MAX_PER_WAKEUP
        assert not found.skipped
    assert clockwork.done == list(range(now + 1))


@given(lag=st.integers(MAX_LAG, SLOTS - 2), start=st.integers(0, SLOTS - 1))
def test_schedule_far_behind_continues_with_the_current_slot(lag: int, start: int) -> None:
    clockwork = Clockwork()
    for now in range(start + 1):
        clockwork.wake(now)
    found = clockwork.wake(start + 1 + lag)
    assert (found.todo, found.skipped) == (1, lag)
    assert clockwork.done[-1] == start + 1 + lag


@given(st.lists(st.integers(0, 3), max_size=300))
def test_slots_are_processed_in_order_and_once(steps: list[int]) -> None:
    clockwork = Clockwork()
    now = 0
    for step in steps:
        clockwork.wake(now)
        now += step
    assert clockwork.done == sorted(set(clockwork.done))


@given(frequency=st.integers(1, 0xFFFF), second=st.integers(0, 0xFFFFFFFF))
def test_activity_is_due_once_in_its_period(frequency: int, second: int) -> None:
    assert sum(is_due(second, frequency, remainder) for remainder in {second % frequency, 0, frequency - 1}) == 1


@given(st.integers(0, 999_999))
def test_slots_of_a_second(microseconds: int) -> None:
    slot = slot_of_us(microseconds, 10_000)
    assert slot == ((microseconds + 1) // 10_000) % SLOTS
    assert 0 <= slot < SLOTS


@pytest.mark.parametrize(("microseconds", "slot"), [(0, 0), (9_998, 0), (9_999, 1), (10_000, 1), (999_999, 0)])
def test_wake_up_a_microsecond_early_counts(microseconds: int, slot: int) -> None:
    assert slot_of_us(microseconds, 10_000) == slot

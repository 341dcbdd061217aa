"""The time of a fault: each field of `When` alone, to the nanosecond, and probabilities in numbers."""

from __future__ import annotations

from math import sqrt
from random import Random

import pytest

from cfepy.faults.timing import Gate, When

OCCASIONS = 4000


def fired(when: When, times: range | list[int], seed: int = 0) -> list[int]:
    """At which of these times it happens."""
    gate = Gate(when, Random(seed))
    return [time for time in times if gate.opens(time)]


@pytest.mark.parametrize("probability", [0.02, 0.3, 0.5, 0.9])
def test_probability_equals_the_share_of_occasions(probability: float) -> None:
    count = len(fired(When(probability=probability), range(OCCASIONS)))
    assert abs(count - OCCASIONS * probability) <= 4 * sqrt(OCCASIONS * probability * (1 - probability))


def test_certain_and_impossible_faults_follow_their_probability() -> None:
    assert fired(When(), range(5)) == [0, 1, 2, 3, 4]
    assert fired(When(probability=0.0), range(OCCASIONS)) == []


def test_draws_follow_from_the_seed() -> None:
    when = When(probability=0.5)
    assert fired(when, range(100), 1) == fired(when, range(100), 1) != fired(when, range(100), 2)


@pytest.mark.parametrize(
    ("when", "times"),
    [
        (When(after_ns=3, until_ns=6), [3, 4, 5]),
        (When(number=(2, 5)), [1, 4]),
        (When(number=(2, 5), after_ns=3), [4, 7]),
        (When(every=3), [2, 5, 8]),
        (When(every=3, after_ns=2), [4, 7]),
        (When(count=2), [0, 1]),
        (When(count=2, every=2), [1, 3]),
        (When(at_ns=(7, 4)), [4, 7]),
        (When(at_ns=(4, 4)), [4, 5]),
        (When(at_ns=(2, 5), count=1), [2]),
    ],
)
def test_windows_numbers_and_counts(when: When, times: list[int]) -> None:
    assert fired(when, range(10)) == times


def test_fault_at_a_time_waits_for_the_next_occasion() -> None:
    assert fired(When(at_ns=(5, 6, 20)), [0, 4, 9, 10, 11, 30, 31]) == [9, 10, 30]


def test_occasions_are_counted_inside_and_outside_the_window() -> None:
    gate = Gate(When(after_ns=3, count=1), Random(0))
    assert [gate.opens(time) for time in range(6)] == [False, False, False, True, False, False]
    assert (gate.seen, gate.fired) == (6, 1)

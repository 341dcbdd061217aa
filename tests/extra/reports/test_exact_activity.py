"""Exact times of activities: windows around marks, in bounded memory."""

from __future__ import annotations

from cfepy.extra.reports.bins import AFTER, BEFORE, MOST_ACTIVITIES, Activity, ExactActivity


def filled(count: int, exact: ExactActivity | None = None, first: int = 0) -> ExactActivity:
    exact = exact or ExactActivity()
    for at in range(first, first + count):
        exact.add("A", at * 10, at * 10 + 5)
    return exact


def test_short_run_is_one_whole_window() -> None:
    exact = filled(20)
    exact.keep()
    filled(20, exact, 20)
    exact.conclude(1_000)
    (window,) = exact.windows
    assert (window.from_ns, window.to_ns) == (0, 1_000)
    assert window.activities == [Activity("A", at * 10, at * 10 + 5) for at in range(40)]


def test_window_has_the_activities_before_and_after_a_mark() -> None:
    exact = filled(3 * BEFORE)
    exact.keep()
    filled(3 * BEFORE, exact, 3 * BEFORE)
    marked = exact.windows[0]
    assert [len(each.activities) for each in exact.windows] == [BEFORE + AFTER]
    assert marked.activities[0].begin_ns == 2 * BEFORE * 10
    assert marked.from_ns == 2 * BEFORE * 10 - 5, "it begins where the activity before it ends"
    assert marked.to_ns == marked.activities[-1].end_ns == (3 * BEFORE + AFTER - 1) * 10 + 5


def test_end_of_the_run_is_a_window_of_its_own() -> None:
    exact = filled(3 * BEFORE)
    exact.keep()
    filled(3 * BEFORE, exact, 3 * BEFORE)
    exact.conclude(10**6)
    assert [len(each.activities) for each in exact.windows] == [BEFORE + AFTER, BEFORE]
    assert exact.windows[1].to_ns == 10**6


def test_marks_close_together_share_a_window() -> None:
    exact = filled(3 * BEFORE)
    exact.keep()
    filled(10, exact, 3 * BEFORE)
    exact.keep()
    filled(AFTER + 10, exact, 3 * BEFORE + 10)
    assert [len(each.activities) for each in exact.windows] == [BEFORE + 10 + AFTER]


def test_many_marks_do_not_keep_more_than_the_limit() -> None:
    exact = ExactActivity()
    for mark in range(50):
        filled(2 * BEFORE, exact, mark * 2 * BEFORE)
        exact.keep()
    exact.conclude(10**9)
    assert sum(len(each.activities) for each in exact.windows) <= MOST_ACTIVITIES + BEFORE + AFTER + BEFORE
    assert exact.windows[-1].to_ns == 10**9

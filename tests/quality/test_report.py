"""The page of planted bugs is made from the measurements, with all expected content."""

from __future__ import annotations

import statistics

from dev.quality.bugs import BUGS, CFE
from dev.quality.measure import LONGEST, TRIALS
from dev.quality.report import PAGE, SHRUNK, best, complete, load, medians, page
from dev.quality.shrinking import Shrunk


def test_each_bug_was_measured() -> None:
    measured = load()
    assert complete(measured), "run python -m dev.quality report"
    assert set(measured) == {bug.name for bug in BUGS}
    for bug in BUGS:
        for policy, found in medians(measured, bug.name).items():
            assert found.trials == (1 if policy.startswith("dfs") else TRIALS)


def test_page_matches_the_measurements() -> None:
    assert PAGE.read_text(encoding="utf-8") == page(load()), "run python -m dev.quality report"


def test_each_bug_is_found_and_half_of_them_within_50_schedules() -> None:
    measured = load()
    found = [best(measured, bug.name)[1] for bug in BUGS]
    assert all(each.found and each.schedules <= LONGEST for each in found)
    assert statistics.median(each.schedules for each in found) <= 50


def test_shrinking_leaves_few_preemptions() -> None:
    measured = load()
    left = {bug.name: Shrunk(**measured[bug.name][SHRUNK]).preemptions for bug in BUGS}
    assert not {bug.name: left[bug.name] for bug in BUGS if left[bug.name] > bug.preemptions}
    assert sum(bug.preemptions > 3 for bug in BUGS) <= 2


def test_bugs_are_of_all_kinds() -> None:
    worlds = [bug.world for bug in BUGS]
    assert len(BUGS) >= 25
    assert worlds.count(CFE) >= 5
    assert len({kind for bug in BUGS for kind in bug.kinds}) >= 6

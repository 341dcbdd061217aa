"""Planted bugs are found by exploring, not by an ordinary flight; mended missions never fail."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import pytest

from cfepy.extra.exploration.shrink import SUBSETS_OF
from cfepy.extra.exploration.trial import Trial
from cfepy.extra.exploration.verdict import Verdict
from cfepy.schedules import Schedule
from dev.quality.bugs import BUGS, MISSIONS, Bug, reference_trial
from dev.quality.measure import as_deviations, find, simplest
from dev.quality.mended import mended_trial
from dev.quality.programs import PROGRAMS
from dev.quality.report import best, load, shown_by
from dev.quality.shrinking import shrunk

EACH = pytest.mark.parametrize("bug", BUGS, ids=[bug.name for bug in BUGS])
LONG = ("changed_while_iterated", "lost_wakeup", "packet_burst", "preempt_race")
LONG_TO_SHRINK = ("lost_wakeup", "double_buffer", "check_then_act", "preempt_race")
"""These take 150 s of CPU time together; `python -m dev.quality report` shrinks them, too."""
MOST_LATER = pytest.mark.parametrize(
    "bug",
    [
        pytest.param(bug, marks=[pytest.mark.slow] * bool(number % 4 or bug.name in LONG), id=bug.name)
        for number, bug in enumerate(BUGS)
    ],
)
"""Each bug; three of four, and those that take long, are left to the slow tests."""


def found_by(bug: Bug, policy: str) -> Verdict:
    verdict = find(reference_trial(bug.folder), policy)
    assert verdict is not None, f"{policy} does not find {bug.name}"
    return verdict


def test_every_mission_is_listed() -> None:
    assert sorted(bug.name for bug in (*BUGS, *PROGRAMS)) == sorted(
        path.parent.name for path in MISSIONS.glob("*/startup.scr")
    )


@MOST_LATER
def test_fifo_shows_no_bug(bug: Bug) -> None:
    trial = reference_trial(bug.folder)
    plain, asked = trial.run(Schedule()), trial.run(Schedule("at"))
    assert not plain.failures
    assert not plain.trouble
    assert asked.trace == plain.trace


@MOST_LATER
def test_best_policy_finds_the_bug_and_its_schedule_reproduces_it_on_threads(bug: Bug) -> None:
    verdict = found_by(bug, best(load(), bug.name)[0])
    assert verdict.failures[0].kind in bug.kinds
    assert "\n" not in verdict.failures[0].text
    schedule = as_deviations(verdict)
    for tasks in ("greenlet", "thread"):
        again = reference_trial(bug.folder, tasks).run(schedule)
        assert again.failures == verdict.failures
        assert again.trace == verdict.trace


def never_fails(trial: Trial, policy: str, schedules: int) -> None:
    failed = find(trial, policy, schedules)
    assert failed is None, failed


@MOST_LATER
def test_mended_mission_does_not_fail(bug: Bug, tmp_path: Path) -> None:
    never_fails(mended_trial(bug, tmp_path)[0], "all", 4)


@pytest.mark.slow
@EACH
@pytest.mark.parametrize("policy", ["all", "dfs 2"])
def test_mended_mission_does_not_fail_under_many_schedules(bug: Bug, policy: str, tmp_path: Path) -> None:
    never_fails(mended_trial(bug, tmp_path)[0], policy, 12)


def shrinks(bug: Bug) -> None:
    """Assert that the shrunk schedule fails in the same way, on both contexts."""
    verdicts = simplest(reference_trial(bug.folder), shown_by(load(), bug.name))
    assert verdicts
    small = shrunk(bug, verdicts)
    assert small.preemptions <= bug.preemptions
    schedule, group = Schedule.parse(small.schedule), verdicts[0].groups[0]
    for tasks in ("greenlet", "thread"):
        assert group in reference_trial(bug.folder, tasks).run(schedule).groups
    for size in range(len(schedule.moves) if len(schedule.moves) <= SUBSETS_OF else 0):
        for subset in combinations(schedule.moves, size):
            assert group not in reference_trial(bug.folder).run(schedule.by_moves(subset)).groups


@pytest.mark.slow
@pytest.mark.parametrize("bug", [bug for bug in BUGS if bug.name not in LONG_TO_SHRINK], ids=lambda bug: bug.name)
def test_shrinking_leaves_few_preemptions(bug: Bug) -> None:
    shrinks(bug)

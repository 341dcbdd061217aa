"""The kinds of switches that a search has seen."""

from __future__ import annotations

from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from cfepy.extra.exploration.switch_kinds import LEAST_PATIENCE, SwitchKinds
from cfepy.extra.exploration.trial import Trial
from cfepy.extra.exploration.verdict import Failure, Verdict
from cfepy.pilot import RunPlan
from cfepy.schedules import Schedule
from tests.extra.exploration import missions

RANDOM = Schedule.parse("random:1")


def seen(*runs: tuple[int, ...]) -> SwitchKinds:
    found = SwitchKinds()
    for switches in runs:
        found.take(Verdict(RANDOM, switches=switches))
    return found


def test_search_is_over_when_schedules_bring_no_new_kind() -> None:
    assert not seen((1, 2), *[(1,)] * (LEAST_PATIENCE - 1)).are_all_known
    assert seen((1, 2), *[(1,)] * LEAST_PATIENCE).are_all_known


def test_late_kind_lets_the_search_go_on() -> None:
    late = [*[(1,)] * 200, (1, 3)]
    assert not seen(*late, *[(3,)] * 99).are_all_known
    assert seen(*late, *[(3,)] * 101).are_all_known


def test_new_failure_counts_as_new() -> None:
    found = seen((1,), (1,))
    failure = Failure("died", "ARM", "ended")
    assert [found.take(Verdict(RANDOM, (failure,), switches=(1,))) for _ in range(2)] == [1, 0]
    assert found.last_new == 3


@given(st.lists(st.frozensets(st.integers(0, 9)), max_size=40))
def test_each_kind_counts_once(runs: list[frozenset[int]]) -> None:
    found = SwitchKinds()
    assert sum(found.take(Verdict(RANDOM, switches=tuple(sorted(run)))) for run in runs) == len(
        frozenset().union(*runs)
    )
    assert found.to_dict()["schedules"] == len(runs)


def flown(folder: Path) -> Trial:
    bank = missions.write(folder, {"BANK": missions.LOST_UPDATE})
    return Trial(RunPlan((str(bank),), seconds=0.6, tasks="greenlet"), keep_switches=True)


def test_kinds_are_the_same_in_each_run(tmp_path: Path) -> None:
    trial = flown(tmp_path)
    one, again = trial.run(RANDOM), trial.run(RANDOM)
    assert one.switches == again.switches
    assert one.switches
    assert trial.run(Schedule.parse("at")).switches == ()
    assert Verdict.from_dict(one.to_dict()) == one


def test_noting_switches_does_not_change_the_run(tmp_path: Path) -> None:
    trial = flown(tmp_path)
    assert trial.run(RANDOM).trace == Trial(trial.plan).run(RANDOM).trace

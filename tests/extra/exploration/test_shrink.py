"""Shrinking ends at a schedule with few preemptions that fails in the same way."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.exploration.shrink import LEAST_PROBES, MOST_PROBES, Shrinker, budget_of
from cfepy.extra.exploration.timeline import story_of
from cfepy.extra.exploration.trial import Trial
from cfepy.extra.exploration.verdict import INVARIANT
from cfepy.pilot.plan import RunPlan
from cfepy.schedules import Move, Schedule
from tests.extra.exploration import missions

PAID = 'invariants: {all paid: {topic: /total, holds: "msg.data == 6"}}\n'


@pytest.fixture(scope="module")
def bank(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return missions.write(tmp_path_factory.mktemp("bank"), {"BANK": missions.LOST_UPDATE}, PAID)


def first_failing(trial: Trial, options: str = "") -> Schedule:
    """Return the first seed under which a trial fails."""
    schedules = (Schedule.parse(f"random:{seed}{options}") for seed in range(500))
    return next(schedule for schedule in schedules if trial.run(schedule).failed)


@pytest.mark.slow
def test_shrinking_ends_with_few_preemptions_and_the_same_failure(tmp_path: Path) -> None:
    trial = Trial(RunPlan((str(missions.write_late(tmp_path)),), seconds=1.5, tasks="greenlet"))
    schedule = first_failing(trial)
    verdict = trial.run(schedule)
    shrunk = Shrinker(trial, [schedule], verdict.groups[0]).run()
    assert shrunk is not None
    assert len(verdict.deviations) > 3
    assert len(shrunk.verdict.deviations) == len(shrunk.moves) == 1
    assert shrunk.verdict.schedule.kind == "moves"
    assert shrunk.verdict.groups[0] == verdict.groups[0]
    assert shrunk.trial.plan.seconds == 0.7
    assert shrunk.trial.run(shrunk.verdict.schedule) == shrunk.verdict
    assert Shrinker(trial, [schedule], verdict.groups[0]).run() == shrunk


def test_schedule_that_does_not_fail_is_not_shrunk(bank: Path) -> None:
    trial = Trial(RunPlan((str(bank),), seconds=0.7))
    assert Shrinker(trial, [Schedule()], f"{INVARIANT}|all paid|x").run() is None


def test_other_permanent_failure_does_not_end_the_shrinking_early(tmp_path: Path) -> None:
    folder = missions.write_late(tmp_path)
    with (folder / "apps.py").open("a") as apps:
        apps.write("\n\ndef Grumbler(cfe):\n    cfe.evs.register()\n    cfe.evs.send_err(9, 'as always')\n")
    startup = (folder / "startup.scr").read_text(encoding="utf-8")
    (folder / "startup.scr").write_text(
        f"CFE_APP, apps, Grumbler, GRUMBLER, 40, 8192, 0, 0;\n{startup}", encoding="utf-8"
    )
    late = Trial(RunPlan((str(folder),), seconds=0.7, tasks="greenlet"))
    (always,) = late.run(Schedule()).failures
    verdict = next(found for seed in range(30) if len((found := late.run(Schedule("random", seed))).failures) > 1)
    (other,) = (failure for failure in verdict.failures if failure.group != always.group)
    shrunk = Shrinker(late, [verdict.schedule], other.group).run()
    assert shrunk is not None
    assert shrunk.moves
    assert other.group in late.run(shrunk.verdict.schedule).groups


def test_shrinking_respects_its_number_of_runs(bank: Path) -> None:
    trial = Trial(RunPlan((str(bank),), seconds=0.7))
    schedule = Schedule.parse("at:1=1,4=1,7=1")
    (group,) = trial.run(schedule).groups
    shrunk = Shrinker(trial, [schedule], group, most_probes=10).run()
    assert shrunk is not None
    assert shrunk.probes <= 10 + 3 + 1  # and the subsets of two moves, and the one that makes sure of the result


def test_shrinking_respects_its_time(bank: Path) -> None:
    trial = Trial(RunPlan((str(bank),), seconds=0.7))
    schedule = Schedule.parse("at:1=1,4=1,7=1")
    (group,) = trial.run(schedule).groups
    shrunk = Shrinker(trial, [schedule], group, most_s=0.0).run()
    assert shrunk is not None
    assert shrunk.is_cut_short
    assert shrunk.probes <= 3  # the first, the same in a shorter run, and the one that makes sure of the result
    assert shrunk.text("--time").endswith("found in 3 runs, until its time was over (--time gives more)")
    whole = Shrinker(trial, [schedule], group).run()
    assert whole is not None
    assert not whole.is_cut_short
    assert whole.text("--time") == f"2 preemptions, found in {whole.probes} runs"


def test_the_timeline_shows_both_tasks_up_to_the_failure(bank: Path) -> None:
    trial = Trial(RunPlan((str(bank),), seconds=0.7))
    schedule = Schedule.parse("at:4=1,7=1")
    (group,) = trial.run(schedule).groups
    shrunk = Shrinker(trial, [schedule], group, most_probes=0).run()
    assert shrunk is not None
    failure = shrunk.verdict.failure(group)
    assert failure is not None
    lines = story_of(shrunk.trial, shrunk.verdict, failure, shrunk.moves).lines()
    golden = Path(__file__).with_name("golden_timeline.txt").read_text(encoding="utf-8").splitlines()
    assert lines == golden
    assert max(map(len, lines)) <= 100


def test_impossible_move_is_removed(bank: Path) -> None:
    trial = Trial(RunPlan((str(bank),), seconds=0.7))
    moves = [Move("NOBODY", "BANK"), Move("BANK", "NOBODY")]
    tried = trial.fly(Schedule().by_moves(moves))
    assert not tried.verdict.failed
    assert tried.verdict.preemptions == 0
    assert tried.verdict.missed == tuple(move.text() for move in moves)
    note = "0 of 2 moves of the schedule were possible; not possible: NOBODY=BANK, BANK=NOBODY"
    assert note in tried.notes


def test_shrinking_may_use_as_many_runs_as_the_search() -> None:
    assert [budget_of(flown) for flown in (1, 500, 100_000)] == [LEAST_PROBES, 500, MOST_PROBES]


def test_options_of_the_schedule_stay(tmp_path: Path) -> None:
    trial = Trial(RunPlan((str(missions.write_late(tmp_path)),), seconds=0.7, tasks="greenlet"))
    schedule = first_failing(trial, ":from=500ms")
    shrunk = Shrinker(trial, [schedule], trial.run(schedule).groups[0]).run()
    assert shrunk is not None
    assert shrunk.verdict.schedule.from_ns == 500_000_000
    assert len(shrunk.verdict.deviations) == 1

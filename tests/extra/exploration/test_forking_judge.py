"""A forked flight has the verdict of a whole one, and an error that ends its process is still found."""

from __future__ import annotations

import time
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest

from cfepy.extra.exploration.campaign import Campaign
from cfepy.extra.exploration.fork_server import ForkingJudge, ForkingNotes
from cfepy.extra.exploration.shrink import Shrinker, fly_noting
from cfepy.extra.exploration.trial import Trial
from cfepy.extra.exploration.verdict import Verdict
from cfepy.extra.exploration.workers import PROCESS_DIED, Processes
from cfepy.pilot.plan import RunPlan
from cfepy.rtos.cpu_time import Expenses, Spent
from cfepy.schedules import Schedule
from tests.extra.exploration.fake_trials import Seeds

CRASH = """
import ctypes
def Main(cfe):
    cfe.es.run_loop()
    cfe.os.task_delay(100)
    ctypes.string_at(0)
"""
STARTUP = "CFE_APP, crash.py, Main, CRASH, 100, 16384, 0x0, 0;\n!\n"

MISSIONS = Path(__file__).parents[2] / "quality" / "missions"
BOOTED_NS = 600_000_000  # when the mission is up


class LateSeeds(Seeds):
    """Schedules that part when the mission is up."""

    def next(self) -> Schedule | None:
        schedule = super().next()
        return None if schedule is None else replace(schedule, from_ns=BOOTED_NS)


@pytest.fixture
def crash(tmp_path: Path) -> Trial:
    """Return a mission whose process is killed by the operating system."""
    (tmp_path / "startup.scr").write_text(STARTUP, encoding="utf-8")
    (tmp_path / "crash.py").write_text(CRASH, encoding="utf-8")
    return Trial(RunPlan((str(tmp_path),), seconds=1.0, tasks="greenlet"))


@pytest.mark.slow
def test_a_forked_flight_has_the_verdict_of_a_whole_one() -> None:
    trial = Trial(RunPlan(("capture",), seconds=0.605, tasks="greenlet"))
    with closing(ForkingJudge(trial)) as pilot:
        for text in ("random:1:from=600ms", "random:2:from=600ms", "pct:3:2:200:from=600ms:hold=1ms"):
            schedule = Schedule.parse(text)
            assert pilot.judge(schedule) == trial.run(schedule)
    thread = Trial(replace(trial.plan, tasks="thread"))
    with closing(ForkingJudge(thread)) as pilot:
        schedule = Schedule("random", 1, from_ns=BOOTED_NS)
        assert pilot.judge(schedule).trace == trial.run(schedule).trace


def test_schedules_that_differ_only_after_the_end_are_judged() -> None:
    trial = Trial(RunPlan(("capture",), seconds=0.1, tasks="greenlet"))
    with closing(ForkingJudge(trial)) as pilot:
        schedules = [Schedule("random", seed, from_ns=BOOTED_NS) for seed in range(2)]
        verdicts = [pilot.judge(schedule) for schedule in schedules]
    assert verdicts == [trial.run(schedule) for schedule in schedules]


@pytest.mark.slow
def test_forked_flights_have_the_moves_of_whole_ones() -> None:
    trial = Trial(RunPlan(("capture",), seconds=0.605, tasks="greenlet"))
    schedule = Schedule.parse("random:1:from=600ms")
    with closing(ForkingNotes()) as forks:
        noted = forks.fly(trial, schedule)
        assert noted == fly_noting(trial, schedule)
        assert forks.fly(trial, schedule.by_moves([each.move for each in noted.made])).made == noted.made


@pytest.mark.slow
@pytest.mark.parametrize("name", ["lost_update", "lock_order"])
def test_shrinking_by_forked_flights_gives_the_same_result(name: str) -> None:
    trial = Trial(RunPlan((str(MISSIONS / name),), seconds=1.3, tasks="greenlet"))
    schedules = (Schedule("random", seed, from_ns=BOOTED_NS) for seed in range(100))
    failing = next(verdict for verdict in map(trial.run, schedules) if verdict.failures)
    with closing(ForkingNotes()) as forks:
        shrunk = Shrinker(trial, [failing.schedule], failing.groups[0], fly=forks.fly).run()
    assert shrunk == Shrinker(trial, [failing.schedule], failing.groups[0]).run()


@pytest.mark.slow
def test_a_crash_in_a_forked_flight(crash: Trial) -> None:
    told: list[Verdict] = []
    tally = Campaign(crash, LateSeeds(), 2, Processes(1)).run(lambda _, verdict: told.append(verdict))
    assert tally.failed == 2
    for verdict in told:
        failure = verdict.failures[0]
        assert (failure.kind, failure.text) == (PROCESS_DIED, "the process died: killed by SIGSEGV")
        assert "crash.py" in failure.detail


class _Busy(Expenses):
    """Says that the process had the computer for all of the time."""

    def __call__(self) -> Spent:
        wall_s = super().__call__().wall_s
        return Spent(wall_s, wall_s, 0.0)


@pytest.mark.slow
def test_forked_process_that_waits_for_schedules_is_not_a_stall(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("cfepy.rtos.cpu_time.Expenses", _Busy)
    trial = Trial(RunPlan(("capture",), seconds=0.605, tasks="greenlet", stall=0.2))
    schedule = Schedule.parse("random:1:from=600ms")
    with closing(ForkingJudge(trial)) as pilot:
        first = pilot.judge(schedule)
        time.sleep(1)  # the limit, several times
        assert pilot.judge(schedule) == first
    assert not first.failures

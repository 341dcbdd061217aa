"""Random faults on the shipped missions: nothing breaks, and everything is reproducible."""

from __future__ import annotations

import pytest

from cfepy.faults import FaultInjector, FaultPlan, check_plan, look_at, plan_of, prepare, random_plan
from cfepy.mission import Mission, read_mission
from cfepy.pilot.pilot import fly
from cfepy.pilot.plan import RunPlan
from cfepy.pilot.results import Results, mark
from cfepy.rtos.errors import InjectedCrash
from cfepy.status import CfeError, UsageError
from cfepy.writing.console import Console


def flown(name: str, plan: FaultPlan, seconds: float, tasks: str = "thread") -> Results:
    """Fly a mission with faults. Applications may only die of the injected faults."""
    with Mission(name, console=Console(quiet=True), tasks=tasks, attachments=[FaultInjector(plan)]) as mission:
        mission.run_for(seconds)
        at = mark(mission, 0)
        mission.shut_down_nodes()
        digest = mission.trace.digest()
    for history in mission.record.history.values():
        error = history.last_error
        assert (
            error is None or isinstance(error, InjectedCrash) or (isinstance(error, CfeError) and "fault" in str(error))
        )
    return Results.of(mission, at, digest)


def check(name: str, seeds: range, seconds: float, intensity: str = "high") -> None:
    found = look_at(read_mission(name))
    for seed in seeds:
        plan = random_plan(seed, found.targets, intensity)
        assert check_plan(plan, read_mission(name), found) == []
        first = flown(name, plan, seconds)
        again = flown(name, FaultPlan.from_dict(plan.to_dict()), seconds, "greenlet")
        assert first.trace == again.trace, f"seed {seed}"
        assert first.faults == again.faults
        assert sum(row["times"] > 0 for row in first.faults) > 0


@pytest.mark.parametrize("name", ["lab", "sched", "rx64m_pubsub"])
def test_random_faults_repeat(name: str) -> None:
    check(name, range(1), 11)


@pytest.mark.slow
def test_random_faults_repeat_on_capture() -> None:
    check("capture", range(1), 3)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "count", "seconds"), [("lab", 50, 12), ("sched", 25, 12), ("rx64m_pubsub", 25, 12), ("capture", 10, 6)]
)
def test_many_random_faults_repeat(name: str, count: int, seconds: float) -> None:
    check(name, range(100, 100 + count), seconds)


def test_plan_is_equal_by_seed_by_text_and_as_a_run_plan() -> None:
    spec = read_mission("lab")
    plan = plan_of("seed:3:low", spec)
    assert len(plan.faults) == 2
    assert plan_of(plan.to_yaml(), spec) == plan
    by_seed = RunPlan(("lab",), seconds=4, faults="seed:3:low")
    assert fly(by_seed).trace == fly(RunPlan(("lab",), seconds=4, faults=plan.to_yaml())).trace
    assert "--faults seed:3:low" in by_seed.command_line()
    assert fly(by_seed).trace != fly(RunPlan(("lab",), seconds=4)).trace


LOST = FaultPlan.from_dict({"faults": [{"drop": "/no_such_topic"}, {"crash": "NOBODY", "at": 2}]}).to_yaml()


def test_prepared_plan_reports_names_missing_in_the_mission() -> None:
    spec = read_mission("lab")
    prepared = prepare(LOST, spec)
    assert prepared.injector.plan == plan_of(LOST, spec)
    assert ["unknown application NOBODY" in problem.text for problem in prepared.problems] == [True]
    texts = [problem.text for problem in prepare(LOST, spec, flies=True).problems]
    assert ["unknown message /no_such_topic" in texts[0], "unknown application" in texts[1]] == [True, True]
    assert prepare("seed:3", spec, flies=True).problems == ()


def test_injector_serves_several_missions_in_turn() -> None:
    injector = FaultInjector(plan_of("seed:5:high", read_mission("lab")))
    traces = []
    for _ in range(2):
        with Mission("lab", console=Console(quiet=True), attachments=[injector]) as mission:
            mission.run_for(11)
            traces.append(mission.trace.digest())
    assert traces[0] == traces[1]


@pytest.mark.parametrize("text", ["seed:", "seed:x", "seed:3:much", "seed:-1"])
def test_invalid_seed_of_a_plan_is_refused(text: str) -> None:
    with pytest.raises(UsageError, match="seed:7"):
        plan_of(text, read_mission("lab"))


def test_seed_of_the_run_changes_the_draws() -> None:
    plan = FaultPlan.from_dict({"faults": [{"drop": "CFE_TIME_*", "probability": 0.5}]}).to_yaml()
    traces = {fly(RunPlan(("lab",), seconds=10, seed=seed, faults=plan)).trace for seed in (1, 1, 2)}
    assert len(traces) == 2

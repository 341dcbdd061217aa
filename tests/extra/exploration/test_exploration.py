"""An exploration as a whole: the command's options and defaults are those of `Expedition`."""

from __future__ import annotations

import argparse
import io
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from cfepy.cli.parser import CommandParser
from cfepy.extra.exploration import Expedition, Report, Trial
from cfepy.extra.exploration import commands as room
from cfepy.extra.exploration.commands.explore import show
from cfepy.extra.exploration.exploration import DEFAULT_SEEDS, FROM_OPERATIONAL
from cfepy.extra.exploration.trial import Tried
from cfepy.pilot import RunPlan
from cfepy.schedules import Schedule
from cfepy.status import UsageError
from tests.extra.exploration import missions

BY_ADDRESS = """
    import rospy

    rospy.init_node("pair")
    rospy.sleep(0.1 + id(rospy) % 1009 / 1e6)
    rospy.spin()
"""
TEXT_BY_ADDRESS = missions.LOST_UPDATE.replace("total.publish(balance)", "assert balance == 6, id(rospy)")
ODOMETER = str(Path(__file__).parents[2] / "quality" / "missions" / "lost_update")
PLAN = RunPlan((ODOMETER,), seconds=1.3, tasks="greenlet")


def options() -> argparse.Namespace:
    parser = CommandParser()
    room.add(parser.add_subparsers())
    return parser.parse_args(["explore", "capture"])


def test_command_has_the_defaults_of_the_expedition() -> None:
    parsed, usual = options(), Expedition(PLAN)
    assert parsed.shrink is None
    for name in (
        "policy",
        "depth",
        "first_seed",
        "any_priority",
        "until_failure",
        "events",
        "jobs",
        "cluster",
    ):
        assert getattr(parsed, name) == getattr(usual, name), name
    assert (parsed.budget, parsed.shrink, parsed.longest) == (usual.budget_s, usual.shrink, usual.longest_s)
    assert usual.seeds == DEFAULT_SEEDS
    assert (parsed.hold, getattr(parsed, "from"), parsed.no_stuck) == (usual.hold_s, usual.from_s, not usual.stuck)
    assert parsed.connect is usual.connect_s


@pytest.mark.slow
def test_failure_is_shrunk_and_reported_with_its_timeline() -> None:
    report = Expedition(PLAN, seeds=8, jobs=1, until_failure=True).run()
    told = report.findings[0]
    assert "WHEELS" in told.finding.failure.title
    assert told.shrunk is not None
    assert told.shrunk.verdict.preemptions == 1
    assert any("PREEMPTED" in line for line in told.timeline)
    assert report.to_dict()["failures"][0]["shrunk"]["schedule"] == str(told.shrunk.verdict.schedule)


def test_invalid_time_is_reported_with_its_option() -> None:
    with pytest.raises(UsageError, match="--hold"):
        Expedition(PLAN, hold_s=-1).run()


def explored(folder: Path, source: str) -> Report:
    plan = RunPlan((str(missions.write(folder, {"PAIR": source})),), seconds=1.0, tasks="greenlet")
    return Expedition(plan, seeds=30, jobs=1, until_failure=True).run()


@pytest.mark.slow
def test_nondeterministic_mission_is_not_explored(tmp_path: Path) -> None:
    report = explored(tmp_path, BY_ADDRESS)
    assert (report.is_steady, report.unsteady, report.tally.done) == (False, Schedule(), 0)
    assert report.to_dict()["deterministic"] is False


@pytest.mark.slow
def test_failure_with_varying_text_is_shrunk_and_reported_as_nondeterministic(tmp_path: Path) -> None:
    report = explored(tmp_path, TEXT_BY_ADDRESS)
    (told,) = report.findings
    assert (told.repeats, told.is_steady) == (True, False)
    assert told.shrunk is not None
    assert report.unsteady == told.finding.verdict.schedule


@pytest.mark.slow
def test_deterministic_mission_is_not_reported_as_nondeterministic() -> None:
    assert Expedition(PLAN, seeds=8, jobs=1, until_failure=True).run().unsteady is None


@pytest.mark.slow
def test_failure_that_does_not_repeat_is_reported_as_seen_once(monkeypatch: pytest.MonkeyPatch) -> None:
    fly = Trial.fly
    flown: list[Schedule] = []

    def once(self: Trial, schedule: Schedule, *args: Any, **options: Any) -> Tried:
        tried = fly(self, schedule, *args, **options)
        flown.append(schedule)
        is_again = schedule.kind != "at" and options.get("policy") is None
        return tried._replace(verdict=replace(tried.verdict, failures=())) if is_again else tried

    monkeypatch.setattr(Trial, "fly", once)  # in this process; the crew flies in another one
    report = Expedition(PLAN, seeds=8, jobs=1, until_failure=True).run()
    (told,) = report.findings
    assert (told.repeats, told.shrunk, told.timeline) == (False, None, [])
    assert report.unsteady == told.finding.verdict.schedule
    assert flown[-1] == told.finding.verdict.schedule
    stream = io.StringIO()
    show(report, stream)
    assert stream.getvalue().startswith("seen once and not again: failure 1: ")


@pytest.mark.slow
def test_exploration_may_begin_when_the_mission_is_operational() -> None:
    report = Expedition(PLAN, seeds=3, policy="random", jobs=1, from_s=FROM_OPERATIONAL, shrink=0).run()
    assert report.tally.done == 3
    assert {told.finding.verdict.schedule.from_ns for told in report.findings} == {600_000_000}


def test_begin_at_operational_is_refused_when_the_mission_never_is() -> None:
    plan = replace(PLAN, seconds=0.3)
    with pytest.raises(UsageError, match="--from: the mission does not become OPERATIONAL"):
        Expedition(plan, from_s=FROM_OPERATIONAL).run()


CROSSED = (
    missions.LOCK_ORDER.replace("rospy.get_time()", "pass")
    .replace("with first:\n", "with first:\n                both.wait()\n")
    .replace("left, right =", "both = threading.Barrier(2)\n    left, right =")
)


def test_failure_of_fifo_has_a_timeline_and_a_circle_its_cause(tmp_path: Path) -> None:
    locks = missions.write(tmp_path, {"LOCKS": CROSSED})
    plan = RunPlan((str(locks),), seconds=0.6, tasks="greenlet")
    (told,) = Expedition(plan, seeds=1, jobs=1, shrink=0).run().findings
    assert told.finding.in_reference
    assert told.story.cause.startswith("LOCKS.locks.1.1 holds left (locks.py:6) and waits for right (locks.py:6); ")
    assert any("wants right" in line and "which LOCKS.locks.2.2 has" in line for line in told.timeline), told.timeline
    assert any(line.startswith("at the end  FAILURE in LOCKS") for line in told.timeline)


@pytest.mark.slow
def test_search_ends_when_schedules_bring_nothing_new(tmp_path: Path) -> None:
    stock = missions.write(tmp_path, {"STOCK": missions.CHECK_THEN_ACT})
    plan = RunPlan((str(stock),), seconds=0.6, tasks="greenlet")
    report = Expedition(plan, seeds=None, until_known=True, jobs=1, shrink=0).run()
    kinds = report.breadth.switches
    assert kinds is not None
    assert kinds.are_all_known
    assert report.tally.done == kinds.done < 500
    assert f"no new one in the last {kinds.done - kinds.last_new} schedules" in "\n".join(report.breadth.lines())
    assert report.trial.keep_switches is False


@pytest.mark.parametrize(
    ("expedition", "remedy"),
    [
        (Expedition(PLAN, seeds=None, until_known=True, policy="dfs"), "with --policy all or random or pct or abreast"),
        (Expedition(PLAN, seeds=None, until_known=True, worst="response:STOCK"), "without --worst"),
    ],
)
def test_only_schedules_from_seeds_end_by_themselves(expedition: Expedition, remedy: str) -> None:
    with pytest.raises(UsageError, match=f"--seeds: auto is possible only {remedy}"):
        expedition.run()


def test_time_budget_ends_the_exploration(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cfepy.rtos.Stopwatch.elapsed_ns", lambda self: 2_000_000_000)
    assert Expedition(PLAN, seeds=1000, budget_s=1.0, jobs=1, shrink=0).run().tally.done == 1

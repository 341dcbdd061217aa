"""Accesses of missions in a search of orders: all orders of small missions in a few runs, and none left out."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from cfepy.extra.exploration import Expedition, Report, Trial
from cfepy.extra.exploration.partial_orders import Order, OrderSearch
from cfepy.extra.exploration.verdict import DEADLOCK, EVENT, RAISED
from cfepy.mission import CORE_APPS
from cfepy.pilot import RunPlan
from cfepy.schedules import Schedule
from cfepy.status import UsageError
from dev.quality.bugs import MISSIONS, SECONDS, by_name
from tests.mission.flights import write_mission

FROM = "600ms"


def explored(name: str, depth: int | None = None) -> Report:
    plan = RunPlan((str(MISSIONS / name),), seconds=SECONDS, tasks="greenlet")
    return Expedition(plan, seeds=60, policy="orders", depth=depth, from_s=0.6, jobs=1, shrink=100).run()


@pytest.mark.slow
def test_ended_node_is_reported_as_an_unexplored_order() -> None:
    """Its subscriptions end with it, in orders that are not all tried."""
    report = explored("check_then_act")
    assert [told.finding.failure.kind for told in report.findings] == [RAISED]
    assert any("in which the subscriptions of a stopped node end" in line for line in report.breadth.lines())


@pytest.mark.slow
def test_search_to_a_depth_reports_its_depth() -> None:
    report = explored("lock_order", 16)
    assert any("all orders up to 16 steps were seen" in line for line in report.breadth.lines())
    assert not any("no others" in line for line in report.breadth.lines())


@pytest.mark.slow
@pytest.mark.parametrize(("name", "orders"), [("lock_order", 7), ("mutex_order", 6)])
def test_all_orders_of_two_locks_are_seen(name: str, orders: int) -> None:
    report = explored(name)
    seen = report.breadth.seen
    assert seen is not None
    assert seen.is_complete
    assert (seen.orders, report.tally.done, seen.astray) == (orders, orders, 0)
    assert [told.finding.failure.kind for told in report.findings] == [DEADLOCK]
    assert report.findings[0].repeats
    assert any("no others were found" in line for line in report.breadth.lines())


@pytest.mark.slow
def test_kept_address_of_a_table_reads_its_memory() -> None:
    report = explored("table_kept")
    assert report.breadth.seen is not None
    assert report.breadth.seen.is_complete
    assert [told.finding.failure.kind for told in report.findings] == [EVENT]


@pytest.mark.slow
def test_schedule_of_a_failure_reproduces_it() -> None:
    (told,) = explored("lock_order").findings
    schedule = told.finding.verdict.schedule
    assert schedule == Schedule.parse(schedule.text())
    plan = RunPlan((str(MISSIONS / "lock_order"),), seconds=SECONDS, tasks="thread")
    assert told.finding.failure.group in Trial(plan).run(schedule).groups


@pytest.mark.slow
@pytest.mark.parametrize("name", ["lock_order, mended", "mutex_order, mended", "table_kept", "late_subscription"])
def test_random_schedules_have_no_unknown_order(tmp_path: Path, name: str) -> None:
    bug = by_name(name.removesuffix(", mended"))
    folder = bug.folder if name == bug.name else bug.write_fixed(tmp_path)
    trial = Trial(RunPlan((str(folder),), seconds=SECONDS, tasks="greenlet"), steps_from_ns=600_000_000)
    search, known, count = OrderSearch(Schedule.parse(f"at:from={FROM}"), CORE_APPS), set(), 0
    while (schedule := search.next()) is not None:
        verdict = trial.run(schedule)
        search.tell(count, verdict)
        known.add(Order(verdict.steps).without(CORE_APPS))
        count += 1
    assert not search.astray
    assert count < 100
    for seed in range(150):
        verdict = trial.run(Schedule.parse(f"random:{seed}:from={FROM}"))
        assert Order(verdict.steps).without(CORE_APPS) in known, seed


def test_steps_are_the_same_on_threads_and_greenlets() -> None:
    one, other = (
        Trial(RunPlan((str(MISSIONS / "lost_update"),), seconds=0.7, tasks=tasks), steps_from_ns=0).run(
            Schedule.parse("random:3")
        )
        for tasks in ("thread", "greenlet")
    )
    assert one.steps == other.steps
    assert len(one.steps) > 50


def test_recording_of_steps_does_not_change_the_run() -> None:
    trial = Trial(RunPlan((str(MISSIONS / "lost_update"),), seconds=0.8, tasks="greenlet"))
    for text in ("fifo", "random:3", "pct:4:2"):
        schedule = Schedule.parse(text) if text != "fifo" else Schedule().at({})
        kept = replace(trial, steps_from_ns=0).run(schedule)
        assert kept.steps
        assert replace(kept, steps=(), deviations=()) == replace(trial.run(schedule), deviations=())


def test_compiled_code_is_reported_as_unseen(tmp_path: Path) -> None:
    write_mission(tmp_path, "CFE_APP, app, APP_AppMain, APP, 60, 16384, 0x0, 0;\n!")
    (tmp_path / "app.so").write_bytes(b"\x7fELF")
    with pytest.raises(UsageError, match="APP is compiled") as told:
        Expedition(RunPlan((str(tmp_path),)), policy="orders").run()
    assert told.value.field == "--policy"

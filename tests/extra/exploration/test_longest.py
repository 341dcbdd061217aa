"""The search for the longest: measures, comparison with all schedules, and its report."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import pytest

from cfepy.extra.exploration import Expedition, Report, Worst
from cfepy.extra.exploration.commands.explore import show
from cfepy.extra.exploration.longest import FROM_SEEDS, MeasuredTrial, WorstSearch
from cfepy.extra.exploration.schedule_kinds import ScheduleKind
from cfepy.extra.exploration.search import SeededSearch
from cfepy.extra.exploration.verdict import Verdict
from cfepy.monitors.durations import Measure
from cfepy.pilot import RunPlan
from cfepy.schedules import Schedule
from cfepy.status import UsageError
from tests.mission.flights import write_mission

STARTUP = """
    CFE_APP, apps, CLOCK_Main, CLOCK, 30, 16384, 0, 0;
    CFE_APP, apps, LIST_Main,  LIST,  60, 16384, 0, 0;
    CFE_APP, apps, ONE_Main,   ONE,   60, 16384, 0, 0;
    CFE_APP, apps, TWO_Main,   TWO,   60, 16384, 0, 0;
    !
"""
APPS = """
    from cfepy.msg import Layout, Telemetry

    BEGIN = Telemetry("BEGIN", 0x0883, Layout("begin", []))
    DONE = Telemetry("DONE", 0x0884, Layout("done", []))

    def CLOCK_Main(cfe):
        cfe.os.count_sem_create("ITEMS", 0)
        cfe.os.count_sem_create("OPEN", 0)
        cfe.es.run_loop()
        cfe.os.task_delay(500)
        cfe.sb.transmit_msg(BEGIN.packet())
        cfe.os.task_delay(10000)

    def begins(cfe, name):
        pipe = cfe.sb.create_pipe(4, name)
        cfe.sb.subscribe(0x0883, pipe)
        cfe.es.run_loop()
        cfe.sb.receive_buffer(pipe)
        return [cfe.os.count_sem_get_id_by_name(each) for each in ("ITEMS", "OPEN")]

    def LIST_Main(cfe):
        items, _ = begins(cfe, "LIST")
        for _ in range(1 + cfe.os.count_sem_get_info(items).value):
            cfe.psp.compute(2)
        cfe.sb.transmit_msg(DONE.packet())
        cfe.os.task_delay(10000)

    def ONE_Main(cfe):
        items, is_open = begins(cfe, "ONE")
        cfe.os.count_sem_give(is_open)
        cfe.os.count_sem_take(is_open)
        cfe.os.count_sem_give(items)
        cfe.os.task_delay(10000)

    def TWO_Main(cfe):
        items, is_open = begins(cfe, "TWO")
        for _ in range(3 if cfe.os.count_sem_get_info(is_open).value else 1):
            cfe.os.count_sem_give(items)
        cfe.os.task_delay(10000)
"""
MEASURE = "latency:0x0883->0x0884"


@pytest.fixture
def plan(tmp_path: Path) -> RunPlan:
    """LIST has more to do the later it runs, and most of all if TWO has run while ONE was in the middle of its work."""
    return RunPlan((str(write_mission(tmp_path, STARTUP, apps=APPS)),), seconds=1.06, tasks="greenlet")


def explored(plan: RunPlan, **options: Any) -> Report:
    return Expedition(plan, worst=MEASURE, from_s=0.99, stuck=False, **options).run()


def worst(report: Report) -> Worst:
    assert report.worst is not None
    return report.worst


@pytest.mark.slow
def test_the_longest_of_all_schedules_is_found(plan: RunPlan) -> None:
    every = worst(explored(plan, policy="dfs", depth=1, seeds=100_000, shrink=0, jobs=1)).distribution
    found = worst(explored(plan, seeds=120, jobs=1))
    assert every.longest is not None
    assert found.distribution.longest is not None
    assert found.distribution.longest.longest[0] == every.longest.longest[0] == 10_000
    assert every.under_fifo == 6000
    assert found.distribution.number is not None
    assert found.distribution.quantiles()["min"] == 2000
    assert found.shrunk is not None
    assert len(found.shrunk.moves) <= 2
    assert any("LONGEST in LIST" in line for line in found.story.lines())


@pytest.mark.slow
def test_worst_case_does_not_depend_on_the_number_of_processes(plan: RunPlan) -> None:
    one, two = (explored(plan, seeds=70, shrink=0, jobs=jobs) for jobs in (1, 2))
    assert worst(one).distribution == worst(two).distribution
    shown = io.StringIO()
    show(one, shown)
    assert "worst latency:0x0883->0x0884: 10 us, under fifo 6 us\n  ends at 1.0500" in shown.getvalue()
    assert "70 schedules: shortest 2 us, median " in shown.getvalue()


@pytest.mark.parametrize(
    ("text", "time_ns"),
    [
        ("latency:0x0883", 0),  # no task computes before LIST does
        ("latency:0x0883->0x0884", 6000),
        ("response:LIST", 6000),
        ("wait:LIST", 0),
        ("age:0x0883", 10_000_000),  # until the end of the run
        ("age:0x0999", None),
        ("latency:0x0884->0x0883", None),
    ],
)
def test_measure_returns_the_longest_time(plan: RunPlan, text: str, time_ns: int | None) -> None:
    found = MeasuredTrial(plan, measure=Measure.parse(text)).run(Schedule()).longest
    assert (found[0] if found else None) == time_ns


@pytest.mark.parametrize("text", ["", "speed:/x", "latency:", "latency:/a->", "response:A->B", "latencies:/x"])
def test_invalid_measure_is_refused(text: str) -> None:
    with pytest.raises(UsageError):
        Measure.parse(text)


def test_generation_waits_for_earlier_verdicts_and_varies_the_longest() -> None:
    search = WorstSearch(SeededSearch((ScheduleKind(Schedule("random")),)))
    given = [search.next() for _ in range(FROM_SEEDS)]
    assert None not in given
    assert search.next() is None
    for number, schedule in enumerate(given):
        assert schedule is not None
        length = 9 if number == 3 else 1
        deviations = ((1, 1), (8, 1)) if number == 3 else ()
        verdict = Verdict(schedule, deviations=deviations, widths=(2, 2, 3) * 3, longest=(length, 0, 5))
        assert search.next() is None
        search.tell(number, verdict)
    first = search.next()
    assert first is not None
    assert first.text() == "at:1=1,4=1"  # later decisions are left out, and the last one before it changed

"""The lander of 1997: it works until the weather station is late by a millisecond. The mended form always works."""

from __future__ import annotations

import pytest

from cfepy.extra.exploration import Expedition
from cfepy.pilot import RunPlan
from cfepy.pilot.pilot import fly
from cfepy.pilot.results import Results
from cfepy.reading.resources import shipped
from cfepy.schedules import Schedule

LATE = Schedule.parse("random:2:hold=1ms")
MORE_DATA = str(shipped("missions") / "pathfinder" / "more_data.yaml")
INVERSION = (
    "BC_DIST (priority 40) waited 65.5 ms for semaphore SELECT held by ASI_MET (priority 120) while COMM (priority 80) "
    "ran for 65.5 ms"
)


def results_of(mission: str, schedule: Schedule | None = None, faults: str | None = None) -> Results:
    flown = fly(RunPlan((mission,), seconds=6, schedule=schedule or Schedule(), faults=faults))
    return flown.results


def test_original_mission_works_by_default() -> None:
    results = results_of("pathfinder")
    assert (results.problems, results.resets, results.inversions) == ([], [], [])


def test_delayed_task_resets_the_processor() -> None:
    results = results_of("pathfinder", LATE)
    assert "the watchdog was not served for 150 ms" in {reset.reason for reset in results.resets}
    assert [(each.victim, each.text) for each in results.inversions] == [("BC_DIST", INVERSION)]


def test_more_data_resets_the_processor_under_the_default_schedule() -> None:
    results = results_of("pathfinder", faults=MORE_DATA)
    assert [reset.at_s for reset in results.resets] == [5.31]
    assert results.inversions[0].holder == "ASI_MET"


def test_run_that_ends_during_a_reboot_reports_no_missing_library() -> None:
    results = fly(RunPlan(("pathfinder",), seconds=5.4, faults=MORE_DATA)).results
    assert [reset.at_s for reset in results.resets] == [5.31]
    assert results.script_problems == []


@pytest.mark.parametrize(("schedule", "faults"), [(LATE, None), (None, MORE_DATA)])
def test_mended_mission_survives_delay_and_more_data(schedule: Schedule | None, faults: str | None) -> None:
    results = results_of("pathfinder/mended.scr", schedule, faults)
    assert (results.problems, results.resets, results.inversions) == ([], [], [])


@pytest.mark.slow
def test_exploration_finds_the_reset_with_defaults_and_its_cause() -> None:
    report = Expedition(RunPlan(("pathfinder",)), seeds=15, jobs=1).run()
    (told,) = report.findings
    assert told.finding.failure.kind == "processor reset"
    assert told.inversions == [INVERSION]
    assert told.shrunk is not None
    assert len(told.shrunk.moves) == 1
    assert Expedition(RunPlan(("pathfinder/mended.scr",)), seeds=30, jobs=1).run().findings == []

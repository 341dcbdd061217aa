"""Races are found in one run, in any order of its tasks; ordered accesses are not races."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from cfepy.extra.exploration import Expedition, Trial
from cfepy.pilot import RunPlan, fly
from cfepy.schedules import Schedule
from tests.extra.exploration.race_programs import APP_PRELUDE, APPS_CLEAN, APPS_RACY, CLEAN, PRELUDE, RACY

SCRIPT = "CFE_APP, main.py, __main__, MAIN, 100, 16384, 0x0, 1;\n!\n"
QUICK_RACY, QUICK_CLEAN = ("two topics", "variable of a function"), ("queue", "condition")
Races = Callable[..., dict[str, str]]


@pytest.fixture
def races_of(tmp_path: Path) -> Races:
    """Fly a program under a schedule. Returns the raced variables, and the details."""
    (tmp_path / "startup.scr").write_text(SCRIPT, encoding="utf-8")

    def fly(source: str, schedule: str = "at", prelude: str = PRELUDE) -> dict[str, str]:
        (tmp_path / "main.py").write_text(prelude + source, encoding="utf-8")
        if prelude == APP_PRELUDE:
            (tmp_path / "startup.scr").write_text(SCRIPT.replace("__main__", "main"), encoding="utf-8")
        plan = RunPlan((str(tmp_path),), seconds=1.5, races=True)
        verdict = Trial(plan).run(Schedule.parse(schedule))
        others = [failure for failure in verdict.failures if failure.kind != "data race"]
        assert (others, verdict.trouble) == ([], "")
        return {failure.text.partition(": ")[0]: f"{failure.text}\n{failure.detail}" for failure in verdict.failures}

    return fly


def slow(names: list[str], quick: tuple[str, ...]) -> list[object]:
    return [pytest.param(each, marks=() if each in quick else pytest.mark.slow) for each in names]


@pytest.mark.parametrize("name", slow(list(RACY), QUICK_RACY))
def test_a_race_is_found(races_of: Races, name: str) -> None:
    what, source = RACY[name]
    assert list(races_of(source)) == [what]


@pytest.mark.parametrize("name", slow(list(CLEAN), QUICK_CLEAN))
def test_ordered_accesses_are_not_a_race(races_of: Races, name: str) -> None:
    assert races_of(CLEAN[name]) == {}


@pytest.mark.parametrize("name", slow(list(APPS_RACY), ("child",)))
def test_a_race_of_an_app_is_found(races_of: Races, name: str) -> None:
    assert list(races_of(APPS_RACY[name], prelude=APP_PRELUDE)) == ["Box.n"]


@pytest.mark.parametrize("name", slow(list(APPS_CLEAN), ("timer",)))
def test_ordered_accesses_of_an_app_are_not_a_race(races_of: Races, name: str) -> None:
    assert races_of(APPS_CLEAN[name], prelude=APP_PRELUDE) == {}


def test_race_names_both_accesses(races_of: Races) -> None:
    told = races_of("""
class Arm:
    def __init__(self): self.n = 0
    def add(self, by): self.n += by
arm = Arm()
def one(): arm.add(1)
def other(): arm.add(2)
both(one, other)
""")
    assert told["Arm.n"].splitlines() == [
        "Arm.n: read in Arm.add (main.py:22) of MAIN.MAIN.2.2, write in Arm.add (main.py:22) of MAIN.MAIN.1.1: nothing "
        "orders them",
        "write in Arm.add (main.py:22) of MAIN.MAIN.1.1 came first, then read in Arm.add (main.py:22) of MAIN.MAIN.2.2",
        "MAIN.MAIN.1.1: one (main.py:24) > Arm.add (main.py:22), at 0.550001 s",
        "MAIN.MAIN.2.2: other (main.py:25) > Arm.add (main.py:22), at 0.550002 s",
    ]


def test_race_detection_does_not_change_the_run(tmp_path: Path) -> None:
    (tmp_path / "startup.scr").write_text(SCRIPT, encoding="utf-8")
    (tmp_path / "main.py").write_text(PRELUDE + RACY["two topics"][1], encoding="utf-8")
    plans = [RunPlan((str(tmp_path),), seconds=1.5, races=races) for races in (False, True)]
    plain, watched = (fly(plan).trace for plan in plans)
    assert plain == watched


@pytest.mark.slow
def test_exploration_reports_a_race_once(tmp_path: Path) -> None:
    (tmp_path / "startup.scr").write_text(SCRIPT, encoding="utf-8")
    (tmp_path / "main.py").write_text(PRELUDE + RACY["two locks"][1], encoding="utf-8")
    plan = RunPlan((str(tmp_path),), seconds=1.0, races=True)
    report = Expedition(plan, seeds=6, policy="random", jobs=1, points="attributes").run()
    (told,) = report.findings
    assert told.finding.failure.cause == "Box.n"
    assert told.finding.in_reference
    assert "--races" in report.trial.command(report.schedule_of(told))

"""Missions of every kind are recorded, and replay to the same digest on both kinds of tasks."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from cfepy.journal import read_journal, record, replay
from cfepy.pilot.plan import LAUNCH, NODE, RunPlan
from cfepy.pilot.results import Results
from cfepy.reading.resources import shipped
from tests.journal.missions import SHIPPED, SMALL, paths
from tests.journal.replays import assert_replays, plan_for

SCHEDULES = ("fifo", "pct:2:3:300", "random:1:hold=200us", "at:5=1,9=1")


@pytest.mark.parametrize(
    "mission", [pytest.param(each, marks=[pytest.mark.slow] * (each == "capture")) for each in SHIPPED]
)
def test_shipped_missions_are_replayed(mission: str, tmp_path: Path) -> None:
    assert_replays(plan_for(mission, 0.8), tmp_path)


@pytest.mark.parametrize("mission", SMALL)
@pytest.mark.parametrize("schedule", ["fifo", "random:9"])
def test_small_missions_with_many_events_are_replayed(mission: str, schedule: str, tmp_path: Path) -> None:
    (tmp_path / "mission").mkdir()
    assert_replays(plan_for(SMALL[mission](tmp_path / "mission"), 4, schedule=schedule, seed=5), tmp_path)


@pytest.mark.parametrize("schedule", SCHEDULES)
def test_schedules_on_a_board_where_calls_take_time(schedule: str, tmp_path: Path) -> None:
    assert_replays(plan_for("capture", 0.65, schedule=schedule, board="rx64m"), tmp_path)


def test_script_is_replayed(tmp_path: Path) -> None:
    script = tmp_path / "noop.txt"
    script.write_text("at 1  send CFE_ES_NOOP\n      expect event CFE_ES 3 within 0.5\n", encoding="utf-8")
    outcome = assert_replays(plan_for("lab", script=str(script)), tmp_path).outcome
    assert outcome is not None
    assert outcome.ok


def test_failed_step_has_the_recorded_path_of_its_script(tmp_path: Path) -> None:
    script = tmp_path / "never.txt"
    script.write_text("at 1  expect event CFE_ES 99 within 0.5\n", encoding="utf-8")
    flown = assert_replays(plan_for("lab", script=str(script)), tmp_path)
    again = replay(read_journal(tmp_path / "run.cfepy")).flown
    assert again.outcome is not None
    assert again.outcome.file == str(script), "and not its place in the folder of the replay"
    assert again.results.problems == flown.results.problems
    assert again.results.problems[0].startswith(f"step {script}:1 failed: at 1")


@pytest.mark.slow
def test_faults_are_replayed(tmp_path: Path) -> None:
    faults = tmp_path / "faults.yaml"
    faults.write_text(
        "faults:\n  - {drop: /joint_states, probability: 0.2}\n  - {crash: MAIN_CTRL, at: 0.9}\n", encoding="utf-8"
    )
    flown = assert_replays(plan_for("capture", 1.2, faults=str(faults)), tmp_path)
    assert any(app.name == "MAIN_CTRL" and app.deaths for app in flown.results.apps)
    assert flown.results.problems == []  # a crash that a fault plan asks for is none


def test_seed_is_replayed(tmp_path: Path) -> None:
    mission = SMALL["race"](tmp_path)
    one, other = (record(plan_for(mission, 2, seed=seed), tmp_path / f"{seed}.cfepy") for seed in (1, 2))
    assert one.trace != other.trace
    assert [replay(read_journal(tmp_path / f"{seed}.cfepy")).flown.trace for seed in (1, 2)] == [one.trace, other.trace]


@pytest.mark.slow
def test_a_node_and_a_launch_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    paths(tmp_path)
    (tmp_path / "both.launch").write_text(
        '<launch><node pkg="p" type="race.py" name="one"/><param name="home" value="$(env SOMEWHERE)"/></launch>',
        encoding="utf-8",
    )
    (tmp_path / "package.xml").write_text("<package><name>p</name></package>", encoding="utf-8")
    race = tmp_path / "race.py"
    race.write_text(
        "#!/usr/bin/env python3\nimport os, rospy\nprint(rospy.get_param('/home'), os.environ['SOMEWHERE'])\n",
        encoding="utf-8",
    )
    race.chmod(0o755)
    monkeypatch.setenv("SOMEWHERE", "here")
    monkeypatch.chdir(tmp_path)
    for number, plan in enumerate((RunPlan(("paths.py", "x"), NODE), RunPlan(("both.launch",), LAUNCH, seconds=2))):
        record(plan, tmp_path.parent / f"{tmp_path.name}-{number}.cfepy")
    monkeypatch.setenv("SOMEWHERE", "elsewhere")
    monkeypatch.chdir("/")
    for number in range(2):
        again = replay(read_journal(tmp_path.parent / f"{tmp_path.name}-{number}.cfepy"))
        assert again.verdict.same, again.verdict
        assert any("here" in line or "as asked" in line for line in again.flown.mission.console.lines)


@pytest.mark.parametrize("change", ["edited", "gone"])
@pytest.mark.parametrize("mission", [*SMALL, pytest.param("capture", marks=pytest.mark.slow)])
def test_the_files_of_the_journal_are_enough(mission: str, change: str, tmp_path: Path) -> None:
    folder = tmp_path / "mission"
    if mission == "capture":
        shutil.copytree(shipped("missions") / "capture", folder)
    else:
        folder.mkdir()
        SMALL[mission](folder)
    flown = record(plan_for(str(folder), 1, schedule="random:2"), tmp_path / "run.cfepy")
    if change == "gone":
        shutil.rmtree(folder)
    else:
        (folder / "out.txt").unlink(missing_ok=True)
        for path in folder.glob("*.py"):
            path.write_text("raise SystemExit('another file')\n", encoding="utf-8")
    again = replay(read_journal(tmp_path / "run.cfepy"))
    assert again.verdict.same, again.verdict
    assert again.flown.trace == flown.trace
    assert results_of(again.flown.results) == results_of(flown.results)


def results_of(results: Results) -> list[object]:
    """Return the user's view of results, except for paths."""
    return [results.topics, results.apps, results.events, results.resets, results.problems]

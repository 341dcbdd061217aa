"""The dependencies of a campaign are found, sent to other computers, and named in the report when they change."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from cfepy.extra.exploration.mission_transfer import LIMIT, files_read, identity_of, ship
from cfepy.extra.exploration.results_file import ResultsFile
from cfepy.extra.exploration.verdict import Failure, Verdict
from cfepy.pilot.pilot import fly
from cfepy.pilot.plan import LAUNCH, NODE, RunPlan
from cfepy.reading.resources import shipped
from cfepy.schedules import Schedule
from cfepy.status import UsageError

NODE_SOURCE = """
import os
import rospy
rospy.init_node("greeter")
rospy.loginfo(open(os.path.join(os.path.dirname(__file__), "greeting.txt")).read())
rospy.signal_shutdown("said")
"""
LAUNCH_FILE = '<launch><node pkg="greetings" type="greeter.py" name="greeter"/></launch>'


@pytest.fixture
def mission(tmp_path: Path) -> Path:
    folder = tmp_path / "mission"
    shutil.copytree(shipped("missions") / "capture", folder)
    return folder


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A ROS package with a node that reads a file, and a launch file."""
    folder = tmp_path / "src" / "greetings"
    for name, text in {
        "package.xml": "<package><name>greetings</name></package>",
        "scripts/greeter.py": NODE_SOURCE,
        "scripts/greeting.txt": "hello",
        "launch/greet.launch": LAUNCH_FILE,
    }.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    (folder / "scripts/greeter.py").chmod(0o755)
    return folder


def test_changed_file_is_named(mission: Path, tmp_path: Path) -> None:
    plan = RunPlan((str(mission),), seconds=0.1)
    before = identity_of(plan, files_read(plan), {"policy": "random"})
    ResultsFile(tmp_path / "results", before).close()
    with (mission / "arm_control.py").open("a") as source:
        source.write("# changed\n")
    after = identity_of(plan, files_read(plan), {"policy": "random"})
    with pytest.raises(
        UsageError, match=rf"another campaign \(files\.{mission}/arm_control\.py was \"\w+\", is \"\w+\"\)"
    ):
        ResultsFile(tmp_path / "results", after)


def test_shipped_mission_gives_the_same_trace(mission: Path, tmp_path: Path) -> None:
    plan = RunPlan((str(mission),), seconds=0.1, script=str(mission / "checks.txt"))
    here = fly(plan).trace
    shipment = ship(plan, files_read(plan))
    shutil.rmtree(mission)
    inside = shipment.unpack(tmp_path / "elsewhere")
    there = shipment.plan_in(inside)
    assert there.words == (f"{tmp_path}/elsewhere{mission}/startup.scr",)
    assert there.script == f"{tmp_path}/elsewhere{mission}/checks.txt"
    assert fly(there).trace == here


@pytest.mark.parametrize("command", [NODE, LAUNCH])
def test_shipped_nodes_of_a_package_give_the_same_trace(
    package: Path, tmp_path: Path, command: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(package.parent))
    monkeypatch.chdir(tmp_path)
    words = ("greetings", "greeter.py") if command == NODE else ("greetings", "greet.launch")
    plan = RunPlan(words, command, seconds=0.7)
    files = files_read(plan)
    assert str(package / "scripts/greeting.txt") in files
    here = fly(plan).trace
    shipment = ship(plan, files)
    shutil.rmtree(package)
    inside = shipment.unpack(tmp_path / "elsewhere")
    for name, value in shipment.environ_in(inside).items():
        monkeypatch.setenv(name, value)
    flown = fly(shipment.plan_in(inside))
    assert flown.mission.ros.ended["GREETER"].status == 0
    assert flown.trace == here


def test_verdict_has_the_local_paths_of_files(mission: Path, tmp_path: Path) -> None:
    plan = RunPlan((str(mission),), seconds=0.01)
    inside = ship(plan, files_read(plan)).unpack(tmp_path / "elsewhere")
    text = f"File {tmp_path}/elsewhere{mission}/arm_control.py, line 3"
    told = inside.told(Verdict(Schedule(), (Failure("died", "ARM", "x", detail=text),), trouble=text))
    assert told.failures[0].detail == told.trouble == f"File {mission}/arm_control.py, line 3"


def test_too_large_mission_for_a_cluster_is_refused(mission: Path) -> None:
    plan = RunPlan((str(mission),), seconds=0.01)
    with (mission / "big.bag").open("wb") as bag:
        bag.truncate(LIMIT + (1 << 20))
    with pytest.raises(UsageError, match="--cluster: must have at most 256 MiB of files, not 257 MiB; remove"):
        ship(plan, files_read(plan))

"""Missions without a startup script: a launch file with a mission file beside it, and a mission file with `launch:`."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.mission import read_mission
from cfepy.pilot import RunPlan, check_mission, fly
from cfepy.status import UsageError

TALKER = """
import rospy
from std_msgs.msg import Int32
rospy.init_node("talker")
publisher = rospy.Publisher("count", Int32, queue_size=1)
rate = rospy.Rate(10)
for count in range(1000):
    publisher.publish(count)
    rate.sleep()
"""
RULES = "invariants: {few: {topic: /count, holds: msg.data < 3}}\nresults: {/count: last}\n"


@pytest.fixture
def launch(tmp_path: Path) -> Path:
    """Return a launch file with one node."""
    package = tmp_path / "robot"
    package.mkdir()
    (package / "package.xml").write_text("<package><name>robot</name></package>", encoding="utf-8")
    (package / "talker.py").write_text(TALKER, encoding="utf-8")
    (package / "talker.py").chmod(0o755)
    file = package / "robot.launch"
    file.write_text('<launch><node pkg="robot" type="talker.py" name="talker"/></launch>', encoding="utf-8")
    return file


def beside(launch: Path, text: str) -> None:
    (launch.parent / "mission.yaml").write_text(text, encoding="utf-8")


def test_launch_file_has_the_rules_of_the_mission_file_beside_it(launch: Path) -> None:
    alone = fly(RunPlan((str(launch),), seconds=2))
    assert alone.results.problems == []
    beside(launch, f"name: rover\nboard: workstation\nparams: {{/limit: 3}}\n{RULES}")
    ruled = fly(RunPlan((str(launch),), seconds=2))
    assert (ruled.mission.spec.name, ruled.mission.spec.board) == ("rover", "workstation")
    assert "invariant 'few'" in ruled.results.problems[0]
    as_launch = fly(RunPlan((str(launch),), "launch", seconds=2))
    assert as_launch.results.trace == ruled.results.trace


def test_startup_script_has_the_mission_file_beside_it(launch: Path) -> None:
    beside(launch, RULES)
    (launch.parent / "startup.scr").write_text("!\n", encoding="utf-8")
    assert fly(RunPlan((str(launch),), seconds=2)).results.problems == []


def test_sections_that_the_launch_file_sets_are_refused(launch: Path) -> None:
    beside(launch, "board: linux\nnodes: {TALKER: {namespace: /x}}\nlaunch: [robot.launch]\n")
    with pytest.raises(UsageError) as caught:
        read_mission(str(launch))
    assert [(each.line, each.field) for each in caught.value.each] == [(2, "nodes"), (3, "launch")]
    assert "beside a launch file that is run itself" in caught.value.text
    assert [each.line for each in check_mission(str(launch))] == [2, 3]


def test_check_reads_the_mission_file_beside_a_launch_file(launch: Path) -> None:
    beside(launch, "bord: linux\ninvariants: {few: {topic: /count, holds: msg.data <}}\n")
    assert [each.text.partition(":")[0] for each in check_mission(str(launch))] == ["bord", "invariants.few.holds"]


@pytest.mark.parametrize("named", ["folder", "file"])
def test_mission_file_with_launch_files_is_a_mission(launch: Path, tmp_path: Path, named: str) -> None:
    folder = tmp_path / "mission"
    folder.mkdir()
    (folder / "mission.yaml").write_text(f"launch: [../robot/robot.launch]\n{RULES}", encoding="utf-8")
    words = str(folder if named == "folder" else folder / "mission.yaml")
    flown = fly(RunPlan((words,), seconds=2))
    assert flown.mission.spec.name == "mission"
    assert [each.name for each in flown.results.apps if each.name == "TALKER"] == ["TALKER"]
    assert "invariant 'few'" in flown.results.problems[0]
    assert check_mission(words) == []


def test_mission_file_without_launch_files_is_no_mission(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "mission.yaml").write_text("board: linux\n", encoding="utf-8")
    assert main(["run", str(tmp_path)]) == 2
    assert "mission.yaml: missing `launch:`, because there is no startup.scr beside it" in capsys.readouterr().err


def test_run_of_a_mission_file_replays(launch: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder, journal = tmp_path / "mission", str(tmp_path / "run.cfepy")
    folder.mkdir()
    (folder / "mission.yaml").write_text("launch: [../robot/robot.launch]\n", encoding="utf-8")
    assert main(["run", str(folder), "--for", "1.5", "--quiet", "--record", journal]) == 0
    (folder / "mission.yaml").unlink()
    (launch.parent / "talker.py").unlink()
    assert main(["replay", journal, "--quiet"]) == 0
    beside(launch, RULES)

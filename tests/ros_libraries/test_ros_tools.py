"""rosgraph, rosnode, rostopic, rosservice, rosparam and the master's proxy: the same output about two nodes as on
ROS."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.rospy_shim.missions import run_nodes

DATA = Path(__file__).parents[1] / "data"


@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_answers_equal_recorded_answers_of_ros(tmp_path: Path, tasks: str) -> None:
    if tasks == "greenlet":
        pytest.importorskip("greenlet")
    pytest.importorskip("yaml")
    scripts = {"TALKER": DATA / "ros_tools_talker.py", "ASKER": DATA / "ros_tools_questions.py"}
    run = run_nodes(tmp_path, scripts, seconds=6, tasks=tasks)
    assert run.printed["asker"] == (DATA / "ros_tools_answers.txt").read_text(encoding="utf-8").splitlines()
    assert run.printed["talker"] == ["shutdown request: user request"]

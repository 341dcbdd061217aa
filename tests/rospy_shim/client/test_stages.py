"""A node that queries rospy at each stage of its life has the same output as on a ROS 1 master (rospy 1.15.15)."""

from __future__ import annotations

from pathlib import Path

import pytest

from rospy_shim.types.config import NodeConfig
from tests.rospy_shim.missions import run_nodes

DATA = Path(__file__).parents[2] / "data"


@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_answers_equal_the_record_of_ros(tmp_path: Path, tasks: str) -> None:
    config = NodeConfig("PROBE", args=("_own:=7", "old:=new"))
    run = run_nodes(tmp_path, {"PROBE": DATA / "rospy_stages.py"}, seconds=60, nodes={"PROBE": config}, tasks=tasks)
    answers = [*run.printed["PROBE"], *run.printed["stages"]]
    answers = [line for line in answers if not line.startswith("[FATAL]")]  # which the record did not keep
    assert answers == (DATA / "rospy_stages.txt").read_text(encoding="utf-8").splitlines()

"""The nodes of tests/ros_nodes have the same output here as on a real ROS 1 master."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from rospy_shim.types.config import NodeConfig
from tests.rospy_shim.missions import run_nodes

NODES = Path(__file__).parents[2] / "ros_nodes"
SCENARIOS = json.loads((NODES.parent / "data" / "nodes_on_ros.json").read_text(encoding="utf-8"))["scenarios"]


@pytest.mark.parametrize("scenario", SCENARIOS, ids=lambda scenario: scenario["name"].replace(" ", "-"))
def test_results_equal_the_record_of_ros(scenario: dict[str, Any], tmp_path: Path) -> None:
    apps = {f"NODE_{number}": node for number, node in enumerate(scenario["nodes"])}
    run = run_nodes(
        tmp_path,
        {app: NODES / node["script"] for app, node in apps.items()},
        nodes={app: NodeConfig(app, args=tuple(node["args"])) for app, node in apps.items()},
        seconds=8.0,
    )
    printed = sorted(line for lines in run.printed.values() for line in lines if line.startswith("result: "))
    assert printed == sorted(line for node in scenario["nodes"] for line in node["results"]), "\n".join(run.lines)
    assert run.finished

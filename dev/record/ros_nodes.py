"""Runs the node scenarios on a real ROS 1 master and writes down their output.

Needs a running roscore and rospy in this interpreter: `python3 -m dev.record.ros_nodes`. Scenarios and results are
together in tests/data/nodes_on_ros.json; a test compares cfepy's output of the same scenarios with them.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

NODES = Path(__file__).parents[2] / "tests/ros_nodes"
RECORD = NODES.parent / "data" / "nodes_on_ros.json"
TIMEOUT = 30  # s per scenario


def run(scenario: dict[str, Any]) -> None:
    """Start the scenario's nodes together and fill in the result lines of each."""
    started = [
        subprocess.Popen(
            [sys.executable, str(NODES / node["script"]), *node["args"]],
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )
        for node in scenario["nodes"]
    ]
    for node, process in zip(scenario["nodes"], started):
        output, _ = process.communicate(timeout=TIMEOUT)
        node["results"] = [line for line in output.splitlines() if line.startswith("result: ")]
        node["exit_status"] = process.returncode


def main() -> None:
    """Run all scenarios and write down their nodes' output."""
    argparse.ArgumentParser(prog="python -m dev.record.ros_nodes", description=__doc__).parse_args()
    record = json.loads(RECORD.read_text(encoding="utf-8"))
    for scenario in record["scenarios"]:
        run(scenario)
        for node in scenario["nodes"]:
            print(scenario["name"], node["script"], node["exit_status"], *node["results"], sep="\n    ")
    RECORD.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()

"""A 1 kHz stream each way between a node on real rospy and one of a mission at the same time: nothing is lost.

The counts do not depend on the speed of the computer; a busy one only takes longer. `streams.py` explains why its
queues hold 1,000 messages.
"""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import pytest

from tests.extra.ros_host.graphs import HAS_ROS, PYTHON, RosGraph, cfepy_run, rosmaster, started, wait_for_line

NODE = Path(__file__).with_name("streams.py")
MESSAGES = 10_000  # in 10 s, where there is time
PATIENCE_S = 300  # wall time limit of the stream
HAS_JOINTS = not subprocess.run([PYTHON, "-c", "import sensor_msgs.msg"], capture_output=True, check=False).returncode

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not (HAS_ROS and HAS_JOINTS), reason="Debian's ROS 1 or python3-sensor-msgs is not installed"),
]


@pytest.mark.parametrize("way", ["serve", "join"])
def test_ten_thousand_messages_in_each_direction_arrive(way: str, tmp_path: Path) -> None:
    if way == "join":
        with rosmaster(tmp_path) as graph:
            stream(tmp_path, graph.environ["ROS_MASTER_URI"])
    else:
        stream(tmp_path, "serve:0")


def stream(folder: Path, master: str) -> None:
    shutil.copy(NODE, folder)
    (folder / "mission.yaml").write_text(
        f"name: streams\nnodes: {{STREAMS: {{args: [mission, peer, {MESSAGES}]}}}}\n", encoding="utf-8"
    )
    (folder / "startup.scr").write_text(
        "CFE_APP, streams.py, __main__, STREAMS, 100, 16384, 0x0, 0;\n!\n", encoding="utf-8"
    )
    report = folder / "report.json"
    with started(cfepy_run(folder, "--ros-master", master, "--json", str(report))) as mission:
        told = wait_for_line(mission, "ROS_MASTER_URI=" if master == "serve:0" else "joined the ROS master")
        graph = RosGraph(told.rpartition("=")[2] if master == "serve:0" else master, folder)
        with started([PYTHON, str(NODE), "peer", "mission", str(MESSAGES)], graph.environ) as peer:
            for process, name in ((mission, "mission"), (peer, "peer")):
                told = wait_for_line(process, f"{name} heard ", PATIENCE_S)
                assert told.endswith(f"heard {MESSAGES} in order"), told
    rows = {
        row["name"]: row
        for row in json.loads(report.read_text(encoding="utf-8"))["ros_peers"]
        if row["peer"] == "/peer"
    }
    for topic, way in (("/of_mission", "out"), ("/of_peer", "in")):
        row = rows[topic]
        assert (row["direction"], row["dropped"], row["connections"], row["refused"]) == (way, 0, 1, 0), row
        assert row["messages"] > MESSAGES  # with the marks of the end

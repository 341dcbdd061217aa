"""Debian's ROS 1 beside a mission: its tools report the same about the mission's nodes as about the nodes on real
rospy.

One node's source runs twice: with real rospy on Debian's rosmaster, and in a mission that serves a master or joins one.
Each command is run on both graphs. The outputs are compared except for numbers that belong to a process.
"""

from __future__ import annotations

import re

import pytest

from tests.extra.ros_host.graphs import HAS_ROS, PYTHON, RosGraph

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not HAS_ROS, reason="Debian's ROS 1 is not installed (python3-rostopic and others)"),
]

COMMANDS = (
    "rostopic list",
    "rostopic list -v",
    "rostopic type /chatter",
    "rostopic info /chatter",
    "rostopic info /orders",
    "rostopic find std_msgs/Int32",
    "rostopic echo -n 2 /chatter",
    "rostopic echo -n 1 /latched",
    "rosnode list",
    "rosnode info /talker",
    "rosnode ping -c 1 /talker",
    "rosservice list",
    "rosservice type /things",
    "rosservice node /things",
    "rosservice args /things",
    "rosservice call /things",
    "rosparam get /talker/speed",
)
PICTURE = """
import rosgraph.impl.graph
graph = rosgraph.impl.graph.Graph()
graph.set_master_stale(60.0)
graph.set_node_stale(60.0)
graph.update()
print(sorted(graph.nn_nodes), sorted(graph.nt_nodes), dict(graph.bad_nodes))
print(sorted(map(str, graph.nt_all_edges)))
"""
"""What rqt_graph asks of the master and of each node; Debian has rosgraph, which it asks with, and not rqt_graph."""
PARAMETER = ("rosparam set /outside 5", "rosparam get /outside", "rosparam delete /outside", "rosparam get /outside")


def masked(output: str) -> str:
    """Return an output without data of one process: addresses, numbers, times, the name of the tool's own node."""
    output = re.sub(r"http://[\w.\-]+:\d+/?", "URI", output)
    output = re.sub(r"_\d+_\d{10,}", "_N", output)
    output = re.sub(r"time=[\d.]+ms|average: [\d.]+ms", "TIME", output)
    output = re.sub(r"Pid: \d+", "Pid: N", output)
    return re.sub(r"\* direction: (\w+) \([^)]*\)[^\n]*", r"* direction: \1", output)


@pytest.mark.parametrize("command", COMMANDS)
def test_tool_prints_the_same_for_mission_and_ros(real: RosGraph, mission: RosGraph, command: str) -> None:
    assert masked(mission.run(command)) == masked(real.run(command))


def test_parameter_is_set_read_and_deleted_as_on_ros(real: RosGraph, mission: RosGraph) -> None:
    """One after the other, in one test: others may run in another process, against another graph."""
    for command in PARAMETER:
        assert masked(mission.run(command)) == masked(real.run(command)), command


def test_rqt_graph_draws_the_same_picture(real: RosGraph, mission: RosGraph) -> None:
    (real.folder / "picture.py").write_text(PICTURE, encoding="utf-8")
    command = f"{PYTHON} {real.folder / 'picture.py'}"
    mission.wait_for("rosnode ping -c 1 /talker", "xmlrpc reply")
    assert "/talker" in real.run(command)
    assert seen(mission.run(command)) == seen(real.run(command))


def seen(picture: str) -> list[str]:
    """Return the content of a picture, without rosgraph's lines about connections of tools that have just ended."""
    return [line for line in picture.splitlines() if not line.startswith("cannot add edge")]

"""Debian's ROS 1 beside a mission: its tools measure, publish, record and play with the same results as on real rospy.

They use separate graphs, because the effects of a tool can stay visible for a while in other tools' output.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TypeVar

import pytest

from cfepy.journal import read_journal, replay
from tests.extra.ros_host.graphs import (
    HAS_ROS,
    LIMIT_S,
    PYTHON,
    RosGraph,
    cfepy_run,
    mission_of,
    started,
    wait_for_line,
)

T = TypeVar("T")

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not HAS_ROS, reason="Debian's ROS 1 is not installed (python3-rostopic and others)"),
]

DUMP = """
import rosbag, sys
with rosbag.Bag(sys.argv[1]) as bag:
    for connection in bag._get_connections():
        print(connection.topic, connection.datatype, connection.md5sum, repr(connection.msg_def))
        print(sorted(connection.header.items()))
    for topic, (kind, data, md5sum, _, message_class), _ in bag.read_messages(raw=True):
        print(topic, kind, data.hex(), md5sum, repr(message_class._full_text))
"""
WINDOW, RATE_HZ = 20, 10  # messages of a window of rostopic; the talker's rate
ROUNDED_S = 0.001  # precision of rostopic's rounding


def test_hz_tool_measures_the_rate_as_with_rospy(real: RosGraph, mission: RosGraph) -> None:
    told = of_both(real, mission, lambda graph: measured(graph, "hz"))
    assert shapes(told[0]) == shapes(told[1])
    for lines in told:
        rate = float(lines[-2].removeprefix("average rate: "))
        least, most = (float(each) for each in re.findall(r"(?:min|max): ([\d.]+)s", lines[-1]))
        assert least - ROUNDED_S <= 1 / rate <= most + ROUNDED_S, lines
        assert RATE_HZ / 2 < rate < RATE_HZ * 2, lines  # else the computer stood still for as long as the window lasts


def test_bw_tool_measures_the_bandwidth_as_with_rospy(real: RosGraph, mission: RosGraph) -> None:
    told = of_both(real, mission, lambda graph: measured(graph, "bw"))
    assert shapes(told[0]) == shapes(told[1])
    assert told[0][-1] == told[1][-1] == f"mean: 9.00B min: 9.00B max: 9.00B window: {WINDOW}"


def of_both(real: RosGraph, mission: RosGraph, ask: Callable[[RosGraph], T]) -> list[T]:
    """Return the results of the same query on both graphs, at once."""
    with ThreadPoolExecutor(2) as threads:
        return list(threads.map(ask, (real, mission)))


def measured(graph: RosGraph, tool: str) -> list[str]:
    """Return rostopic's output until its window is full."""
    lines: list[str] = []
    with started(["rostopic", tool, "-w", str(WINDOW), "/chatter"], unbuffered(graph)) as process:
        assert process.stdout is not None
        for line in process.stdout:
            lines.append(line.strip())
            if line.endswith(f"window: {WINDOW}\n"):
                return lines
    raise AssertionError(lines)


def shapes(lines: list[str]) -> set[str]:
    """Return the kinds of lines, with N for numbers. On a busy computer, a tool may look before the first message."""
    return {re.sub(r"[\d.]+", "N", line) for line in lines} - {"no new messages"}


def test_message_of_pub_tool_reaches_the_node_as_with_rospy(real: RosGraph, mission: RosGraph) -> None:
    """The node latches the length of the received message."""

    def publish(graph: RosGraph) -> set[str]:
        said = latched(graph, "data:_twelve_bytes", "data: 18")
        put_back(graph)
        return said

    told = of_both(real, mission, publish)
    assert told[0] == told[1]


def test_message_of_another_type_is_refused_as_with_rospy(real: RosGraph, mission: RosGraph) -> None:
    def publish(graph: RosGraph) -> set[str]:
        with started(["rostopic", "pub", "/orders", "std_msgs/Int32", "5"], unbuffered(graph)) as process:
            said = lines_of(wait_for_line(process, "topic types do not match"))
        put_back(graph)
        return said

    told = of_both(real, mission, publish)
    assert told[0] == told[1]


def latched(graph: RosGraph, text: str, length: str) -> set[str]:
    """Publish until the node has latched the length. Returns the tool's output."""
    with started(["rostopic", "pub", "/orders", "std_msgs/String", text], unbuffered(graph)) as process:
        graph.wait_for("rostopic echo -n 1 /latched", length)
        process.terminate()
        return lines_of(process.communicate(timeout=LIMIT_S)[0])


def put_back(graph: RosGraph) -> None:
    """Restore the node's latched value and the topic's type in the master, which is the last publisher's.

    Other tests also use the graph of real ROS.
    """
    latched(graph, "seven77", "data: 7")


def unbuffered(graph: RosGraph) -> dict[str, str]:
    return {**graph.environ, "PYTHONUNBUFFERED": "1"}


def lines_of(output: str) -> set[str]:
    """Return lines without colours, times, and options of a connection that both sides choose for themselves."""
    output = re.sub(r"\x1b\[\d*m", "", output)
    output = re.sub(r"\[\d+\.\d+\]", "[T]", output)
    return {re.sub(r"(, )?'tcp_nodelay': '\d'", "", line) for line in output.splitlines()}


@pytest.mark.parametrize(("topic", "count"), [("/chatter", 5), ("/latched", 1)])
def test_recorded_bags_are_equal(real: RosGraph, mission: RosGraph, topic: str, count: int) -> None:
    """The recording's output, topics, types, definitions, connections and messages are equal on both graphs."""

    def record(graph: RosGraph) -> tuple[set[str], list[str]]:
        recorded = lines_of(graph.run(f"rosbag record -l {count} -O recorded.bag {topic}"))
        return recorded, contents(graph, "recorded.bag")

    told = of_both(real, mission, record)
    assert told[0] == told[1]
    assert f"messages:    {count}" in told[0][1]


def test_played_bag_reaches_the_node_as_with_rospy(real: RosGraph, mission: RosGraph) -> None:
    """Play repeatedly until the data was recorded and has reached the node, so no program need be ready in time."""
    real.run("rosbag record -l 5 -O chatter.bag /chatter")
    bag = real.folder / "chatter.bag"

    def play(graph: RosGraph) -> list[str]:
        words = ["rosbag", "play", "--quiet", "--loop", str(bag), "/chatter:=/orders"]
        with started(words, graph.environ) as played:
            graph.run("rosbag record -l 5 -O played.bag /orders")
            graph.wait_for("rostopic echo -n 1 /latched", "data: 5")
            graph.run("rosnode kill $(rosnode list | grep /play_)")  # so that it leaves the master
            played.wait(LIMIT_S)
        put_back(graph)
        return contents(graph, "played.bag")

    told = of_both(real, mission, play)
    assert told[0] == told[1]
    assert "messages:    5" in told[0]


def contents(graph: RosGraph, bag: str) -> list[str]:
    """Return a bag's content, except for its times and the number in the name of rosbag's node."""
    (graph.folder / "dump.py").write_text(DUMP, encoding="utf-8")
    told = graph.run(f"rosbag info {bag}; {PYTHON} dump.py {bag}")
    lines = re.sub(r"/play_\d+", "/play_N", told).splitlines()
    return [line for line in lines if not line.startswith(("duration:", "start:", "end:"))]


def test_run_with_ros_is_replayed_without_ros(tmp_path: Path) -> None:
    journal = tmp_path / "run.cfepy"
    words = cfepy_run(mission_of(tmp_path), "--ros-master", "serve:0", "--record", str(journal))
    with started(words) as process:
        assert process.stdout is not None
        line = next(each for each in process.stdout if "ROS_MASTER_URI=" in each)
        graph = RosGraph(line.strip().rpartition("=")[2], tmp_path)
        graph.wait_for("rosservice list", "/things")
        graph.run("rostopic pub -1 /orders std_msgs/String data:_twelve_bytes")
        graph.run("rosparam set /outside 5")
        graph.run("rosservice call /things")
        process.terminate()
        process.wait(LIMIT_S)
    again = replay(read_journal(journal))
    assert again.verdict.same, again.verdict

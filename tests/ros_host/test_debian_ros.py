"""Debian's ROS 1 beside a mission: its tools say of the mission's nodes what they say of the same nodes on real rospy.

One node's source runs twice: with real rospy on Debian's rosmaster, and in a mission that serves a master or joins one.
Each command is run on both graphs, and its output compared, numbers aside that belong to a process.
"""

from __future__ import annotations

import os
import re
import shutil
import socket
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import TypeVar

import pytest

from cfepy.journal import read_journal, replay

T = TypeVar("T")
TALKER = Path(__file__).parent / "talker.py"
PYTHON = "/usr/bin/python3"
TOOLS = ("rostopic", "rosnode", "rosservice", "rosparam", "rosmaster")
LIMIT_S = 60  # wall time after which a tool that hangs is given up
MODULES = "import rospy, rosmaster, rostopic, rosbag, roscpp.srv"
HAS_ROS = (
    all(shutil.which(each) for each in TOOLS)
    and not subprocess.run([PYTHON, "-c", MODULES], capture_output=True, check=False).returncode
)

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
DUMP = """
import rosbag, sys
with rosbag.Bag(sys.argv[1]) as bag:
    for connection in bag._get_connections():
        print(connection.topic, connection.datatype, connection.md5sum, repr(connection.msg_def))
        print(sorted(connection.header.items()))
    for topic, (kind, data, md5sum, _, message_class), _ in bag.read_messages(raw=True):
        print(topic, kind, data.hex(), md5sum, repr(message_class._full_text))
"""
WINDOW, RATE_HZ = 20, 10  # messages of a window of rostopic; what the talker's rate is
ROUNDED_S = 0.001  # to which rostopic rounds
PARAMETER = ("rosparam set /outside 5", "rosparam get /outside", "rosparam delete /outside", "rosparam get /outside")


class RosGraph:
    """A ROS graph that tools can be pointed at.

    Args:
        uri: of its master.
        folder: for what tools write.
    """

    def __init__(self, uri: str, folder: Path) -> None:
        self.environ = {**os.environ, "ROS_MASTER_URI": uri, "ROS_LOG_DIR": str(folder), "ROS_IP": "127.0.0.1"}
        self.folder = folder

    def run(self, command: str) -> str:
        """The output of a command."""
        done = subprocess.run(
            ["sh", "-c", command],
            env=self.environ,
            cwd=self.folder,
            capture_output=True,
            text=True,
            timeout=LIMIT_S,
            check=False,
        )
        return done.stdout + done.stderr

    def wait_for(self, command: str, text: str) -> None:
        """Until the output of a command has a text; a node's start is waited for like this."""
        for _ in range(LIMIT_S // 2):
            if text in self.run(command):
                return
        raise AssertionError(f"{command} never said {text!r}")


def masked(output: str) -> str:
    """An output without what belongs to one process: addresses, numbers, times, the name of the tool's own node."""
    output = re.sub(r"http://[\w.\-]+:\d+/?", "URI", output)
    output = re.sub(r"_\d+_\d{10,}", "_N", output)
    output = re.sub(r"time=[\d.]+ms|average: [\d.]+ms", "TIME", output)
    output = re.sub(r"Pid: \d+", "Pid: N", output)
    return re.sub(r"\* direction: (\w+) \([^)]*\)[^\n]*", r"* direction: \1", output)


@contextmanager
def started(words: list[str], environ: dict[str, str] | None = None) -> Iterator[subprocess.Popen[str]]:
    process = subprocess.Popen(words, env=environ, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    try:
        yield process
    finally:
        process.terminate()
        process.communicate(timeout=LIMIT_S)


def wait_for_line(process: subprocess.Popen[str], text: str, limit_s: float = LIMIT_S) -> str:
    """Read what a process prints until a line has a text; a process that never prints it is killed after a while."""
    assert process.stdout is not None
    end = threading.Timer(limit_s, process.kill)
    end.start()
    try:
        found = next((line.strip() for line in process.stdout if text in line), None)
    finally:
        end.cancel()
    assert found is not None, f"{process.args!r} ended without {text!r}"
    return found


def free_graph(folder: Path) -> RosGraph:
    """A graph at a free port, which has no master yet."""
    with socket.create_server(("127.0.0.1", 0)) as probe:
        port = probe.getsockname()[1]
    return RosGraph(f"http://127.0.0.1:{port}", folder)


@contextmanager
def master_of(graph: RosGraph) -> Iterator[subprocess.Popen[str]]:
    """Debian's master of a graph, while it starts."""
    port = graph.environ["ROS_MASTER_URI"].rpartition(":")[2]
    with started(["rosmaster", "--core", "-p", port], graph.environ) as process:
        yield process


@contextmanager
def rosmaster(folder: Path) -> Iterator[RosGraph]:
    """A graph with Debian's master."""
    graph = free_graph(folder)
    with master_of(graph):
        graph.wait_for("rosparam set /state up; rosparam get /state", "up")
        yield graph


def mission_of(folder: Path) -> Path:
    """A mission of the talker."""
    mission = folder / "mission"
    mission.mkdir()
    shutil.copy(TALKER, mission / "talker.py")
    (mission / "startup.scr").write_text("CFE_APP, talker.py, __main__, TALKER, 100, 16384, 0x0, 0;\n!\n")
    return mission


def cfepy_run(mission: Path, *options: str) -> list[str]:
    return [sys.executable, "-m", "cfepy", "run", str(mission), "--realtime", *options]


def joining(folder: Path, graph: RosGraph) -> list[str]:
    return cfepy_run(mission_of(folder), "--ros-master", graph.environ["ROS_MASTER_URI"])


@pytest.fixture(scope="module")
def real(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """Nothing but ROS."""
    with rosmaster(tmp_path_factory.mktemp("real")) as graph, started([PYTHON, str(TALKER)], graph.environ):
        graph.wait_for("rostopic list", "/orders")
        graph.wait_for("rosservice list", "/things")
        yield graph


@pytest.fixture(scope="module", params=["serve", "join"])
def mission(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """A mission and its master, or a mission that has joined Debian's."""
    folder = tmp_path_factory.mktemp("mission")
    if request.param == "join":
        with rosmaster(folder) as graph, started(joining(folder, graph)):
            graph.wait_for("rosservice list", "/things")
            yield graph
        return
    with started(cfepy_run(mission_of(folder), "--ros-master", "serve:0")) as process:
        assert process.stdout is not None
        line = next(each for each in process.stdout if "ROS_MASTER_URI=" in each)
        graph = RosGraph(line.strip().rpartition("=")[2], folder)
        graph.wait_for("rosservice list", "/things")
        yield graph


@pytest.mark.parametrize("command", COMMANDS)
def test_a_tool_says_the_same_of_both(real: RosGraph, mission: RosGraph, command: str) -> None:
    assert masked(mission.run(command)) == masked(real.run(command))


def test_a_parameter_is_set_asked_for_and_deleted(real: RosGraph, mission: RosGraph) -> None:
    """One after the other, in one test: others may run in another process, against another graph."""
    for command in PARAMETER:
        assert masked(mission.run(command)) == masked(real.run(command)), command


def test_rqt_graph_has_the_same_picture(real: RosGraph, mission: RosGraph) -> None:
    (real.folder / "picture.py").write_text(PICTURE)
    command = f"{PYTHON} {real.folder / 'picture.py'}"
    mission.wait_for("rosnode ping -c 1 /talker", "xmlrpc reply")
    assert "/talker" in real.run(command)
    assert seen(mission.run(command)) == seen(real.run(command))


def seen(picture: str) -> list[str]:
    """What is in a picture, without rosgraph's word on connections of tools that have just gone."""
    return [line for line in picture.splitlines() if not line.startswith("cannot add edge")]


def test_a_rate_is_measured_alike(real: RosGraph, mission: RosGraph) -> None:
    told = of_both(real, mission, lambda graph: measured(graph, "hz"))
    assert shapes(told[0]) == shapes(told[1])
    for lines in told:
        rate = float(lines[-2].removeprefix("average rate: "))
        least, most = (float(each) for each in re.findall(r"(?:min|max): ([\d.]+)s", lines[-1]))
        assert least - ROUNDED_S <= 1 / rate <= most + ROUNDED_S, lines
        assert RATE_HZ / 2 < rate < RATE_HZ * 2, lines  # else the computer stood still for as long as the window lasts


def test_a_bandwidth_is_measured_alike(real: RosGraph, mission: RosGraph) -> None:
    told = of_both(real, mission, lambda graph: measured(graph, "bw"))
    assert shapes(told[0]) == shapes(told[1])
    assert told[0][-1] == told[1][-1] == f"mean: 9.00B min: 9.00B max: 9.00B window: {WINDOW}"


def of_both(real: RosGraph, mission: RosGraph, ask: Callable[[RosGraph], T]) -> list[T]:
    """What comes of the same on both graphs, at once."""
    with ThreadPoolExecutor(2) as threads:
        return list(threads.map(ask, (real, mission)))


def measured(graph: RosGraph, tool: str) -> list[str]:
    """What rostopic says until its window is full."""
    lines: list[str] = []
    with started(["rostopic", tool, "-w", str(WINDOW), "/chatter"], unbuffered(graph)) as process:
        assert process.stdout is not None
        for line in process.stdout:
            lines.append(line.strip())
            if line.endswith(f"window: {WINDOW}\n"):
                return lines
    raise AssertionError(lines)


def shapes(lines: list[str]) -> set[str]:
    """The kinds of lines, with N for numbers; on a busy computer a tool may look before anything has come."""
    return {re.sub(r"[\d.]+", "N", line) for line in lines} - {"no new messages"}


def test_what_a_tool_publishes_reaches_the_node_alike(real: RosGraph, mission: RosGraph) -> None:
    """The node latches the length of what it has heard."""

    def publish(graph: RosGraph) -> set[str]:
        said = latched(graph, "data:_twelve_bytes", "data: 18")
        put_back(graph)
        return said

    told = of_both(real, mission, publish)
    assert told[0] == told[1]


def test_what_a_tool_publishes_of_another_type_is_refused_alike(real: RosGraph, mission: RosGraph) -> None:
    def publish(graph: RosGraph) -> set[str]:
        with started(["rostopic", "pub", "/orders", "std_msgs/Int32", "5"], unbuffered(graph)) as process:
            return lines_of(wait_for_line(process, "topic types do not match"))

    told = of_both(real, mission, publish)
    assert told[0] == told[1]


def latched(graph: RosGraph, text: str, length: str) -> set[str]:
    """Publish until the node has latched the length; what the tool has said."""
    with started(["rostopic", "pub", "/orders", "std_msgs/String", text], unbuffered(graph)) as process:
        graph.wait_for("rostopic echo -n 1 /latched", length)
        process.terminate()
        return lines_of(process.communicate(timeout=LIMIT_S)[0])


def put_back(graph: RosGraph) -> None:
    """Let the node latch again what it has latched at its start: the graph of real ROS is that of other tests, too."""
    latched(graph, "seven77", "data: 7")


def unbuffered(graph: RosGraph) -> dict[str, str]:
    return {**graph.environ, "PYTHONUNBUFFERED": "1"}


def lines_of(output: str) -> set[str]:
    """Lines without colours, times, and options of a connection that both sides choose for themselves."""
    output = re.sub(r"\x1b\[\d*m", "", output)
    output = re.sub(r"\[\d+\.\d+\]", "[T]", output)
    return {re.sub(r"(, )?'tcp_nodelay': '\d'", "", line) for line in output.splitlines()}


@pytest.mark.parametrize(("topic", "count"), [("/chatter", 5), ("/latched", 1)])
def test_bags_are_the_same(real: RosGraph, mission: RosGraph, topic: str, count: int) -> None:
    """Of both graphs: what is told of recording, and topics, types, definitions, connections and messages."""

    def record(graph: RosGraph) -> tuple[set[str], list[str]]:
        recorded = lines_of(graph.run(f"rosbag record -l {count} -O recorded.bag {topic}"))
        return recorded, contents(graph, "recorded.bag")

    told = of_both(real, mission, record)
    assert told[0] == told[1]
    assert f"messages:    {count}" in told[0][1]


def test_a_bag_is_played_alike(real: RosGraph, mission: RosGraph) -> None:
    """Over and over, until what is played was recorded and has reached the node: nobody need be ready in time."""
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
    """All of a bag but its times, and the number in the name of rosbag's node."""
    (graph.folder / "dump.py").write_text(DUMP)
    told = graph.run(f"rosbag info {bag}; {PYTHON} dump.py {bag}")
    lines = re.sub(r"/play_\d+", "/play_N", told).splitlines()
    return [line for line in lines if not line.startswith(("duration:", "start:", "end:"))]


def test_a_run_with_ros_is_replayed_without_it(tmp_path: Path) -> None:
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

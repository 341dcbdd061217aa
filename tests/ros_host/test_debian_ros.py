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
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from cfepy.journal import read_journal, replay

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
    assert mission.run(command) == real.run(command)


def test_rates_and_bandwidths_are_measured(mission: RosGraph) -> None:
    for tool, text in (("hz", "average rate: "), ("bw", "average: ")):
        with started(["rostopic", tool, "/chatter"], {**mission.environ, "PYTHONUNBUFFERED": "1"}) as process:
            assert process.stdout is not None
            assert any(text in line for line in process.stdout)


def test_what_a_tool_publishes_reaches_the_node(mission: RosGraph) -> None:
    mission.run("rostopic pub -1 /orders std_msgs/String data:_twelve_bytes")
    mission.wait_for("rostopic echo -n 1 /latched", "data: ")
    assert "data: 7" not in mission.run("rostopic echo -n 1 /latched")


def test_a_bag_is_recorded_and_played(mission: RosGraph) -> None:
    mission.run("rosbag record -l 5 -O chatter.bag /chatter")
    info = mission.run("rosbag info chatter.bag")
    assert "/chatter   5 msgs    : std_msgs/String" in info
    assert "992ce8a1687cec8c8bd883ec73ca41d1" in info
    mission.run("rosbag play --quiet -d 2 chatter.bag /chatter:=/orders")
    assert "data: 5" in mission.run("rostopic echo -n 1 /latched")


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

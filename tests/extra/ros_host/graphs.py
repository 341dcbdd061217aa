"""Graphs of ROS for the tests: Debian's master, a node on real rospy, and the same node in a mission.

One node's source runs twice: with real rospy on Debian's rosmaster, and in a mission that serves a master or joins one.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from dev.host_ports import free_port

TALKER = Path(__file__).parent / "talker.py"
PYTHON = "/usr/bin/python3"
TOOLS = ("rostopic", "rosnode", "rosservice", "rosparam", "rosmaster")
LIMIT_S = 60  # wall time after which a tool that hangs is given up
MODULES = "import rospy, rosmaster, rostopic, rosbag, roscpp.srv"
HAS_ROS = (
    all(shutil.which(each) for each in TOOLS)
    and not subprocess.run([PYTHON, "-c", MODULES], capture_output=True, check=False).returncode
)


class RosGraph:
    """A ROS graph for tools.

    Args:
        uri: URI of its master.
        folder: folder for files of tools.
    """

    def __init__(self, uri: str, folder: Path) -> None:
        self.environ = {**os.environ, "ROS_MASTER_URI": uri, "ROS_LOG_DIR": str(folder), "ROS_IP": "127.0.0.1"}
        self.folder = folder

    def run(self, command: str) -> str:
        """Return the output of a command."""
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
        """Wait until the output of a command contains a text, for example for a node's start."""
        said = ""
        for _ in range(LIMIT_S // 2):
            said = self.run(command)
            if text in said:
                return
        raise AssertionError(f"{command} never said {text!r}; the last it said was {said!r}")


@contextmanager
def started(words: list[str], environ: dict[str, str] | None = None) -> Iterator[subprocess.Popen[str]]:
    process = subprocess.Popen(words, env=environ, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    try:
        yield process
    finally:
        process.terminate()
        process.communicate(timeout=LIMIT_S)


def wait_for_line(process: subprocess.Popen[str], text: str, limit_s: float = LIMIT_S) -> str:
    """Read a process's output until a line contains a text. A process that never prints it is killed after a while."""
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
    """Return a graph at a free port, which has no master yet."""
    return RosGraph(f"http://127.0.0.1:{free_port()}", folder)


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
    """Return a mission of the talker."""
    mission = folder / "mission"
    mission.mkdir()
    shutil.copy(TALKER, mission / "talker.py")
    (mission / "startup.scr").write_text(
        "CFE_APP, talker.py, __main__, TALKER, 100, 16384, 0x0, 0;\n!\n", encoding="utf-8"
    )
    return mission


def cfepy_run(mission: Path, *options: str) -> list[str]:
    return [sys.executable, "-m", "cfepy", "run", str(mission), "--realtime", *options]


def joining(folder: Path, graph: RosGraph) -> list[str]:
    return cfepy_run(mission_of(folder), "--ros-master", graph.environ["ROS_MASTER_URI"])

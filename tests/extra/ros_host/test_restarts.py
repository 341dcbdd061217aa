"""The ROS master, a node on real rospy, and the mission are killed and started again, 50 times each.

Each time messages pass both ways again, as the surviving side reports: a node of `meets.py` prints whom it has met.
The survivor does not grow. A leak per restart would show 40 times after the first ten restarts, in which caches fill.
"""

from __future__ import annotations

import json
import shutil
import signal
import subprocess
import time
from pathlib import Path
from typing import Any, NamedTuple
from xmlrpc.client import ServerProxy

import pytest

from tests.extra.ros_host.graphs import (
    HAS_ROS,
    PYTHON,
    RosGraph,
    cfepy_run,
    free_graph,
    master_of,
    rosmaster,
    started,
    wait_for_line,
)

NODE = Path(__file__).with_name("meets.py")
RESTARTS, WARM_UP = 50, 10
# 26 KiB a restart. Measured were 100 to 400 KiB in total, for output, caches and free memory of Python.
MOST_GROWTH_KIB = 1024
LOOK_AGAIN_S = 0.1  # interval for values that settle soon
PATIENCE_S = 200  # wall time limit; a busy computer takes half a minute to start a process

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not HAS_ROS, reason="Debian's ROS 1 is not installed (python3-rostopic and others)"),
]


class Footprint(NamedTuple):
    """Resources of a process."""

    memory_kib: int
    threads: int
    files: int


class Survivor:
    """A process that lives on, and its footprint after each restart of another one."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self.process = process
        self.footprints: list[Footprint] = []

    def look(self) -> None:
        """Record its present resources."""
        of = Path(f"/proc/{self.process.pid}")
        lines = [line.split() for line in (of / "status").read_text(encoding="utf-8").splitlines()]
        values = {words[0]: words[1] for words in lines if len(words) > 1}
        files = len(list((of / "fd").iterdir()))
        self.footprints.append(Footprint(int(values["VmRSS:"]), int(values["Threads:"]), files))

    def check(self) -> None:
        """Assert that the process lives and has not grown.

        Threads and files of current work vary: soon it has no more than in the first restarts.
        """
        first, last = self.footprints[1 : WARM_UP + 1], self.footprints[-1]
        assert len(self.footprints) == RESTARTS + 1
        assert last.memory_kib - first[-1].memory_kib < MOST_GROWTH_KIB, self.footprints
        end_s = time.monotonic() + PATIENCE_S
        while last.threads > max(each.threads for each in first) or last.files > max(each.files for each in first):
            assert time.monotonic() < end_s, self.footprints
            time.sleep(LOOK_AGAIN_S)
            self.look()
            last = self.footprints[-1]


class Flight:
    """A mission of a node that meets others.

    Args:
        folder: folder for its files.
        start: name of this start.
    """

    def __init__(self, folder: Path, start: str) -> None:
        self.folder = folder / start
        self.folder.mkdir()
        shutil.copy(NODE, self.folder)
        nodes = f"nodes: {{MEETS: {{args: [mission, peer, {start}]}}}}\n"
        (self.folder / "mission.yaml").write_text(f"name: meets\n{nodes}", encoding="utf-8")
        (self.folder / "startup.scr").write_text(
            "CFE_APP, meets.py, __main__, MEETS, 100, 16384, 0x0, 0;\n!\n", encoding="utf-8"
        )
        self._report = self.folder / "report.json"

    def command(self, master: str) -> list[str]:
        """Flies it."""
        return cfepy_run(self.folder, "--ros-master", master, "--json", str(self._report))

    def rows(self) -> dict[str, Any]:
        """Return the report's rows of the peer's topics, by topic."""
        rows = json.loads(self._report.read_text(encoding="utf-8"))["ros_peers"]
        return {row["name"]: row for row in rows if row["peer"] == "/peer" and row["name"].startswith("/of_")}


def peer(start: str) -> list[str]:
    return [PYTHON, str(NODE), "peer", "mission", start]


def die(process: subprocess.Popen[str], by: int = signal.SIGKILL) -> None:
    process.send_signal(by)
    process.communicate()


def check_recoveries(flight: Flight) -> None:
    """The report has a connection for each start of the peer, both ways, and no message was lost on one."""
    rows = flight.rows()
    assert {name: row["connections"] for name, row in rows.items()} == {
        "/of_mission": RESTARTS + 1,
        "/of_peer": RESTARTS + 1,
    }
    assert all(row["ended"] >= RESTARTS and row["dropped"] == 0 for row in rows.values()), rows


@pytest.mark.parametrize("way", ["serve", "join"])
def test_killed_peer_reconnects(way: str, tmp_path: Path) -> None:
    if way == "serve":
        kill_peers(tmp_path, "serve:0")
    else:
        with rosmaster(tmp_path) as graph:
            kill_peers(tmp_path, graph.environ["ROS_MASTER_URI"])


def kill_peers(folder: Path, master: str) -> None:
    flight = Flight(folder, "mission")
    with started(flight.command(master)) as mission:
        told = wait_for_line(mission, "ROS master at", PATIENCE_S)
        graph = RosGraph(told.rpartition("=")[2] if master == "serve:0" else master, folder)
        survivor = Survivor(mission)
        for number in range(RESTARTS + 1):
            with started(peer(f"peer{number}"), graph.environ) as outside:
                wait_for_line(mission, f"met peer{number}", PATIENCE_S)
                survivor.look()
                die(outside)
        survivor.check()
    check_recoveries(flight)


def test_killed_master_is_joined_again(tmp_path: Path) -> None:
    """rospy never registers again with a new master, so there is a new peer each time. The mission does register."""
    graph = free_graph(tmp_path)
    flight = Flight(tmp_path, "mission")
    with master_of(graph) as first:
        graph.wait_for("rosparam set /state up; rosparam get /state", "up")
        with started(flight.command(graph.environ["ROS_MASTER_URI"])) as mission:
            survivor = Survivor(mission)
            wait_for_line(mission, "joined the ROS master", PATIENCE_S)
            meet_beside(graph, survivor, "peer0", first)
            for number in range(1, RESTARTS + 1):
                with master_of(graph) as master:
                    wait_for_line(mission, "is back: the mission's nodes register again", PATIENCE_S)
                    meet_beside(graph, survivor, f"peer{number}", master)
            survivor.check()
    check_recoveries(flight)


def meet_beside(graph: RosGraph, survivor: Survivor, start: str, master: subprocess.Popen[str]) -> None:
    """Have a peer meet the mission beside a master. Both are killed."""
    with started(peer(start), graph.environ) as outside:
        wait_for_line(survivor.process, f"met {start}", PATIENCE_S)
        survivor.look()
        die(master)
        die(outside)


def test_killed_mission_reconnects(tmp_path: Path) -> None:
    """By turns it is killed, so that its registrations stay behind, and terminated, so that it takes them back."""
    graph = free_graph(tmp_path)
    uri = graph.environ["ROS_MASTER_URI"]
    terminated = []
    with master_of(graph) as master:
        graph.wait_for("rosparam set /state up; rosparam get /state", "up")
        with started(peer("peer"), graph.environ) as outside:
            survivors = Survivor(outside), Survivor(master)
            for number in range(RESTARTS + 1):
                flight = Flight(tmp_path, f"mission{number}")
                with started(flight.command(uri)) as mission:
                    wait_for_line(outside, f"met mission{number}", PATIENCE_S)
                    for each in survivors:
                        each.look()
                    die(mission, signal.SIGKILL if number % 2 else signal.SIGTERM)
                if not number % 2:
                    terminated.append(flight)
            for each in survivors:
                each.check()
            with ServerProxy(uri) as asked:
                state = asked.getSystemState("/test")
    assert "/mission" not in str(state)
    for flight in terminated:
        assert {name: row["connections"] for name, row in flight.rows().items()} == {"/of_mission": 1, "/of_peer": 1}

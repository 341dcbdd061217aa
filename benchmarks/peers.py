"""cfepy beside the originals, in one run: Debian's rospy, and NASA's cFE where one was built.

`python -m benchmarks peers`, with `CFEPY_REAL_CFE=FOLDER` for NASA's: FOLDER has the executable `core-cpu1` and lies in
its build tree, as CONTRIBUTING.md describes. The program reports missing parts and leaves them out.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from time import perf_counter, process_time

from benchmarks.bus import fan_out, one_task, ping_pong
from benchmarks.measure import rate
from cfepy.mission import Mission, read_mission
from cfepy.nodes import NodeConfig
from cfepy.writing.console import Console
from dev.host_ports import free_port
from dev.twin.real import VARIABLE, RealCfe, installed

HERE = Path(__file__).parent
NODES = HERE / "nodes" / "peers"
SOURCE = HERE / "peer_app" / "peer.c"
STARTUP = b"CFE_APP, peer, PEER_Main, PEER, 50, 16384, 0x0, 0;\n!\n"
PYTHON = "/usr/bin/python3"  # Debian's ROS packages belong to it
ROUND_TRIPS = 5000
VIRTUAL_S = 0.2
REPEATS = 5
LIMIT_S = 120  # wall time for NASA's


def peers(contexts: tuple[str, ...]) -> dict[str, float]:
    """Return figures in microseconds by name: a round trip of rospy between two nodes, and the Software Bus.

    CPU time includes all participants: for rospy both processes. NASA's cFE has one CPU, and is measured by its own
    clock.
    """
    figures: dict[str, float] = {}
    for context in contexts:
        figures[f"rospy.round_trip_cpu_us.{context}"] = min(_round_trip_us(context) for _ in range(REPEATS))
        for measure in (one_task, ping_pong, fan_out):
            figures[f"bus.{measure.__name__}_us.{context}"] = 1e6 / rate(partial(measure, context))
    figures.update(_of_ros())
    figures.update(_of_nasa())
    return figures


def _round_trip_us(context: str) -> float:
    """Of the nodes of a mission, in CPU time."""
    spec = read_mission(str(NODES))
    asks = NodeConfig("ASKS", args=("0",))
    spec = replace(spec, ros=replace(spec.ros, nodes={**spec.ros.nodes, "ASKS": asks}))
    with Mission(spec, tasks=context, console=Console(quiet=True)) as flight:
        flight.run_for(1)
        before, begin = _answers(flight), process_time()
        flight.run_for(VIRTUAL_S)
        return (process_time() - begin) * 1e6 / (_answers(flight) - before)


def _answers(flight: Mission) -> int:
    assert flight.ros is not None
    msg_id = next(row.msg_id for row in flight.ros.topics() if row.name == "/answer")
    return flight.cfe.sb.routes[msg_id].totals()[0]


# -- rospy -------------------------------------------------------------------------------------------------------------


def _of_ros() -> dict[str, float]:
    runs = [trip for trip in (_real_round_trip() for _ in range(REPEATS)) if trip is not None]
    if not runs:
        return {}
    return {
        "rospy.round_trip_cpu_us.ros": min(cpu_us for cpu_us, _ in runs),
        "rospy.round_trip_us.ros": min(wall_us for _, wall_us in runs),
    }


@contextmanager
def with_master() -> Iterator[dict[str, str] | None]:
    """Run a master of Debian's ROS while the block runs. Yields the environment of its nodes, or None without ROS."""
    has_ros = shutil.which("rosmaster") and not subprocess.run([PYTHON, "-c", "import rospy"], check=False).returncode
    if not has_ros:
        print("  no rospy of Debian (python3-rospy, python3-rosmaster): left out", file=sys.stderr)
        yield None
        return
    port = free_port()
    environ = {**os.environ, "ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_IP": "127.0.0.1"}
    with tempfile.TemporaryDirectory() as folder:
        environ |= {"ROS_HOME": folder, "ROS_LOG_DIR": folder}
        with started(["rosmaster", "--core", "-p", str(port)], environ):
            yield environ


def _real_round_trip() -> tuple[float, float] | None:
    """Return the microseconds of CPU time of both nodes, and of the wall clock, or None without ROS."""
    with with_master() as environ:
        if environ is None:
            return None
        with (
            started([PYTHON, str(NODES / "answers.py")], environ) as answers,
            started([PYTHON, str(NODES / "asks.py"), str(ROUND_TRIPS)], environ) as asks,
        ):
            nodes = (answers.pid, asks.pid)
            _wait_for("begin", asks)
            cpu_s, wall_s = sum(map(_cpu_s, nodes)), perf_counter()
            _wait_for("end", asks)
            cpu_s, wall_s = sum(map(_cpu_s, nodes)) - cpu_s, perf_counter() - wall_s
    return cpu_s * 1e6 / ROUND_TRIPS, wall_s * 1e6 / ROUND_TRIPS


@contextmanager
def started(command: list[str], environ: dict[str, str]) -> Iterator[subprocess.Popen[str]]:
    """Run a process with readable output while the block runs, and kill it at the end."""
    process = subprocess.Popen(command, env=environ, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


def _wait_for(line: str, process: subprocess.Popen[str]) -> None:
    assert process.stdout is not None
    if not any(each.strip() == line for each in process.stdout):
        raise RuntimeError(f"{process.args!r} ended without {line!r}")


def _cpu_s(pid: int) -> float:
    """Return the CPU time of a process so far, in seconds."""
    told = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    return (int(told[11]) + int(told[12])) / os.sysconf("SC_CLK_TCK")


# -- NASA's cFE --------------------------------------------------------------------------------------------------------


def _of_nasa() -> dict[str, float]:
    built = installed()
    if built is None:
        print(f"  no NASA's cFE ({VARIABLE}): left out", file=sys.stderr)
        return {}
    with tempfile.TemporaryDirectory() as place:
        library = Path(place) / "peer.so"
        subprocess.run(["cc", *_flags(built), "-shared", "-o", str(library), str(SOURCE)], check=True)
        best: dict[str, float] = {}
        for number in range(REPEATS):
            folder = Path(place) / str(number)
            folder.mkdir()
            for what, us in _flight(built, folder, library.read_bytes()).items():
                best[what] = min(us, best.get(what, us))
    return {f"bus.{what}_us.cfe": us for what, us in best.items()}


def _flags(built: Path) -> list[str]:
    """Return the compiler flags of its own sample application.

    Raises:
        FileNotFoundError: the executable is not in its build tree.
    """
    found = sorted(built.parents[1].glob("**/sample_app.dir/flags.make"))
    if not found:
        raise FileNotFoundError(f"{VARIABLE}: {built} is not in the tree where it was built")
    told = re.findall(r"^C_(?:DEFINES|INCLUDES|FLAGS) = (.*)$", found[0].read_text(encoding="utf-8"), re.MULTILINE)
    return " ".join(told).split()


def _flight(built: Path, folder: Path, library: bytes) -> dict[str, float]:
    """Return the microseconds by measurement."""
    files = {"/cf/cfe_es_startup.scr": STARTUP, "/cf/peer.so": library}
    with RealCfe(built, folder, files) as cfe:
        cfe.wait(lambda: b"PEER fan_out: " in cfe.console(), "end of the measurement", LIMIT_S)
        told = re.findall(r"PEER (\w+): (\d+) in (\d+) us", cfe.console().decode(errors="replace"))
    return {what: int(us) / int(count) for what, count, us in told}

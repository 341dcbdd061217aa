"""A message there and back between a real rospy node and one of a mission, beside two real rospy nodes, in one run.

`python -m benchmarks ros_host` needs Debian's python3-rospy, python3-rosmaster and python3-sensor-msgs. One rospy node
sends to two echo nodes by turns: another rospy node, and the same script as a node of a mission that has joined the
graph in real time.
"""

from __future__ import annotations

import subprocess
import sys

from benchmarks.peers import HERE, PYTHON, started, with_master

NODES = HERE / "nodes" / "ros_host"
NAMES = ("rospy", "mission")
SERIES, MESSAGES = 14, 50  # for each of the two
LIMIT_S = 300


def ros_host() -> dict[str, float]:
    """Return medians in microseconds of wall-clock time, and their ratio; empty without Debian's rospy."""
    with with_master() as environ:
        if environ is None:
            return {}
        joined = [sys.executable, "-m", "cfepy", "run", str(NODES), "--realtime"]
        joined += ["--ros-master", environ["ROS_MASTER_URI"], "--quiet"]
        with (
            started([PYTHON, str(NODES / "echoes.py"), "rospy"], environ),
            started(joined, environ),
        ):
            words = [PYTHON, str(NODES / "measures.py"), *NAMES, str(SERIES), str(MESSAGES)]
            done = subprocess.run(words, env=environ, capture_output=True, text=True, timeout=LIMIT_S)
    if done.returncode:
        raise RuntimeError(f"{words} ended with {done.returncode}: {done.stderr.strip()}")
    lines = [line.split() for line in done.stdout.splitlines()]
    medians = {words[0]: float(words[1]) for words in lines if words and words[0] in NAMES}  # rospy may log between
    return {
        "rospy_us": medians["rospy"],
        "mission_us": medians["mission"],
        "mission_by_rospy": medians["mission"] / medians["rospy"],
    }

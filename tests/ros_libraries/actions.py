"""Common nodes of the tests of actionlib: a server that counts, and parts of clients."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests.rospy_shim.missions import Run, run_nodes

DEBIAN = Path("/usr/lib/python3/dist-packages")

SERVER = """
import rospy, actionlib
from actionlib.msg import TestAction, TestFeedback, TestResult

def execute(goal):
    print("goal", goal.goal)
    if goal.goal < 0:
        raise ValueError("below zero")
    for step in range(goal.goal):
        if server.is_preempt_requested():
            server.set_preempted(TestResult(step), "stopped")
            return
        server.publish_feedback(TestFeedback(step))
        rospy.sleep(0.2)
    if goal.goal != 7:
        server.set_succeeded(TestResult(goal.goal * 2), "fine")

rospy.init_node("server")
server = actionlib.SimpleActionServer("count", TestAction, execute, False)
server.start()
rospy.spin()
"""

CLIENT = """
import rospy, actionlib
from actionlib import ActionClient, CommState, GoalStatus, SimpleActionClient, TerminalState
from actionlib.msg import TestAction, TestGoal
rospy.init_node("client")
"""


def bring(original: str, folder: Path) -> None:
    """Copy the source of Debian's installed library beside the nodes. "" leaves cfepy's own."""
    if not original:
        return
    if not (DEBIAN / original).is_dir():
        pytest.skip(f"the original {original} is not installed (Debian: python3-{original.replace('_', '-')})")
    shutil.copytree(DEBIAN / original, folder / original, ignore=shutil.ignore_patterns("msg", "__pycache__"))


def talk(folder: Path, client: str, *, server: str = SERVER, seconds: float = 20.0, tasks: str = "thread") -> Run:
    """Run a client, which is the text that follows `CLIENT`, against a server.

    Args:
        folder: the mission's folder.
        client: the rest of the client's source.
        server: source of the server.
        seconds: virtual time.
        tasks: "thread" or "greenlet".
    """
    return run_nodes(folder, {"SERVER": server, "CLIENT": CLIENT + client}, seconds=seconds, tasks=tasks)

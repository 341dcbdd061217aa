"""The names that user code finds in actionlib, the table of transitions, and the original library in our place."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.ros_libraries.actions import bring, talk
from tests.rospy_shim.missions import run_nodes

MODULES = """
import actionlib, importlib
for part in ("action_client", "action_server", "exceptions", "goal_id_generator", "handle_tracker_deleter",
             "server_goal_handle", "simple_action_client", "simple_action_server", "status_tracker", "msg"):
    assert importlib.import_module("actionlib." + part) is getattr(actionlib, part)
from actionlib.simple_action_client import SimpleActionClient, SimpleGoalState
from actionlib.action_client import ActionClient, GoalManager, ClientGoalHandle, CommState, TerminalState
from actionlib.simple_action_server import SimpleActionServer
from actionlib import *
print(SimpleGoalState.to_string(2), CommState.to_string(8), TerminalState.to_string(5), GoalStatus.to_string(0))
print(GoalStatus.to_string(42))
"""

# The states that each status leads to, from each state.
TRANSITIONS = """
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray
from actionlib.msg import TestActionGoal
from actionlib import CommState, CommStateMachine
import rospy
rospy.init_node("table")
for state in range(8):
    row = []
    for status in range(10):
        seen = []
        goal = TestActionGoal(goal_id=GoalID(id="g"))
        machine = CommStateMachine(goal, lambda handle: seen.append(handle.get_comm_state()), None, None, None)
        machine.state = state
        told = GoalStatus(goal_id=GoalID(id="g"), status=status)
        machine.update_status(GoalStatusArray(status_list=[told]))
        row.append("".join(map(str, seen)) or "-")
    print(CommState.to_string(state), *row)
"""


def test_modules_and_names(tmp_path: Path) -> None:
    run = run_nodes(tmp_path, {"N": MODULES})
    assert run.printed["N"] == ["DONE LOST REJECTED _has_header", "NO_SUCH_STATE_42"]


@pytest.mark.parametrize("original", ["", "actionlib"])
def test_transitions(tmp_path: Path, original: str) -> None:
    bring(original, tmp_path)
    run = run_nodes(tmp_path, {"N": TRANSITIONS})
    table = [line for line in run.printed["table"] if "]: " not in line]
    assert table == [
        "WAITING_FOR_GOAL_ACK 1 2 263 23 23 13 26 15 13 -",
        "PENDING - 2 263 23 23 3 26 5 53 -",
        "ACTIVE - - 63 3 3 - 6 - - -",
        "WAITING_FOR_RESULT - - - - - - - - - -",
        "WAITING_FOR_CANCEL_ACK - - 63 63 63 3 6 5 53 -",
        "RECALLING - - 63 63 63 3 6 - 3 -",
        "PREEMPTING - - 3 3 3 - - - - -",
        "DONE - - - - - - - - - -",
    ]
    errors = [line.partition("]: ")[2] for line in run.printed["table"] if "]: " in line]
    assert errors.count("Got an unknown status from the ActionServer: 9") == 7
    assert "Invalid goal status transition from ACTIVE to _has_header" in errors
    assert len(errors) == 7 + 14


@pytest.mark.parametrize("original", ["", "actionlib"])
def test_library_and_the_original_give_the_same_answers(tmp_path: Path, original: str) -> None:
    client = """
client = SimpleActionClient("count", TestAction)
print(client.wait_for_server())
said = []
for goal in (2, -1, 7):
    client.send_goal(TestGoal(goal), lambda *end: said.append(end[0]), lambda: said.append("active"),
                     lambda feedback: said.append(feedback.feedback * 100))
    client.wait_for_result()
    print(said, client.get_state(), client.get_goal_status_text())
print(client.send_goal_and_wait(TestGoal(30), rospy.Duration(1.0), rospy.Duration(1.0)), client.get_result().result)
print(actionlib.__file__.split("/")[-2:], actionlib.SimpleActionClient.__module__)
"""
    bring(original, tmp_path)
    run = talk(tmp_path, client)
    assert [line for line in run.printed["client"] if "]: " not in line] == [
        "True",
        "['active', 0, 100, 3] 3 fine",
        "['active', 0, 100, 3, 'active', 4] 4 Exception in execute callback: below zero",
        "['active', 0, 100, 3, 'active', 4, 'active', 0, 100, 200, 300, 400, 500, 600, 4] 4 No terminal state was set.",
        "2 5",
        "['actionlib', '__init__.py'] actionlib.simple_action_client",
    ]

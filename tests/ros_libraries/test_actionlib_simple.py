"""SimpleActionClient and SimpleActionServer: arguments of callbacks, ends of goals, and their texts."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.ros_libraries.actions import SERVER, talk

FOLLOWED = """
client = SimpleActionClient("count", TestAction)
print(client.wait_for_server(rospy.Duration(5)))
client.send_goal(
    TestGoal(3),
    lambda status, result: print("done", GoalStatus.to_string(status), result.result),
    lambda: print("active"),
    lambda feedback: print("feedback", feedback.feedback),
)
print(client.wait_for_result(), GoalStatus.to_string(client.get_state()), client.get_goal_status_text())
print(client.get_result().result)
"""


def test_goal_is_followed_from_beginning_to_end(tmp_path: Path) -> None:
    run = talk(tmp_path, FOLLOWED)
    assert run.printed["client"] == [
        "True",
        "active",
        "feedback 0",
        "feedback 1",
        "feedback 2",
        "done SUCCEEDED 6",
        "True SUCCEEDED fine",
        "6",
    ]
    assert run.printed["server"] == ["goal 3"]


def test_run_is_the_same_on_threads_and_greenlets(tmp_path: Path) -> None:
    digests = set()
    for tasks in ("thread", "greenlet", "thread"):
        folder = tmp_path / f"{len(list(tmp_path.iterdir()))}"
        folder.mkdir()
        digests.add(talk(folder, FOLLOWED, tasks=tasks).digest)
    assert len(digests) == 1


@pytest.mark.parametrize(
    ("goal", "state", "text"),
    [
        ("TestGoal(0)", "SUCCEEDED", "fine"),
        ("TestGoal(-1)", "ABORTED", "Exception in execute callback: below zero"),
        ("TestGoal(7)", "ABORTED", "No terminal state was set."),
        ("TestGoal(50)", "PREEMPTED", "stopped"),
    ],
)
def test_goals_end_with_the_expected_state_and_text(tmp_path: Path, goal: str, state: str, text: str) -> None:
    client = f"""
    client = SimpleActionClient("count", TestAction)
    client.wait_for_server()
    state = client.send_goal_and_wait({goal}, rospy.Duration(3), rospy.Duration(1))
    print(TerminalState.to_string(state), client.get_goal_status_text())
    """
    run = talk(tmp_path, "if True:" + client)
    assert run.printed["client"] == [f"{state} {text}"]


def test_newer_goal_preempts_the_older_one(tmp_path: Path) -> None:
    client = """
first, second = SimpleActionClient("count", TestAction), SimpleActionClient("count", TestAction)
first.wait_for_server(), second.wait_for_server()
first.send_goal(TestGoal(20))
rospy.sleep(1)
second.send_goal(TestGoal(2))
print(second.wait_for_result(), first.wait_for_result())
print(GoalStatus.to_string(first.get_state()), first.get_result().result)
print(GoalStatus.to_string(second.get_state()), second.get_result().result)
"""
    run = talk(tmp_path, client)
    assert run.printed["client"] == ["True True", "PREEMPTED 5", "SUCCEEDED 4"]
    assert run.printed["server"] == ["goal 20", "goal 2"]


def test_waiting_goal_is_replaced(tmp_path: Path) -> None:
    client = """
clients = [SimpleActionClient("count", TestAction) for _ in range(3)]
for number, client in enumerate(clients):
    client.wait_for_server()
for number, client in enumerate(clients):
    client.send_goal(TestGoal(5 + number))
    rospy.sleep(0.05)
for client in clients:
    client.wait_for_result()
    print(GoalStatus.to_string(client.get_state()), client.get_goal_status_text())
"""
    run = talk(tmp_path, client)
    replaced = "This goal was canceled because another goal was received by the simple action server"
    assert run.printed["client"] == ["PREEMPTED stopped", f"RECALLED {replaced}", "ABORTED No terminal state was set."]


def test_calls_without_a_goal_or_a_server_are_refused(tmp_path: Path) -> None:
    client = """
client = SimpleActionClient("nobody", TestAction)
print(client.wait_for_server(rospy.Duration(0.5)), client.get_state(), client.get_result())
print(client.wait_for_result(), client.get_goal_status_text())
client.cancel_goal()
"""
    run = talk(tmp_path, client)
    told = [line.partition("]: ")[2] or line for line in run.printed["client"]]
    assert sorted(told) == sorted(
        [
            "Called get_result when no goal is running",
            "False 9 None",
            "Called wait_for_result when no goal exists",
            "Called get_goal_status_text when no goal is running",
            "False ERROR: Called get_goal_status_text when no goal is running",
        ]
    )


POLLING = """
import rospy, actionlib
from actionlib.msg import TestAction, TestResult
rospy.init_node("server")
server = actionlib.SimpleActionServer("count", TestAction, auto_start=False)
server.register_goal_callback(lambda: print("goal", server.accept_new_goal().goal))
server.register_preempt_callback(lambda: server.set_preempted(TestResult(-1)))
server.start()
print(server.accept_new_goal(), server.is_active(), server.is_new_goal_available())
rospy.spin()
"""


def test_a_server_with_callbacks(tmp_path: Path) -> None:
    client = """
client = SimpleActionClient("count", TestAction)
client.wait_for_server()
client.send_goal(TestGoal(4))
print(client.wait_for_result(rospy.Duration(0.5)), GoalStatus.to_string(client.get_state()))
client.cancel_all_goals()
print(client.wait_for_result(rospy.Duration(0.5)), client.get_result().result)
"""
    run = talk(tmp_path, client, server=POLLING)
    assert run.printed["client"] == ["False ACTIVE", "True -1"]
    assert "None False False" in run.printed["server"]
    assert "goal 4" in run.printed["server"]
    complaint = "Attempting to accept the next goal when a new goal is not available"
    assert any(line.endswith(complaint) for line in run.printed["server"])


def test_auto_start_causes_a_warning(tmp_path: Path) -> None:
    server = SERVER.replace("execute, False)\nserver.start()", "execute)")
    run = talk(tmp_path, FOLLOWED, server=server)
    assert run.printed["client"][-1] == "6"
    assert any("You've passed in true for auto_start" in line for line in run.printed["server"])


def test_class_that_is_not_an_action_is_refused(tmp_path: Path) -> None:
    client = """
for make in (lambda: SimpleActionClient("x", TestGoal), lambda: actionlib.ActionServer("x", TestGoal, print, print)):
    try:
        make()
    except actionlib.ActionException as error:
        print(error)
"""
    run = talk(tmp_path, client)
    assert run.printed["client"] == ["Type is not an action spec: <class 'actionlib.msg._TestGoal.TestGoal'>"] * 2

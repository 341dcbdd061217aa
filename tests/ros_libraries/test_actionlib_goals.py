"""ActionClient and ActionServer: several goals, cancelling by time, states in between, and the goal's ids."""

from __future__ import annotations

from pathlib import Path

from tests.ros_libraries.actions import talk

SERVER = """
import rospy, actionlib
from actionlib.msg import TestAction, TestResult

def on_goal(handle):
    number = handle.get_goal().goal
    if number == 0:
        handle.set_rejected(text="not that")
    elif number == 1:
        handle.set_accepted("on it")
        handle.set_succeeded(TestResult(10), "there")
    elif number == 2:
        handle.set_accepted()
        handle.set_aborted(text="broken")
    elif number == 3:
        handle.set_succeeded()
    else:
        handle.set_accepted("long")

rospy.init_node("server")
server = actionlib.ActionServer("jobs", TestAction, on_goal, lambda handle: handle.set_canceled(text="as asked"), False)
server.start()
rospy.spin()
"""


def test_each_goal_has_its_result(tmp_path: Path) -> None:
    client = """
client = ActionClient("jobs", TestAction)
client.wait_for_server()
seen = {}
def on_transition(handle):
    seen.setdefault(handle, []).append(CommState.to_string(handle.get_comm_state()))
handles = [client.send_goal(TestGoal(number), on_transition) for number in (0, 1, 2, 4)]
rospy.sleep(0.5)
handles[3].cancel()
rospy.sleep(0.5)
for handle in handles:
    end = TerminalState.to_string(handle.get_terminal_state())
    print(end, handle.get_goal_status_text(), "|", " ".join(seen[handle]))
"""
    run = talk(tmp_path, client, server=SERVER)
    assert run.printed["client"] == [
        "REJECTED not that | PENDING WAITING_FOR_RESULT DONE",
        "SUCCEEDED there | ACTIVE WAITING_FOR_RESULT DONE",
        "ABORTED broken | ACTIVE WAITING_FOR_RESULT DONE",
        "PREEMPTED as asked | ACTIVE WAITING_FOR_CANCEL_ACK PREEMPTING WAITING_FOR_RESULT DONE",
    ]


def test_goals_up_to_a_time(tmp_path: Path) -> None:
    client = """
client = ActionClient("jobs", TestAction)
client.wait_for_server()
early = client.send_goal(TestGoal(5))
rospy.sleep(0.5)
between = rospy.Time.now()
rospy.sleep(0.5)
late = client.send_goal(TestGoal(6))
rospy.sleep(0.2)
client.cancel_goals_at_and_before_time(between)
rospy.sleep(0.2)
print(GoalStatus.to_string(early.get_goal_status()), GoalStatus.to_string(late.get_goal_status()))
print(GoalStatus.to_string(late.get_terminal_state()))
"""
    run = talk(tmp_path, client, server=SERVER)
    assert run.printed["client"][0] == "PREEMPTED ACTIVE"
    assert run.printed["client"][-1] == "LOST"
    warnings = [line.partition("]: ")[2] for line in run.printed["client"][1:-1]]
    assert warnings == [
        "Asking for the terminal state when we're in [ACTIVE]",
        "Asking for a terminal state, but the goal status is 1",
    ]


def test_invalid_transition_is_refused(tmp_path: Path) -> None:
    client = """
client = ActionClient("jobs", TestAction)
client.wait_for_server()
handle = client.send_goal(TestGoal(3))
rospy.sleep(0.5)
print(CommState.to_string(handle.get_comm_state()))
"""
    run = talk(tmp_path, client, server=SERVER)
    assert run.printed["client"] == ["PENDING"]
    (line,) = run.printed["server"]
    assert line.endswith(
        "To transition to a succeeded state, the goal must be in a preempting or active state, "
        "it is currently in state: 0"
    )


def test_goal_unknown_to_the_server_is_lost(tmp_path: Path) -> None:
    server = SERVER.replace("rospy.spin()", "rospy.sleep(1)\nserver.status_list.clear()\nrospy.spin()")
    client = """
client = ActionClient("jobs", TestAction)
client.wait_for_server()
handle = client.send_goal(TestGoal(5))
rospy.sleep(2)
print(GoalStatus.to_string(handle.get_goal_status()), CommState.to_string(handle.get_comm_state()))
"""
    assert talk(tmp_path, client, server=server).printed["client"] == ["LOST DONE"]


def test_ids_and_handles(tmp_path: Path) -> None:
    client = """
client = ActionClient("jobs", TestAction)
client.wait_for_server()
one, two = client.send_goal(TestGoal(4)), client.send_goal(TestGoal(4))
ids = [handle.comm_state_machine.action_goal.goal_id.id.split("-")[:2] for handle in (one, two)]
print(ids, one == two, one != None, len({one, two, one}))
del two
rospy.sleep(0.5)
print(len(client.manager.statuses))
generator = actionlib.goal_id_generator.GoalIDGenerator()
print([generator.generate_ID().id.split("-")[:2] for _ in range(2)])
"""
    assert talk(tmp_path, client, server=SERVER).printed["client"] == [
        "[['/client', '1'], ['/client', '2']] False True 2",
        "1",
        "[['/client', '1'], ['/client', '2']]",
    ]


def test_statuses_five_times_a_second_and_for_five_seconds(tmp_path: Path) -> None:
    client = """
from actionlib_msgs.msg import GoalStatusArray
client = ActionClient("jobs", TestAction)
client.wait_for_server()
lengths = []
rospy.Subscriber("jobs/status", GoalStatusArray, lambda message: lengths.append(len(message.status_list)))
handle = client.send_goal(TestGoal(1))
rospy.sleep(2)
before = len(lengths)
rospy.sleep(2)
print(len(lengths) - before, lengths[-1])
rospy.sleep(2)
print(lengths[-1])
"""
    assert talk(tmp_path, client, server=SERVER).printed["client"] == ["10 1", "0"]

"""Servers and clients of actions, with the results that rclpy 9.1 has."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.rclpy_shim import programs

pytestmark = pytest.mark.slow
HEAD = """
import threading
from action_msgs.msg import GoalStatus
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
try:
    from example_interfaces.action import Fibonacci
except ImportError:
    from test_msgs.action import Fibonacci
n = rclpy.create_node("n")
def execute(handle):
    sequence = [0, 1]
    for turn in range(1, handle.request.order):
        if handle.is_cancel_requested:
            handle.canceled()
            return Fibonacci.Result(sequence=sequence)
        sequence.append(sequence[-1] + sequence[-2])
        handle.publish_feedback(Fibonacci.Feedback(sequence=sequence))
        time.sleep(0.2)
    handle.succeed()
    return Fibonacci.Result(sequence=sequence)
def until(future, seconds=3.0):
    rclpy.spin_until_future_complete(n, future, executor, timeout_sec=seconds)
    return future.result()
executor = MultiThreadedExecutor(4)
"""


def printed(body: str, folder: Path) -> list[str]:
    """Return the lines that a program with the functions of `HEAD` prints."""
    return programs.printed(HEAD + body, folder, seconds=8.0)


def test_goal_gives_feedback_and_a_result(tmp_path: Path) -> None:
    lines = printed(
        """
server = ActionServer(n, Fibonacci, "fibonacci", execute, callback_group=ReentrantCallbackGroup())
client = ActionClient(n, Fibonacci, "fibonacci")
print(client.wait_for_server(timeout_sec=2.0), client.server_is_ready())
show = lambda message: print(list(message.feedback.sequence))
handle = until(client.send_goal_async(Fibonacci.Goal(order=4), feedback_callback=show))
response = until(handle.get_result_async())
print(handle.accepted, handle.stamp.sec > 0)
print(response.status == GoalStatus.STATUS_SUCCEEDED, list(response.result.sequence))
until(rclpy.task.Future(), 0.3)
print(handle.status)
again = until(handle.get_result_async())
print(again.status)
""",
        tmp_path,
    )
    assert lines == [
        "True True",
        "[0, 1, 1]",
        "[0, 1, 1, 2]",
        "[0, 1, 1, 2, 3]",
        "True True",
        "True [0, 1, 1, 2, 3]",
        "4",
        "4",
    ]


def test_goals_are_rejected_and_cancelled_by_the_callbacks(tmp_path: Path) -> None:
    lines = printed(
        """
group = ReentrantCallbackGroup()
accepts = lambda goal: GoalResponse.ACCEPT if goal.order < 20 else GoalResponse.REJECT
cancels = lambda handle: CancelResponse.ACCEPT if handle.request.order < 10 else CancelResponse.REJECT
server = ActionServer(n, Fibonacci, "f", execute, callback_group=group, goal_callback=accepts, cancel_callback=cancels)
client = ActionClient(n, Fibonacci, "f", callback_group=group)
client.wait_for_server()
print(until(client.send_goal_async(Fibonacci.Goal(order=20))).accepted)
slow = until(client.send_goal_async(Fibonacci.Goal(order=11)))
quick = until(client.send_goal_async(Fibonacci.Goal(order=9)))
until(rclpy.task.Future(), 0.5)
response = until(slow.cancel_goal_async())
print(response.return_code, len(response.goals_canceling))
response = until(quick.cancel_goal_async())
print(response.return_code, len(response.goals_canceling))
result = until(quick.get_result_async())
print(result.status == GoalStatus.STATUS_CANCELED, len(result.result.sequence) < 9)
response = until(quick.cancel_goal_async())
print(response.return_code, len(response.goals_canceling))
print(until(slow.get_result_async(), 4.0).status)
""",
        tmp_path,
    )
    assert lines == ["False", "0 0", "0 1", "True True", "3 0", "4"]


def test_failures_of_goals_are_told(tmp_path: Path) -> None:
    lines = printed(
        """
def fail(handle):
    if handle.request.order == 1:
        raise ValueError("wrong")
    if handle.request.order == 2:
        return Fibonacci.Result(sequence=[7])
    if handle.request.order == 3:
        handle.abort()
        attempt(handle.succeed)
    return Fibonacci.Result()
server = ActionServer(n, Fibonacci, "f", fail)
client = ActionClient(n, Fibonacci, "f")
client.wait_for_server()
for order in (1, 2, 3):
    handle = until(client.send_goal_async(Fibonacci.Goal(order=order)))
    response = until(handle.get_result_async())
    print(order, response.status, list(response.result.sequence))
attempt(client.send_goal_async, Fibonacci.Result())
attempt(ActionServer, n, Fibonacci, "g", None)
server.register_goal_callback(lambda goal: True)
print(until(client.send_goal_async(Fibonacci.Goal())).accepted)
from unique_identifier_msgs.msg import UUID
handle.goal_id.uuid[0] ^= 1
print(until(handle.get_result_async()).status, until(handle.cancel_goal_async()).return_code)
lonely = ActionClient(n, Fibonacci, "lonely")
print(lonely.wait_for_server(timeout_sec=0.3))
""",
        tmp_path,
    )
    shown = [line for line in lines if not line.startswith((" ", "[", "Traceback"))]
    assert [line.partition(" attempted")[0].partition(" (<")[0] for line in shown if line != "ValueError: wrong"] == [
        "1 6 []",
        "2 6 [7]",
        "RCLError | Failed to update goal state: goal_handle",
        "3 6 []",
        "TypeError | Expected goal type",
        "TypeError | Failed to register goal execution callback: not callable",
        "False",
        "0 2",
        "False",
    ]


def test_result_is_forgotten_after_its_time(tmp_path: Path) -> None:
    lines = printed(
        """
server = ActionServer(n, Fibonacci, "f", execute, result_timeout=1)
client = ActionClient(n, Fibonacci, "f")
client.wait_for_server()
handle = until(client.send_goal_async(Fibonacci.Goal(order=1)))
print(until(handle.get_result_async()).status)
until(rclpy.task.Future(), 0.5)
print(until(handle.get_result_async()).status)
until(rclpy.task.Future(), 1.0)
print(until(handle.get_result_async()).status)
""",
        tmp_path,
    )
    assert [line for line in lines if not line.startswith("[")] == ["4", "4", "0"]


def test_goals_wait_until_the_program_executes_them(tmp_path: Path) -> None:
    lines = printed(
        """
waiting = []
server = ActionServer(n, Fibonacci, "f", execute, handle_accepted_callback=waiting.append)
client = ActionClient(n, Fibonacci, "f")
client.wait_for_server()
handles = [until(client.send_goal_async(Fibonacci.Goal(order=order))) for order in (1, 2)]
until(rclpy.task.Future(), 0.2)
print([each.status for each in waiting], [each.status for each in handles], [each.is_active for each in waiting])
waiting[1].execute()
print(until(handles[1].get_result_async()).status, waiting[0].status)
client.destroy()
server.destroy()
print(waiting[0].is_active, waiting[0].status, list(n.waitables))
""",
        tmp_path,
    )
    assert lines == ["[1, 1] [1, 1] [True, True]", "4 1", "False 0 []"]

"""Executors and callback groups, with the results that rclpy 9.1 has."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.rclpy_shim.programs import printed

pytestmark = pytest.mark.slow


def test_groups_decide_which_callbacks_run_side_by_side(tmp_path: Path) -> None:
    lines = printed(
        """
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
n = rclpy.create_node("n")
def work(name):
    print("begin", name)
    time.sleep(0.3)
    print("end", name)
def run(one, other):
    timers = [n.create_timer(0.1, lambda: (timers[0].cancel(), work("a")), one)]
    timers.append(n.create_timer(0.2, lambda: (timers[1].cancel(), work("b")), other))
    executor = MultiThreadedExecutor(3)
    executor.add_node(n)
    executor.create_task(time.sleep, 0.9)
    end = time.time() + 1.0
    while time.time() < end:
        executor.spin_once(timeout_sec=0.1)
    print("--")
    executor.remove_node(n)
    executor.shutdown()
one = MutuallyExclusiveCallbackGroup()
run(one, one)
run(one, MutuallyExclusiveCallbackGroup())
both = ReentrantCallbackGroup()
run(both, both)
""",
        tmp_path,
        seconds=6.0,
    )
    exclusive = ["begin a", "end a", "begin b", "end b", "--"]
    overlapping = ["begin a", "begin b", "end a", "end b", "--"]
    assert lines == [*exclusive, *overlapping, *overlapping]


def test_threads_raise_an_exception_of_a_callback_in_a_later_turn(tmp_path: Path) -> None:
    lines = printed(
        """
from rclpy.executors import MultiThreadedExecutor
n = rclpy.create_node("n")
executor = MultiThreadedExecutor(2)
executor.add_node(n)
def fail():
    timer.cancel()
    time.sleep(0.1)
    raise ValueError("wrong")
timer = n.create_timer(0.1, fail)
other = n.create_timer(0.3, lambda: print("other"))
attempt(executor.spin_once)
print("raised nothing yet")
attempt(executor.spin_once)
""",
        tmp_path,
    )
    assert lines[0] == "raised nothing yet"
    assert sorted(lines[1:]) == ["ValueError | wrong", "other"]


def test_call_without_a_group_of_its_own_blocks_all_threads(tmp_path: Path) -> None:
    lines = printed(
        """
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from std_srvs.srv import Trigger
import threading
n = rclpy.create_node("n")
n.create_service(Trigger, "s", lambda request, response: response)
def run(**options):
    client = n.create_client(Trigger, "s", **options)
    client.wait_for_service()
    def call():
        timer.cancel()
        attempt(lambda: print(client.call(Trigger.Request(), timeout_sec=0.5)))
    timer = n.create_timer(0.1, call)
    executor = MultiThreadedExecutor(2)
    executor.add_node(n)
    end = time.time() + 1.0
    while time.time() < end:
        executor.spin_once(timeout_sec=0.1)
    executor.remove_node(n)
run()
run(callback_group=ReentrantCallbackGroup())
""",
        tmp_path,
        seconds=5.0,
    )
    assert lines == ["TimeoutError | "] * 2


def test_coroutine_goes_on_in_the_next_round(tmp_path: Path) -> None:
    lines = printed(
        """
from rclpy.executors import SingleThreadedExecutor
from rclpy.task import Future
n = rclpy.create_node("n")
executor = SingleThreadedExecutor()
executor.add_node(n)
future = Future()
async def wait():
    print("waits")
    print("got", await future)
    return 7
task = executor.create_task(wait)
executor.spin_once(timeout_sec=0.1)
start = time.time()
executor.spin_once(timeout_sec=0.1)
print(time.time() - start < 0.05, task.done())
n.create_timer(0.1, lambda: future.set_result(3))
start = time.time()
executor.spin_until_future_complete(task, timeout_sec=1.0)
print(time.time() - start < 0.5, task.result())
gone = Future()
gone.cancel()
print(gone.done(), gone.cancelled(), gone.result())
""",
        tmp_path,
    )
    assert lines == ["waits", "True False", "got 3", "True 7", "False True None"]


def test_result_of_another_thread_does_not_wake_the_executor(tmp_path: Path) -> None:
    lines = printed(
        """
import threading
from rclpy.executors import SingleThreadedExecutor
from rclpy.task import Future
n = rclpy.create_node("n")
executor = SingleThreadedExecutor()
executor.add_node(n)
future = Future()
async def wait():
    await future
    print("went on after", round(time.time() - start, 1))
executor.create_task(wait)
start = time.time()
n.create_timer(1.5, lambda: None)
threading.Timer(0.3, future.set_result, [None]).start()
end = start + 1.6
while time.time() < end:
    executor.spin_once()
""",
        tmp_path,
        seconds=4.0,
    )
    assert lines == ["went on after 1.5"]


def test_turn_without_time_alternates_between_work_and_nothing(tmp_path: Path) -> None:
    lines = printed(
        """
from rclpy.executors import SingleThreadedExecutor
n = rclpy.create_node("n")
executor = SingleThreadedExecutor()
executor.add_node(n)
for name in "ab":
    n.create_guard_condition(lambda name=name: print(name)).trigger()
time.sleep(0.1)
for turn in range(4):
    executor.spin_once(timeout_sec=0)
    print(turn)
""",
        tmp_path,
    )
    assert lines == ["a", "0", "b", "1", "2", "3"]


def test_message_is_waited_for_without_an_executor(tmp_path: Path) -> None:
    lines = printed(
        """
import threading
from rclpy.wait_for_message import wait_for_message
n = rclpy.create_node("n")
pub = n.create_publisher(String, "a", 1)
start = time.time()
print(wait_for_message(String, n, "a", time_to_wait=0.3), round(time.time() - start, 1))
threading.Timer(0.3, pub.publish, [String(data="x")]).start()
print(wait_for_message(String, n, "a", time_to_wait=2.0), round(time.time() - start, 1))
print(len(list(n.subscriptions)))
""",
        tmp_path,
    )
    assert lines == ["(False, None) 0.3", "(True, std_msgs.msg.String(data='x')) 0.6", "0"]

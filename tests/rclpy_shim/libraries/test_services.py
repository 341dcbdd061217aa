"""Services and clients between ROS 2 programs: ready or not, lost requests, coroutines, errors, parameter services."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.rospy_shim.missions import run_nodes

pytestmark = pytest.mark.slow
SERVER = """
import rclpy
from example_interfaces.srv import AddTwoInts
rclpy.init()
node = rclpy.create_node("server")
def add(request, response):
    response.sum = request.a + request.b
    return response
node.create_service(AddTwoInts, "add", add)
try:
    rclpy.spin(node)
except KeyboardInterrupt:
    pass
"""
HEAD = """
import rclpy, threading
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
rclpy.init()
node = rclpy.create_node("caller")
client = node.create_client(AddTwoInts, "add", callback_group=ReentrantCallbackGroup())
"""


def caller(body: str, folder: Path, *, seconds: float = 3.0, has_server: bool = True) -> list[str]:
    """Return the lines that a caller prints."""
    nodes = {"C": HEAD + body, **({"S": SERVER} if has_server else {})}
    return run_nodes(folder, nodes, seconds=seconds).printed["caller"]


def test_request_without_a_server_is_lost(tmp_path: Path) -> None:
    body = """
future = client.call_async(AddTwoInts.Request(a=1, b=2))
print(client.wait_for_service(timeout_sec=1.0))
rclpy.spin_until_future_complete(node, future, timeout_sec=1.0)
print(future.done())
"""
    assert caller(body, tmp_path) == ["True", "False"]
    assert caller(body, tmp_path, has_server=False) == ["False", "False"]


def test_callback_of_a_future_gets_the_response(tmp_path: Path) -> None:
    body = """
client.wait_for_service()
future = client.call_async(AddTwoInts.Request(a=1, b=2))
future.add_done_callback(lambda done: print("sum", done.result().sum))
rclpy.spin_until_future_complete(node, future)
print("done")
for turn in range(3):
    rclpy.spin_once(node, timeout_sec=0.1)
"""
    assert caller(body, tmp_path) == ["done", "sum 3"]


def test_coroutine_of_a_timer_awaits_a_response(tmp_path: Path) -> None:
    body = """
client.wait_for_service()
async def call():
    timer.cancel()
    response = await client.call_async(AddTwoInts.Request(a=2, b=3))
    print("sum", response.sum)
    done.append(True)
done = []
timer = node.create_timer(0.1, call)
while not done:
    rclpy.spin_once(node, timeout_sec=0.2)
"""
    assert caller(body, tmp_path) == ["sum 5"]


def test_call_waits_while_another_thread_spins(tmp_path: Path) -> None:
    body = """
client.wait_for_service()
threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start()
print(client.call(AddTwoInts.Request(a=3, b=4)).sum)
"""
    assert caller(body, tmp_path) == ["7"]


def test_call_in_the_spinning_thread_never_ends_and_times_out_if_asked(tmp_path: Path) -> None:
    body = """
client.wait_for_service()
try:
    client.call(AddTwoInts.Request(), timeout_sec=0.5)
except TimeoutError:
    print("late")
client.call(AddTwoInts.Request())
print("never")
"""
    assert "never" not in caller(body, tmp_path)


def test_wrong_request_is_refused(tmp_path: Path) -> None:
    body = """
client.wait_for_service()
for request in (AddTwoInts.Response(), AddTwoInts.Request(a="x")):
    try:
        client.call_async(request)
    except (TypeError, AssertionError) as error:
        print(type(error).__name__)
"""
    assert caller(body, tmp_path) == ["TypeError", "AssertionError"]


def test_error_of_a_callback_ends_the_server(tmp_path: Path) -> None:
    server = """
import rclpy
from std_srvs.srv import Trigger
rclpy.init()
node = rclpy.create_node("server")
def fail(request, response):
    raise RuntimeError("stuck")
node.create_service(Trigger, "fail", fail)
rclpy.spin(node)
"""
    client = """
import rclpy
from std_srvs.srv import Trigger
rclpy.init()
node = rclpy.create_node("client")
client = node.create_client(Trigger, "fail")
client.wait_for_service()
future = client.call_async(Trigger.Request())
rclpy.spin_until_future_complete(node, future, timeout_sec=1.0)
print(future.done(), client.service_is_ready())
"""
    run = run_nodes(tmp_path, {"S": server, "C": client})
    assert run.printed["server"][-1] == "RuntimeError: stuck"
    assert run.printed["client"] == ["False False"]


def test_parameters_are_read_and_set_by_services(tmp_path: Path) -> None:
    owner = """
import rclpy
from rclpy.parameter import Parameter
rclpy.init()
node = rclpy.create_node("owner")
node.declare_parameter("speed", 1.5)
node.add_post_set_parameters_callback(lambda changed: print([(each.name, each.value) for each in changed]))
try:
    rclpy.spin(node)
except KeyboardInterrupt:
    pass
"""
    client = """
import rclpy
from rcl_interfaces.srv import GetParameters, ListParameters, SetParameters
from rclpy.parameter import Parameter
rclpy.init()
node = rclpy.create_node("caller")
def call(kind, name, **fields):
    client = node.create_client(kind, "/owner/" + name)
    client.wait_for_service()
    future = client.call_async(kind.Request(**fields))
    rclpy.spin_until_future_complete(node, future)
    return future.result()
print(call(GetParameters, "get_parameters", names=["speed"]).values[0].double_value)
wanted = [Parameter("speed", value=2.5).to_parameter_msg(), Parameter("other", value=1).to_parameter_msg()]
print([(each.successful, each.reason) for each in call(SetParameters, "set_parameters", parameters=wanted).results])
print(call(ListParameters, "list_parameters").result.names)
"""
    run = run_nodes(tmp_path, {"O": owner, "C": client})
    assert run.printed["caller"] == [
        "1.5",
        "[(True, ''), (False, 'Invalid access to undeclared parameter(s): []')]",
        "['use_sim_time', 'speed']",
    ]
    assert run.printed["owner"] == ["[('speed', 2.5)]"]


def test_answer_before_the_call_returns_completes_the_future(tmp_path: Path) -> None:
    both = """
import rclpy, threading, time
from std_srvs.srv import Trigger
from rclpy.executors import SingleThreadedExecutor
rclpy.init()
node, server = rclpy.create_node("caller"), rclpy.create_node("server")
server.create_service(Trigger, "s", lambda request, response: response)
client = node.create_client(Trigger, "s")
for each in (node, server):
    executor = SingleThreadedExecutor()
    executor.add_node(each)
    threading.Thread(target=executor.spin, daemon=True).start()
client.wait_for_service()
futures = [client.call_async(Trigger.Request()) for turn in range(5)]
time.sleep(0.5)
print([each.done() for each in futures], len(client._pending))
"""
    assert run_nodes(tmp_path, {"A": both}).printed["caller"] == ["[True, True, True, True, True] 0"]

"""rclpy as a program sees it: parameters, names, logging, timers, executors, clocks, the life of a context."""

from __future__ import annotations

from pathlib import Path

import pytest

from rospy_shim.types.config import NodeConfig
from tests.rclpy_shim.programs import printed

pytestmark = pytest.mark.slow


def test_parameters_are_declared_read_and_set(tmp_path: Path) -> None:
    lines = printed(
        """
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, SetParametersResult
n = rclpy.create_node("n")
print(n.declare_parameter("a", 1).value, n.get_parameter("a").type_.name, n.has_parameter("b"))
attempt(n.declare_parameter, "a", 2)
attempt(n.get_parameter, "b")
attempt(n.set_parameters, [Parameter("b", value=1)])
print(n.set_parameters([Parameter("a", value=2), Parameter("a", value="x")]))
n.declare_parameter("fixed", "f", ParameterDescriptor(read_only=True))
print(n.set_parameters_atomically([Parameter("fixed", value="g")]).reason)
limits = [FloatingPointRange(from_value=0.0, to_value=1.0, step=0.5)]
n.declare_parameter("share", 0.5, ParameterDescriptor(floating_point_range=limits))
print(n.set_parameters_atomically([Parameter("share", value=2.0)]).reason)
print(n.set_parameters_atomically([Parameter("share", value=0.3)]).reason)
n.declare_parameter("typed", Parameter.Type.INTEGER)
attempt(n.get_parameter, "typed")
n.add_on_set_parameters_callback(lambda given: SetParametersResult(successful=given[0].value != 13, reason="unlucky"))
print(n.set_parameters([Parameter("a", value=13)])[0].reason, n.get_parameter("a").value)
attempt(n.declare_parameter, "c", 13)
n.declare_parameters("deep", [("x", 1), ("y", 2.0)])
print({name: each.value for name, each in n.get_parameters_by_prefix("deep").items()})
n.undeclare_parameter("a")
print(n.has_parameter("a"), n.get_parameter_or("a", Parameter("a", value=7)).value)
attempt(Parameter, "z", Parameter.Type.INTEGER, "x")
print(n.set_parameters_atomically([Parameter("use_sim_time", value=True)]).reason[:46])
""",
        tmp_path,
    )
    ok = "rcl_interfaces.msg.SetParametersResult(successful=True, reason='')"
    wrong = "Wrong parameter type, expected '2' got '4'"
    assert lines == [
        "1 INTEGER False",
        "ParameterAlreadyDeclaredException | Parameter(s) already declared: ['a']",
        "ParameterNotDeclaredException | Invalid access to undeclared parameter(s): b",
        "ParameterNotDeclaredException | Invalid access to undeclared parameter(s): []",
        f'[{ok}, rcl_interfaces.msg.SetParametersResult(successful=False, reason="{wrong}")]',
        "Trying to set a read-only parameter: fixed.",
        "Parameter share out of range Min: 0.0, Max: 1.0, value: 2.0",
        "The parameter value for share is not close enough to a valid step. Min: 0.0, max: 1.0, value: 0.3, step: 0.5",
        "ParameterUninitializedException | The parameter 'typed' is not initialized: typed",
        "unlucky 2",
        "InvalidParameterValueException | Invalid parameter value (13) for parameter. Reason: unlucky: c",
        "{'x': 1, 'y': 2.0}",
        "False 7",
        "ValueError | Type '2' and value 'x' do not agree",
        "cfepy does not have simulated time on /clock f",
    ]


def test_command_line_gives_names_remappings_and_parameters(tmp_path: Path) -> None:
    (tmp_path / "params.yaml").write_text(
        "/**:\n  ros__parameters:\n    a: 1\n    deep: {b: [1.5, 2.5]}\n/ns/renamed:\n  ros__parameters: {c: x}\n"
        "other:\n  ros__parameters: {a: 5}\n",
        encoding="utf-8",
    )
    config = NodeConfig(
        "A",
        args=("own", "--ros-args", "--params-file", "params.yaml", "-p", "d:=true", "--log-level", "warn", "--"),
        name="renamed",
        namespace="/ns",
        remap={"topic": "other"},
        params={"e": {"f": "text"}},
        cwd=tmp_path,
    )
    lines = printed(
        """
import sys
from rclpy.utilities import remove_ros_args
n = rclpy.create_node("n")
print(n.get_name(), n.get_namespace(), n.get_fully_qualified_name(), n.get_logger().name)
print(n.resolve_topic_name("topic"), n.resolve_topic_name("~/x"), n.resolve_topic_name("/y"))
print(n.resolve_topic_name("topic", only_expand=True), n.resolve_service_name("{node}/z"))
for name, default in (("a", 0), ("deep.b", [0.0]), ("c", ""), ("d", False), ("e.f", "")):
    print(name, n.declare_parameter(name, default).value)
attempt(n.declare_parameter, "a2", 1)
print(remove_ros_args(sys.argv)[1:])
n.get_logger().info("hidden")
n.get_logger().warn("shown")
""",
        tmp_path,
        config,
    )
    assert lines[:-1] == [
        "renamed /ns /ns/renamed ns.renamed",
        "/ns/other /ns/renamed/x /y",
        "/ns/topic /ns/renamed/z",
        "a 1",
        "deep.b [1.5, 2.5]",
        "c x",
        "d True",
        "e.f text",
        "['own']",
    ]
    assert lines[-1].endswith("[ns.renamed]: shown")


def test_wrong_names_are_refused(tmp_path: Path) -> None:
    lines = printed(
        """
attempt(rclpy.create_node, "a b")
attempt(rclpy.create_node, "1a")
attempt(rclpy.create_node, "a", namespace="b c")
n = rclpy.create_node("n")
for name in ("", "a b", "/a//b", "a/", "1a", "a~", "~a"):
    attempt(n.create_publisher, String, name, 1)
attempt(n.create_client, String, "a")
attempt(rclpy.create_node, "x", enable_logger_service=True)
""",
        tmp_path,
    )
    assert [line.partition(" | ")[0] for line in lines] == [
        "InvalidNodeNameException",
        "InvalidNodeNameException",
        "InvalidNamespaceException",
        *["InvalidTopicNameException"] * 6,
        "RuntimeError",
        "NotImplementedError",
    ]


def test_log_lines_have_severity_time_and_name(tmp_path: Path) -> None:
    lines = printed(
        """
from rclpy.logging import LoggingSeverity
log = rclpy.create_node("n").get_logger()
log.debug("hidden")
log.set_level(LoggingSeverity.DEBUG)
log.get_child("c").debug("shown")
for turn in range(4):
    log.info(f"once {turn}", once=True)
    log.info(f"throttled {turn}", throttle_duration_sec=0.5)
    log.info(f"skipped {turn}", skip_first=True)
    time.sleep(0.3)
attempt(log.info, "x", unknown=1)
log.fatal("end")
""",
        tmp_path,
    )
    texts = [line.partition("]: ")[2] or line.partition(" | ")[0] for line in lines]
    assert texts == [
        "shown",
        *("once 0", "throttled 0", "skipped 1", "throttled 2", "skipped 2", "skipped 3"),
        "TypeError",
        "end",
    ]
    assert lines[0].startswith("[DEBUG] [")
    assert "[n.c]: " in lines[0]
    assert lines[-1].startswith("[FATAL] [")


def test_timers_and_guard_conditions_call_in_time(tmp_path: Path) -> None:
    lines = printed(
        """
n = rclpy.create_node("n")
from rclpy.timer import TimerInfo
start = n.get_clock().now()
def tick():
    since = n.get_clock().now() - start
    print("tick", round(since.nanoseconds / 1e9, 2))
    if since.nanoseconds > 0.25e9:
        timer.cancel()
        guard.trigger()
    elif since.nanoseconds < 0.15e9:
        time.sleep(0.12)
timer = n.create_timer(0.1, tick)
guard = n.create_guard_condition(lambda: print("guard", timer.is_canceled()))
def tell(about: TimerInfo):
    print("info", (about.actual_call_time - start).nanoseconds // 10**7)
    info.cancel()
info = n.create_timer(0.35, tell)
late = n.create_timer(0.1, lambda: print("late"), autostart=False)
for turn in range(5):
    rclpy.spin_once(n, timeout_sec=0.5)
print(late.time_until_next_call(), timer.timer_period_ns)
""",
        tmp_path,
    )
    assert lines == [
        *("tick 0.1", "tick 0.22", "tick 0.3", "guard True", "info 35"),
        "None 100000000",
    ]


def test_work_is_done_in_the_order_of_rclpy(tmp_path: Path) -> None:
    lines = printed(
        """
n = rclpy.create_node("n")
pub = n.create_publisher(String, "a", 10)
n.create_subscription(String, "a", lambda message: print("message"), 10)
guard = n.create_guard_condition(lambda: print("guard"))
n.create_timer(0.1, lambda: print("timer"))
guard.trigger()
pub.publish(String())
time.sleep(0.1)
executor = rclpy.get_global_executor()
task = executor.create_task(lambda: print("task"))
for turn in range(4):
    rclpy.spin_once(n, timeout_sec=0.05)
print(task.done())
""",
        tmp_path,
    )
    assert lines == ["task", "timer", "message", "guard", "True"]


def test_rate_sleeps_while_another_thread_spins(tmp_path: Path) -> None:
    lines = printed(
        """
import threading
n = rclpy.create_node("n")
def spin():
    rclpy.spin(n)
    print("ended")
thread = threading.Thread(target=spin)
thread.start()
rate = n.create_rate(10)
start = n.get_clock().now()
for turn in range(3):
    rate.sleep()
print(round((n.get_clock().now() - start).nanoseconds / 1e9, 2))
attempt(n.create_rate, 0)
rclpy.shutdown()
attempt(rate.sleep)
thread.join()
""",
        tmp_path,
    )
    assert sorted(lines) == sorted(
        [
            "0.3",
            "ValueError | frequency must be > 0",
            "ROSInterruptException | rclpy.shutdown() has been called",
            "ended",
        ]
    )


def test_context_lives_from_init_to_shutdown(tmp_path: Path) -> None:
    lines = printed(
        """
attempt(rclpy.init)
print(rclpy.ok())
rclpy.get_default_context().on_shutdown(lambda: print("hook"))
n = rclpy.create_node("n")
rclpy.shutdown()
print(rclpy.ok())
attempt(rclpy.shutdown)
rclpy.try_shutdown()
attempt(rclpy.create_node, "m")
rclpy.init()
print(rclpy.ok())
""",
        tmp_path,
    )
    assert lines == [
        "RuntimeError | Context.init() must only be called once",
        "True",
        "hook",
        "False",
        "RuntimeError | Context must be initialized before it can be shutdown",
        "NotInitializedException | rclpy.init() has not been called. msg:cannot create node",
        "True",
    ]


def test_times_and_durations_compute(tmp_path: Path) -> None:
    lines = printed(
        """
from rclpy.clock import Clock, ClockType
from rclpy.duration import Duration
from rclpy.time import Time
one = Time(seconds=1, nanoseconds=5)
print(one + Duration(seconds=0.5), one - Time(seconds=1), one.seconds_nanoseconds(), one.to_msg())
print(Time.from_msg(one.to_msg()).clock_type.name, Duration(seconds=2) > Duration(seconds=1))
attempt(lambda: one < Time(clock_type=ClockType.STEADY_TIME))
attempt(Time, seconds=-1)
attempt(lambda: one - Duration(seconds=5))
steady = Clock(clock_type=ClockType.STEADY_TIME)
before = steady.now()
print(steady.sleep_for(Duration(seconds=0.25)), (steady.now() - before).nanoseconds // 10**7)
print(type(Clock(clock_type=ClockType.ROS_TIME)).__name__)
attempt(steady.create_jump_callback, None)
""",
        tmp_path,
    )
    assert lines == [
        "Time(nanoseconds=1500000005, clock_type=SYSTEM_TIME) 5 nanoseconds (1, 5)"
        " builtin_interfaces.msg.Time(sec=1, nanosec=5)",
        "ROS_TIME True",
        "TypeError | Can't compare times with different clock types",
        "ValueError | Seconds value must not be negative",
        "ValueError | Subtraction leads to negative time.",
        "True 25",
        "ROSClock",
        "NotImplementedError | cfepy does not have jump callbacks of clocks for nodes of ROS 2 yet",
    ]


def test_missing_parts_are_refused_by_name(tmp_path: Path) -> None:
    lines = printed(
        """
import importlib
for name in ("cv_bridge", "rclpy.serialization", "launch", "rospy", "nothing"):
    attempt(importlib.import_module, name)
""",
        tmp_path,
    )
    assert lines == [
        *(
            f"ModuleNotFoundError | cfepy does not have {name} for nodes of ROS 2 yet; docs/how_to/run_a_ros2_node.md"
            " lists what works"
            for name in ("cv_bridge", "rclpy.serialization", "launch")
        ),
        "ImportError | a program of ROS 2 cannot import rospy; use two nodes, or write `ros: 1` for it in mission.yaml",
        "ModuleNotFoundError | No module named 'nothing'",
    ]


def test_executor_of_the_program_runs_callbacks_in_other_threads(tmp_path: Path) -> None:
    lines = printed(
        """
import threading
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import Executor
class Threads(Executor):
    def spin_once(self, timeout_sec=None):
        handler, entity, node = self.wait_for_ready_callbacks(timeout_sec=timeout_sec)
        threading.Thread(target=handler).start()
n = rclpy.create_node("n")
def work(name):
    print("begin", name)
    time.sleep(0.25)
    print("end", name)
one, other = MutuallyExclusiveCallbackGroup(), MutuallyExclusiveCallbackGroup()
n.create_timer(0.1, lambda: work("a"), one)
n.create_timer(0.1, lambda: work("b"), other)
n.create_guard_condition(lambda: work("c"), one).trigger()
executor = Threads()
executor.add_node(n)
for turn in range(3):
    executor.spin_once()
""",
        tmp_path,
    )
    assert lines[:5] == ["begin c", "begin b", "end c", "begin a", "end b"]

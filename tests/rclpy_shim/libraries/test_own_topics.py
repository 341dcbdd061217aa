"""/rosout and /parameter_events, with the results that rclpy 9.1 has."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.rclpy_shim.programs import HEAD, printed
from tests.rospy_shim.missions import run_nodes

pytestmark = pytest.mark.slow


def test_lines_of_the_log_are_on_rosout(tmp_path: Path) -> None:
    lines = printed(
        """
from rcl_interfaces.msg import Log
from rclpy.qos import QoSProfile, DurabilityPolicy
n = rclpy.create_node("n", namespace="/ns")
n.get_logger().info("early")
def show(m):
    print(m.level, m.name, m.msg, m.function, m.line > 0, m.file[-3:], m.stamp.sec > 0)
n.create_subscription(Log, "/rosout", show, QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL))
quiet = rclpy.create_node("quiet", enable_rosout=False)
def log():
    quiet.get_logger().info("quiet")
    n.get_logger().debug("hidden")
    n.get_logger().warn("late")
    n.get_logger().get_child("c").error("child")
    rclpy.logging.get_logger("other").info("other")
end = time.time() + 1.0
n.create_timer(0.5, log)
while time.time() < end:
    rclpy.spin_once(n, timeout_sec=0.1)
""",
        tmp_path,
    )
    assert [line for line in lines if not line.startswith("[")] == [
        "20 ns.n early <module> True .py True",
        "30 ns.n late log True .py True",
        "40 ns.n.c child log True .py True",
    ]


def test_changes_of_parameters_are_on_parameter_events(tmp_path: Path) -> None:
    lines = printed(
        """
from rcl_interfaces.msg import ParameterEvent
n = rclpy.create_node("n")
names = lambda parameters: [each.name for each in parameters]
def show(m):
    print(m.node, names(m.new_parameters), names(m.changed_parameters), names(m.deleted_parameters), m.stamp.sec > 0)
n.create_subscription(ParameterEvent, "/parameter_events", show, 10)
n.add_post_set_parameters_callback(lambda given: print("set", names(given)))
time.sleep(0.3)
n.declare_parameter("a", 1)
n.set_parameters_atomically([Parameter("a", value=2)])
n.add_on_set_parameters_callback(lambda given: True)
print(n.set_parameters([Parameter("a", value=3)])[0].reason)
n.undeclare_parameter("a")
end = time.time() + 0.5
while time.time() < end:
    rclpy.spin_once(n, timeout_sec=0.1)
print([name for name, _ in n.get_topic_names_and_types()])
""",
        tmp_path,
    )
    assert [line for line in lines if not line.startswith(" ")] == [
        "set ['a']",
        "set ['a']",
        *[line for line in lines if "UserWarning" in line],
        "Callback returned an invalid type",
        "/n ['a'] [] [] True",
        "/n [] ['a'] [] True",
        "['/parameter_events', '/rosout']",
    ]


def test_rosout_of_ros_1_stays_free_in_a_mission_of_both_worlds(tmp_path: Path) -> None:
    nodes = {
        "A": HEAD + 'n = rclpy.create_node("a")\nn.get_logger().info("text")\ntime.sleep(1.0)\n',
        "B": 'import rospy\nrospy.init_node("b")\nrospy.loginfo("other")\nrospy.sleep(0.5)\n',
    }
    run = run_nodes(tmp_path, nodes)
    assert run.topics["/rosout"].type == "rosgraph_msgs/Log"
    assert not [line for line in run.lines if "not connected" in line]

"""tf2_ros of ROS 2. There is no rclpy with tf2 to compare with; texts and rules come from its sources."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.rclpy_shim.programs import HEAD, printed
from tests.rospy_shim.missions import run_nodes

pytestmark = pytest.mark.slow
TF = """
from geometry_msgs.msg import TransformStamped
from rclpy.duration import Duration
from rclpy.time import Time
import tf2_ros
from tf2_ros import Buffer, StaticTransformBroadcaster, TransformBroadcaster, TransformListener
n = rclpy.create_node("n")
buffer = Buffer(node=n)
listener = TransformListener(buffer, n)
def transform(parent, child, x=0.0, at=None):
    made = TransformStamped(child_frame_id=child)
    made.header.frame_id = parent
    made.header.stamp = (n.get_clock().now() if at is None else at).to_msg()
    made.transform.translation.x = x
    return made
def spin(seconds):
    end = time.time() + seconds
    while time.time() < end:
        rclpy.spin_once(n, timeout_sec=0.05)
"""


def test_listener_fills_a_buffer_from_broadcasters(tmp_path: Path) -> None:
    lines = printed(
        TF
        + """
static, moving = StaticTransformBroadcaster(n), TransformBroadcaster(n)
static.sendTransform([transform("map", "odom", 1.0)])
static.sendTransform(transform("base", "laser", 4.0))
count = [0.0]
def send():
    count[0] += 1.0
    moving.sendTransform(transform("odom", "base", count[0]))
n.create_timer(0.1, send)
spin(0.45)
found = buffer.lookup_transform("map", "laser", Time())
print(found.header.frame_id, found.child_frame_id, found.transform.translation.x)
at = Time.from_msg(found.header.stamp) - Duration(seconds=0.05)
print(round(buffer.lookup_transform("map", "base", at).transform.translation.x, 3))
print(round(buffer.lookup_transform_full("base", Time(), "base", at, "map").transform.translation.x, 3))
print(buffer.can_transform("laser", "map", Time()), buffer.can_transform("laser", "moon", Time()))
print(buffer.get_latest_common_time("map", "base").nanoseconds == Time.from_msg(found.header.stamp).nanoseconds)
""",
        tmp_path,
    )
    assert lines == ["map laser 9.0", "4.5", "-0.5", "1 0", "True"]


def test_lookups_that_fail_say_why(tmp_path: Path) -> None:
    lines = printed(
        TF
        + """
for second in (10, 11):
    buffer.set_transform(transform("a", "b", at=Time(seconds=second)), "test")
buffer.set_transform(transform("x", "y", at=Time(seconds=10)), "test")
attempt(buffer.lookup_transform, "a", "moon", Time())
attempt(buffer.lookup_transform, "a", "", Time())
attempt(buffer.lookup_transform, "/a", "b", Time())
attempt(buffer.lookup_transform, "a", "b", Time(seconds=12))
attempt(buffer.lookup_transform, "a", "b", Time(seconds=9))
attempt(buffer.lookup_transform, "a", "y", Time(seconds=10))
attempt(buffer.lookup_transform, "x", "y", Time(seconds=11))
attempt(buffer.lookup_transform, "a", "b", 3.0)
attempt(buffer.transform, transform("a", "b"), "b")
print(buffer.can_transform("a", "moon", Time(), return_debug_tuple=True))
buffer.set_transform(transform("a", "a"), "test")
start = time.time()
attempt(buffer.lookup_transform, "a", "moon", Time(), Duration(seconds=0.5))
print(round(time.time() - start, 1), issubclass(tf2_ros.LookupException, tf2_ros.TransformException))
""",
        tmp_path,
    )
    future = "Lookup would require extrapolation into the"
    looking = "when looking up transform from frame [b] to frame [a]"
    assert lines == [
        'LookupException | "moon" passed to lookupTransform argument source_frame does not exist. ',
        'InvalidArgumentException | Invalid argument "" passed to lookupTransform argument source_frame - in tf2'
        " frame_ids cannot be empty",
        'InvalidArgumentException | Invalid argument "/a" passed to lookupTransform argument target_frame - in tf2'
        " frame_ids cannot start with a '/'",
        f"ExtrapolationException | {future} future.  Requested time 12.000000 but the latest data is at time 11.000000,"
        f" {looking}",
        f"ExtrapolationException | {future} past.  Requested time 9.000000 but the earliest data is at time 10.000000,"
        f" {looking}",
        "ConnectivityException | Could not find a connection between 'a' and 'y' because they are not part of the same"
        " tree.Tf has two or more unconnected trees.",
        "ExtrapolationException | Lookup would require extrapolation at time 11.000000, but only time 10.000000 is in"
        " the buffer, when looking up transform from frame [y] to frame [x]",
        "TypeError | time must have sec and nanosec, or nanoseconds.",
        "TypeException | Type <class 'geometry_msgs.msg._transform_stamped.TransformStamped'> is not loaded or"
        " supported",
        "(0, 'Invalid frame ID \"moon\" passed to canTransform argument source_frame - frame does not exist')",
        *[line for line in lines if "TF_SELF_TRANSFORM" in line],
        'LookupException | "moon" passed to lookupTransform argument source_frame does not exist. ',
        "0.5 True",
    ]


def test_coroutine_waits_for_a_transform(tmp_path: Path) -> None:
    lines = printed(
        TF
        + """
moving = TransformBroadcaster(n)
async def wait():
    found = await buffer.lookup_transform_async("a", "b", Time())
    print("found", found.transform.translation.x, round(time.time() - start, 1))
start = time.time()
rclpy.get_global_executor().create_task(wait)
timer = n.create_timer(0.3, lambda: (timer.cancel(), moving.sendTransform(transform("a", "b", 2.0))))
spin(1.0)
""",
        tmp_path,
    )
    assert lines == ["found 2.0 0.3"]


def test_nodes_of_both_worlds_share_transforms(tmp_path: Path) -> None:
    nodes = {
        "A": "import rospy, tf2_ros\nfrom geometry_msgs.msg import TransformStamped\nrospy.init_node('a')\n"
        "t = TransformStamped()\nt.header.frame_id, t.child_frame_id = 'map', 'base'\n"
        "t.header.stamp = rospy.Time.now()\n"
        "t.transform.rotation.w, t.transform.translation.x = 1.0, 3.0\n"
        "b = tf2_ros.StaticTransformBroadcaster()\nb.sendTransform(t)\nrospy.spin()\n",
        "B": HEAD + TF + 'spin(0.5)\nprint(buffer.lookup_transform("map", "base", Time()).transform.translation.x)\n',
    }
    assert run_nodes(tmp_path, nodes).printed["n"] == ["3.0"]

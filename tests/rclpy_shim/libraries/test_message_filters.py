"""message_filters of ROS 2. It is not among the packages of the real rclpy; its rules come from its sources."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.rclpy_shim.programs import printed

pytestmark = pytest.mark.slow
HEAD = """
from geometry_msgs.msg import PointStamped
from message_filters import ApproximateTimeSynchronizer, Cache, SimpleFilter, Subscriber, TimeSynchronizer
from rclpy.time import Time
n = rclpy.create_node("n")
def at(seconds):
    message = PointStamped()
    message.header.stamp = Time(seconds=seconds).to_msg()
    return message
def stamp(message):
    return message.header.stamp.sec + message.header.stamp.nanosec / 1e9
"""


def test_synchronizers_pass_on_sets(tmp_path: Path) -> None:
    lines = printed(
        HEAD
        + """
pubs = [n.create_publisher(PointStamped, name, 10) for name in "ab"]
subs = [Subscriber(n, PointStamped, name) for name in "ab"]
exact = TimeSynchronizer(subs, 10)
exact.registerCallback(lambda one, other: print("exact", stamp(one), stamp(other)))
near = ApproximateTimeSynchronizer(subs, 10, 0.1)
near.registerCallback(lambda one, other, more: print("near", stamp(one), stamp(other), more), "more")
for number, seconds in ((0, 1.0), (1, 1.05), (0, 2.0), (1, 2.0), (0, 3.0), (1, 3.2)):
    pubs[number].publish(at(seconds))
end = time.time() + 0.5
while time.time() < end:
    rclpy.spin_once(n, timeout_sec=0.05)
print(subs[0].getTopic(), subs[0].topic_name)
""",
        tmp_path,
    )
    assert sorted(lines) == ["a /a", "exact 2.0 2.0", "near 1.0 1.05 more", "near 2.0 2.0 more"]


def test_cache_keeps_the_last_messages(tmp_path: Path) -> None:
    lines = printed(
        HEAD
        + """
from rclpy.clock import ClockType
ros = lambda seconds: Time(seconds=seconds, clock_type=ClockType.ROS_TIME)
source = SimpleFilter()
cache = Cache(source, 3)
for seconds in (1.0, 2.0, 3.0, 4.0):
    source.signalMessage(at(seconds))
source.signalMessage(String())
show = lambda found: print(None if found is None else stamp(found))
print([stamp(each) for each in cache.getInterval(ros(0), ros(3))])
show(cache.getElemAfterTime(ros(2.5)))
show(cache.getElemBeforeTime(ros(2.5)))
show(cache.getElemBeforeTime(ros(1.5)))
show(cache.getLast())
""",
        tmp_path,
    )
    assert [line for line in lines if not line.startswith("[WARN]")] == ["[2.0, 3.0]", "3.0", "2.0", "None", "4.0"]
    assert "can not use message filters messages without timestamp" in "".join(lines)

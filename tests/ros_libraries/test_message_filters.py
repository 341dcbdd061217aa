"""message_filters: caches and synchronizers, ours and the original on the same messages."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.ros_libraries.actions import bring
from tests.rospy_shim.missions import run_nodes

ours_and_the_original = pytest.mark.parametrize("original", ["", "message_filters"])

HEAD = """
import random
import rospy
from message_filters import ApproximateTimeSynchronizer, Cache, SimpleFilter, Subscriber, TimeSynchronizer
from std_msgs.msg import Header, String
from geometry_msgs.msg import PointStamped
rospy.init_node("filters")

def stamped(seconds):
    return PointStamped(header=Header(stamp=rospy.Time.from_sec(seconds)))

def seconds(*messages):
    return [round(message.header.stamp.to_sec(), 3) for message in messages]
"""


def _printed(folder: Path, source: str, original: str) -> list[str]:
    bring(original, folder)
    lines = run_nodes(folder, {"FILTERS": HEAD + source}, seconds=10).printed["filters"]
    return [line.partition("]: ")[2] or line for line in lines]


@ours_and_the_original
def test_cache(tmp_path: Path, original: str) -> None:
    source = """
source = SimpleFilter()
cache = Cache(source, 4)
print(cache.getLast(), cache.getLatestTime(), cache.getOldestTime(), cache.getElemAfterTime(rospy.Time(1)))
cache.registerCallback(lambda message, note: print(note, *seconds(message)), "through")
for number in (1, 2, 4, 3, 5):
    source.signalMessage(stamped(number))
T = rospy.Time
print(seconds(*cache.getInterval(T(2), T(4))), cache.getOldestTime().secs, cache.getLastestTime().secs)
print(seconds(cache.getElemAfterTime(T(3)), cache.getElemBeforeTime(T(4)), cache.getLast()))
print(cache.getElemAfterTime(T(6)), cache.getElemBeforeTime(T(1)))
source.signalMessage(String("no stamp"))
free = Cache(source, 2, allow_headerless=True)
source.signalMessage(String("now"))
print(free.getLast().data, 0 <= (T.now() - free.getLatestTime()).to_sec() < 0.01)
"""
    warning = (
        "Cannot use message filters with non-stamped messages. Use the 'allow_headerless' constructor option to "
        "auto-assign ROS time to headerless messages."
    )
    assert _printed(tmp_path, source, original) == [
        "None None None None",
        "through 1.0",
        "through 2.0",
        "through 4.0",
        "through 3.0",
        "through 5.0",
        "[2.0, 4.0, 3.0] 2 5",
        "[4.0, 3.0, 5.0]",
        "None None",
        warning,
        warning,
        "now True",
    ]


@ours_and_the_original
def test_equal_stamps(tmp_path: Path, original: str) -> None:
    source = """
left, right = SimpleFilter(), SimpleFilter()
both = TimeSynchronizer([left, right], 3)
both.registerCallback(lambda *messages: print(seconds(*messages)))
for number in (1, 2, 3, 4):
    left.signalMessage(stamped(number))
for number in (1, 5, 4, 2, 2):
    right.signalMessage(stamped(number))
left.signalMessage(stamped(5))
print([sorted(stamp.secs for stamp in queue) for queue in both.queues])
"""
    assert _printed(tmp_path, source, original) == ["[4.0, 4.0]", "[2.0, 2.0]", "[5.0, 5.0]", "[[3], [1, 2]]"]


@ours_and_the_original
def test_nearly_equal_stamps(tmp_path: Path, original: str) -> None:
    source = """
left, middle, right = SimpleFilter(), SimpleFilter(), SimpleFilter()
three = ApproximateTimeSynchronizer([left, middle, right], 5, 0.1)
three.registerCallback(lambda *messages: print(seconds(*messages)))
left.signalMessage(stamped(1.0))
left.signalMessage(stamped(1.05))
middle.signalMessage(stamped(1.04))
right.signalMessage(stamped(1.2))
right.signalMessage(stamped(1.06))
middle.signalMessage(stamped(1.21))
left.signalMessage(stamped(1.19))
print([sorted(stamp.to_sec() for stamp in queue) for queue in three.queues])
"""
    assert _printed(tmp_path, source, original) == [
        "[1.05, 1.04, 1.06]",
        "[1.19, 1.21, 1.2]",
        "[[1.0], [], []]",
    ]


RANDOM = """
random.seed(7)
filters = [SimpleFilter() for _ in range(3)]
together = ApproximateTimeSynchronizer(filters, 6, 0.03, allow_headerless=True)
found = []
together.registerCallback(lambda *messages: found.append(seconds(*messages)))
for step in range(600):
    random.choice(filters).signalMessage(stamped(step * 0.01 + random.random() * 0.02))
print(len(found), found)
"""


def test_matches_equal_the_original(tmp_path: Path) -> None:
    results = []
    for original in ("", "message_filters"):
        folder = tmp_path / f"with_{original}"
        folder.mkdir()
        results.append(_printed(folder, RANDOM, original))
    assert results[0] == results[1]
    assert int(results[0][0].split()[0]) > 20


@ours_and_the_original
def test_topics(tmp_path: Path, original: str) -> None:
    source = """
subscribers = [Subscriber(name, PointStamped, queue_size=5) for name in ("left", "right")]
print(subscribers[0].getTopic(), subscribers[1].name, subscribers[0].get_num_connections())
both = TimeSynchronizer(subscribers, 10)
both.registerCallback(lambda left, right: print("both", left.point.x, right.point.x))
publishers = [rospy.Publisher(name, PointStamped, queue_size=1) for name in ("left", "right")]
rospy.sleep(0.2)
for publisher, x in zip(publishers, (1, 2)):
    message = stamped(3)
    message.point.x = x
    publisher.publish(message)
rospy.sleep(0.2)
subscribers[0].unregister()
"""
    assert _printed(tmp_path, source, original) == ["left /right 0", "both 1.0 2.0"]

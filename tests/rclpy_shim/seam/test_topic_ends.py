"""Topics between ROS 2 programs: depth, kept messages, quality of service, several nodes, wrong messages."""

from __future__ import annotations

from pathlib import Path

import pytest

from rclpy_shim.seam.matching import Quality, mismatch
from tests.rospy_shim.missions import run_nodes

HEAD = """
import rclpy, time
from std_msgs.msg import String, Header
from rclpy.qos import QoSProfile, DurabilityPolicy, ReliabilityPolicy, HistoryPolicy
rclpy.init()
"""


def node(body: str) -> str:
    return HEAD + body


def test_quality_matches_if_the_offer_is_as_good_as_the_request() -> None:
    assert mismatch(Quality(), Quality()) is None
    assert mismatch(Quality(is_kept=True), Quality(is_reliable=False)) is None
    assert mismatch(Quality(), Quality(is_kept=True)) == "DURABILITY"
    assert mismatch(Quality(is_reliable=False), Quality()) == "RELIABILITY"


@pytest.mark.slow
def test_subscription_keeps_the_newest_messages_of_its_depth(tmp_path: Path) -> None:
    both = node("""
n = rclpy.create_node("both")
pub = n.create_publisher(String, "a", 10)
heard = []
n.create_subscription(String, "a", lambda message: heard.append(message.data), 3)
for turn in range(5):
    pub.publish(String(data=str(turn)))
for turn in range(6):
    rclpy.spin_once(n, timeout_sec=0.1)
print(heard)
""")
    assert run_nodes(tmp_path, {"A": both}).printed["both"] == ["['2', '3', '4']"]


@pytest.mark.slow
def test_messages_keep_their_order_while_an_executor_wakes(tmp_path: Path) -> None:
    talker = node("""
n = rclpy.create_node("talker")
pub = n.create_publisher(Header, "a", 10)
time.sleep(0.5)
for turn in range(5):
    pub.publish(Header(frame_id=str(turn)))
""")
    listener = node("""
n = rclpy.create_node("listener")
n.create_subscription(Header, "a", lambda message: print(message.frame_id), 10)
for turn in range(6):
    rclpy.spin_once(n, timeout_sec=1.0)
""")
    assert run_nodes(tmp_path, {"L": listener, "T": talker}).printed["listener"] == ["0", "1", "2", "3", "4"]


@pytest.mark.slow
def test_late_subscription_gets_kept_messages(tmp_path: Path) -> None:
    both = node("""
n = rclpy.create_node("both")
kept = QoSProfile(depth=2, durability=DurabilityPolicy.TRANSIENT_LOCAL)
pub = n.create_publisher(String, "a", kept)
for turn in range(3):
    pub.publish(String(data=str(turn)))
n.create_subscription(String, "a", lambda message: print("late", message.data), kept)
n.create_subscription(String, "a", lambda message: print("volatile", message.data), 10)
for turn in range(4):
    rclpy.spin_once(n, timeout_sec=0.1)
""")
    assert run_nodes(tmp_path, {"A": both}).printed["both"] == ["late 1", "late 2"]


@pytest.mark.slow
def test_unequal_qualities_do_not_meet_and_warn(tmp_path: Path) -> None:
    talker = node("""
n = rclpy.create_node("talker")
pub = n.create_publisher(String, "a", QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT))
time.sleep(0.5)
pub.publish(String(data="x"))
print(pub.get_subscription_count())
rclpy.spin_once(n, timeout_sec=0.1)
""")
    listener = node("""
n = rclpy.create_node("listener")
n.create_subscription(String, "a", print, 10)
rclpy.spin_once(n, timeout_sec=1.0)
""")
    printed = run_nodes(tmp_path, {"L": listener, "T": talker}).printed
    assert printed["talker"][0] == "0"
    assert printed["talker"][1].endswith(
        "[talker]: New subscription discovered on topic 'a', requesting incompatible QoS. No messages will be sent to"
        " it. Last incompatible policy: RELIABILITY"
    )
    assert len(printed["listener"]) == 1
    assert "offering incompatible QoS" in printed["listener"][0]


@pytest.mark.slow
def test_long_message_arrives_whole(tmp_path: Path) -> None:
    both = node("""
from std_msgs.msg import UInt8MultiArray
n = rclpy.create_node("both")
pub = n.create_publisher(UInt8MultiArray, "a", 10)
n.create_subscription(UInt8MultiArray, "a", lambda message, info: print(len(message.data), sorted(info)), 1)
pub.publish(UInt8MultiArray(data=bytes(200_000)))
rclpy.spin_once(n, timeout_sec=0.1)
""")
    printed = run_nodes(tmp_path, {"A": both}).printed["both"]
    assert printed == ["200000 ['received_timestamp', 'source_timestamp']"]


@pytest.mark.slow
def test_wrong_messages_and_options_are_refused(tmp_path: Path) -> None:
    wrong = node("""
from rclpy.duration import Duration
from std_msgs.msg import Int8
n = rclpy.create_node("wrong")
pub = n.create_publisher(String, "a", 10)
def attempt(function, *args, **options):
    try:
        function(*args, **options)
    except Exception as error:
        print(type(error).__name__, str(error).split(".")[0])
attempt(pub.publish, "text")
attempt(pub.publish, String(data=3))
attempt(n.create_publisher, str, "a", 10)
attempt(n.create_publisher, String, "a b", 10)
attempt(n.create_subscription, String, "a", print, 10, raw=True)
attempt(n.create_subscription, String, "a", lambda: None, 10)
attempt(n.create_subscription, String, "a", print, -1)
""")
    printed = run_nodes(tmp_path, {"A": wrong}).printed["wrong"]
    assert [line.split(" ", 1)[0] for line in printed if line[0] not in " "] == [
        "TypeError",
        "AssertionError",
        "AttributeError",
        "InvalidTopicNameException",
        "NotImplementedError",
        "RuntimeError",
        "ValueError",
    ]


@pytest.mark.slow
def test_programs_of_one_name_live_side_by_side(tmp_path: Path) -> None:
    listener = node("""
n = rclpy.create_node("same")
n.create_subscription(String, "a", lambda message: print(message.data), 10)
rclpy.spin_once(n, timeout_sec=2.0)
""")
    talker = node("""
n = rclpy.create_node("talker")
pub = n.create_publisher(String, "a", 10)
time.sleep(0.5)
pub.publish(String(data="x"))
""")
    run = run_nodes(tmp_path, {"A": listener, "B": listener, "T": talker})
    assert run.printed["same"] == ["x", "x"]

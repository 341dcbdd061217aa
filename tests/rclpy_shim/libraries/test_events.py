"""Events of publishers and subscriptions, with the results that rclpy 9.1 has."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.rclpy_shim import programs

pytestmark = pytest.mark.slow
HEAD = """
from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.qos import DurabilityPolicy, LivelinessPolicy, QoSProfile, ReliabilityPolicy
n = rclpy.create_node("n")
def show(name):
    def tell(info):
        names = [each for each in dir(info) if not each.startswith("_")]
        print(name, " ".join(f"{each}={getattr(info, each)}" for each in names))
    return tell
def spin(seconds):
    end = time.time() + seconds
    while time.time() < end:
        rclpy.spin_once(n, timeout_sec=0.02)
"""


def printed(body: str, folder: Path) -> list[str]:
    """Return the lines that a program with the functions of `HEAD` prints."""
    return programs.printed(HEAD + body, folder, seconds=8.0)


def test_matches_are_counted_on_both_sides(tmp_path: Path) -> None:
    lines = printed(
        """
about = PublisherEventCallbacks(matched=show("pub"))
pub = n.create_publisher(String, "a", 10, event_callbacks=about)
spin(0.3)
one = n.create_subscription(String, "a", print, 10, event_callbacks=SubscriptionEventCallbacks(matched=show("sub")))
spin(0.3)
other = n.create_subscription(String, "a", print, 10)
spin(0.3)
n.destroy_subscription(other)
spin(0.3)
n.destroy_publisher(pub)
spin(0.3)
""",
        tmp_path,
    )
    assert sorted(lines[:2]) == [
        "pub current_count=1 current_count_change=1 total_count=1 total_count_change=1",
        "sub current_count=1 current_count_change=1 total_count=1 total_count_change=1",
    ]
    assert lines[2:] == [
        "pub current_count=2 current_count_change=1 total_count=2 total_count_change=1",
        "pub current_count=1 current_count_change=-1 total_count=2 total_count_change=0",
        "sub current_count=0 current_count_change=-1 total_count=1 total_count_change=0",
    ]


def test_incompatible_qualities_are_events_with_a_usual_warning(tmp_path: Path) -> None:
    lines = printed(
        """
loose = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
about = PublisherEventCallbacks(incompatible_qos=show("pub"))
pub = n.create_publisher(String, "a", loose, event_callbacks=about)
sub = n.create_subscription(String, "a", print, 10)
quiet = n.create_subscription(
    String, "a", print, 10, event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False)
)
time.sleep(0.3)
print("spins")
spin(0.3)
print(pub.get_subscription_count())
late = QoSProfile(depth=1, deadline=Duration(seconds=2))
soon = QoSProfile(depth=1, deadline=Duration(seconds=1))
n.create_publisher(String, "b", late, event_callbacks=PublisherEventCallbacks(incompatible_qos=show("b")))
n.create_subscription(String, "b", print, soon)
manual = QoSProfile(
    depth=1, liveliness=LivelinessPolicy.MANUAL_BY_TOPIC, liveliness_lease_duration=Duration(seconds=1)
)
n.create_publisher(String, "c", 1, event_callbacks=PublisherEventCallbacks(incompatible_qos=show("c")))
n.create_subscription(String, "c", print, manual)
spin(0.3)
""",
        tmp_path,
    )
    own = [line for line in lines if not line.startswith("[")]
    assert own[0] == "spins"
    assert own[1].startswith("pub last_policy_kind=")
    assert own[2] == "0"
    assert [line.partition(" ")[0] for line in own[3:]] == ["b", "c"]
    warnings = [line.partition("]: ")[2] for line in lines if line.startswith("[")]
    offering = "offering incompatible QoS. No messages will be received from it. Last incompatible policy:"
    assert sorted(warnings) == [
        f"New publisher discovered on topic 'a', {offering} RELIABILITY",
        f"New publisher discovered on topic 'b', {offering} DEADLINE",
        f"New publisher discovered on topic 'c', {offering} LIVELINESS",
    ]


def test_missed_deadlines_are_counted(tmp_path: Path) -> None:
    lines = printed(
        """
soon = QoSProfile(depth=10, deadline=Duration(seconds=0.2))
pub = n.create_publisher(String, "a", soon, event_callbacks=PublisherEventCallbacks(deadline=show("pub")))
sub = n.create_subscription(
    String, "a", lambda m: print("got"), soon, event_callbacks=SubscriptionEventCallbacks(deadline=show("sub"))
)
spin(0.5)
print("sends")
pub.publish(String())
spin(0.5)
pub.publish(String())
spin(0.1)
""",
        tmp_path,
    )
    assert lines[:2] == ["sends", "got"]
    expected = [f"{side} total_count={n} total_count_change=1" for n in (1, 2) for side in ("pub", "sub")]
    assert sorted(lines[2:6]) == sorted(expected)
    assert lines[6:] == ["got"]


def test_liveliness_follows_the_assertions_of_a_publisher(tmp_path: Path) -> None:
    lines = printed(
        """
alive = QoSProfile(
    depth=10, liveliness=LivelinessPolicy.MANUAL_BY_TOPIC, liveliness_lease_duration=Duration(seconds=0.3)
)
sub = n.create_subscription(
    String, "a", print, alive, event_callbacks=SubscriptionEventCallbacks(liveliness=show("sub"))
)
pub = n.create_publisher(String, "a", alive, event_callbacks=PublisherEventCallbacks(liveliness=show("pub")))
spin(0.1)
print("asserts")
pub.assert_liveliness()
spin(0.2)
pub.assert_liveliness()
spin(0.2)
print("stops")
spin(0.5)
pub.assert_liveliness()
spin(0.1)
n.destroy_publisher(pub)
spin(0.2)
""",
        tmp_path,
    )
    assert lines == [
        "asserts",
        "sub alive_count=1 alive_count_change=1 not_alive_count=0 not_alive_count_change=0",
        "stops",
        *sorted(lines[3:5], reverse=True),
        "sub alive_count=1 alive_count_change=1 not_alive_count=0 not_alive_count_change=-1",
        "sub alive_count=0 alive_count_change=-1 not_alive_count=0 not_alive_count_change=0",
    ]
    assert sorted(lines[3:5]) == [
        "pub total_count=1 total_count_change=1",
        "sub alive_count=0 alive_count_change=-1 not_alive_count=1 not_alive_count_change=1",
    ]


def test_expired_messages_are_not_delivered(tmp_path: Path) -> None:
    lines = printed(
        """
short = QoSProfile(depth=10, lifespan=Duration(seconds=0.2), durability=DurabilityPolicy.TRANSIENT_LOCAL)
pub = n.create_publisher(String, "a", short)
sub = n.create_subscription(String, "a", lambda m: print("sub", m.data), short)
time.sleep(0.3)
pub.publish(String(data="old"))
time.sleep(0.4)
pub.publish(String(data="new"))
spin(0.1)
n.create_subscription(String, "a", lambda m: print("late", m.data), short)
spin(0.05)
""",
        tmp_path,
    )
    assert lines == ["sub new", "late new"]

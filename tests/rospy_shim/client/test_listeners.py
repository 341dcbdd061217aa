"""Listeners for the subscribers of a publisher: their messages, their order, and their errors.

The answers are recorded from rospy 1.15.15 with a master.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.rospy_shim.missions import run_nodes


def test_a_listener_can_be_added_and_removed(tmp_path: Path) -> None:
    talks = """
        import rospy
        from std_msgs.msg import String
        rospy.init_node("talks")
        publisher = rospy.Publisher("words", String, queue_size=1)
        class Listener(rospy.SubscribeListener):
            def peer_subscribe(self, topic, publish, publish_to_new):
                publish_to_new(String("welcome"))
        listener = Listener()
        publisher.impl.add_subscriber_listener(listener)
        rospy.sleep(0.5)
        print(listener in publisher.impl.subscriber_listeners)
        publisher.impl.subscriber_listeners.remove(listener)
        rospy.sleep(1.0)
    """
    hears = """
        import rospy
        from std_msgs.msg import String
        rospy.init_node("hears")
        for _ in range(2):
            rospy.sleep(0.2)
            subscriber = rospy.Subscriber("words", String, lambda message: print(message.data))
            rospy.sleep(0.2)
            subscriber.unregister()
            rospy.sleep(0.4)
        print("end")
    """
    run = run_nodes(tmp_path, {"TALKS": talks, "HEARS": hears}, seconds=2)
    assert run.printed["talks"] == ["True"]
    assert run.printed["hears"] == ["welcome", "end"]


TALKS = """
import rospy
from std_msgs.msg import Float64, Int32
class Listener(rospy.SubscribeListener):
    def peer_subscribe(self, topic, all, peer):
        print("sub", publisher.get_num_connections())
        {does}
    def peer_unsubscribe(self, topic, peers):
        print("left", peers)
rospy.init_node("talks")
publisher = rospy.Publisher("t", Int32, subscriber_listener=Listener(), queue_size=5, latch={latch})
{begins}
rospy.sleep(1.5)
for n in range(2):
    publisher.publish(n)
    rospy.sleep(0.3)
"""
HEARS = """
import rospy
from std_msgs.msg import Int32
rospy.init_node("{name}")
rospy.sleep({start})
subscriber = rospy.Subscriber("t", Int32, lambda message: print(message.data), queue_size={queue_size})
rospy.sleep({stay})
"""
IN_TURN = "all(Int32(10)); peer(Int32(20)); all(Int32(30)); peer(Int32(40)); publisher.publish(50)"


def listened(tmp_path: Path, does: str, *, latch: bool = False, begins: str = "") -> tuple[list[str], list[str]]:
    talks = TALKS.format(does=does, latch=latch, begins=begins)
    hears = HEARS.format(name="hears", start=0.5, stay=4, queue_size=None)
    run = run_nodes(tmp_path, {"TALKS": talks, "HEARS": hears}, seconds=4)
    return run.printed.get("talks", []), run.printed.get("hears", [])


@pytest.mark.parametrize("queue_size", [None, 10])
def test_messages_to_all_and_to_a_new_subscriber_keep_their_order(tmp_path: Path, queue_size: int | None) -> None:
    scripts = {
        "TALKS": TALKS.format(does=IN_TURN, latch=False, begins=""),
        "FIRST": HEARS.format(name="first", start=0.2, stay=0.8, queue_size=queue_size),
        "SECOND": HEARS.format(name="second", start=0.6, stay=0.4, queue_size=queue_size),
    }
    run = run_nodes(tmp_path, scripts, seconds=2)
    assert run.printed["first"] == ["10", "20", "30", "40", "50", "10", "30", "50"]
    assert run.printed["second"] == ["10", "20", "30", "40", "50"]
    assert run.printed["talks"][:2] == ["sub 1", "sub 2"]


@pytest.mark.parametrize("does", ["peer(Int32(-1))", "all(Int32(-1))"])
@pytest.mark.parametrize("begins", ["", "publisher.publish(9)"])
def test_latched_message_follows_messages_of_the_listener(tmp_path: Path, does: str, begins: str) -> None:
    _, heard = listened(tmp_path, does, latch=True, begins=begins)
    assert heard == ["-1", "-1", "0", "1"]


@pytest.mark.parametrize(
    ("does", "text", "heard"),
    [
        ("peer(Int32(7)); 1/0", "division by zero", ["7"]),
        ("peer(7)", "'int' object has no attribute 'serialize'", []),
        ("peer(Int32(2**40))", "field data exceeds specified width [int32]", []),
    ],
)
def test_failed_listener_disconnects_its_subscriber(tmp_path: Path, does: str, text: str, heard: list[str]) -> None:
    told, got = listened(tmp_path, does)
    told = [line for line in told if not line.startswith("cfepy:")]
    assert [told[0], told[1].partition(": ")[2], *told[2:]] == [
        "sub 1",
        f"Inbound TCP/IP connection failed: {text}",
        "left 0",
    ]
    assert got == heard


def test_message_of_another_type_is_sent_unchanged(tmp_path: Path) -> None:
    _, heard = listened(tmp_path, "all(Int32(5)); peer(Float64(0.5))")
    assert heard == ["5", "0", "0", "1"]

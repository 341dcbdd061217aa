"""A message that cannot be serialized spoils the connections of its publisher.

The answers are recorded from rospy 1.15.15 with a master, messages half a second apart.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.rospy_shim.missions import Run, run_nodes

TALKS = """
import rospy
from std_msgs.msg import *
from geometry_msgs.msg import *
rospy.init_node("talks")
publisher = rospy.Publisher("t", {kind}, queue_size=10, latch={latch})
rospy.sleep(1)
for message in {messages}:
    print(publisher.get_num_connections())
    try:
        publisher.publish(message)
    except Exception as error:
        print(error)
    rospy.sleep(0.5)
"""
HEARS = """
import rospy
from std_msgs.msg import *
from geometry_msgs.msg import *
rospy.init_node("{name}")
rospy.sleep({start})
def show(message):
    print(message._buff.hex() or "nothing" if isinstance(message, rospy.AnyMsg) else repr({field}))
subscriber = rospy.Subscriber("t", {kind}, show)
rospy.sleep(2.9 - {start})
print("connections", subscriber.get_num_connections())
rospy.spin()
"""
OTHER = """
import rospy
from std_msgs.msg import Int32
rospy.init_node("other")
rospy.sleep({start})
publisher = rospy.Publisher("t", Int32, queue_size=1)
rospy.sleep(0.2)
publisher.publish(99)
rospy.spin()
"""
BAD = 4_000_000_000


def talks(messages: str, kind: str = "Int32", latch: bool = False) -> str:
    return TALKS.format(kind=kind, messages=messages, latch=latch)


def hears(kind: str = "Int32", start: float = 0.0, name: str = "hears", field: str = "message.data") -> str:
    return HEARS.format(kind=kind, start=start, name=name, field=field)


def fly(tmp_path: Path, scripts: dict[str, str], seconds: float = 6.0) -> Run:
    return run_nodes(tmp_path, scripts, seconds=seconds)


@pytest.mark.parametrize(
    ("kind", "messages", "field", "heard", "error"),
    [
        ("Int32", [1, 2, BAD, 3, 4], "message.data", ["1", "2"], "field data exceeds specified width [int32]"),
        ("String", ["a", 3, "b", ""], "message.data", ["'a'"], "field data must be of type bytes or an ascii string"),
    ],
)
def test_failed_message_breaks_the_topic_for_its_subscribers(
    tmp_path: Path, kind: str, messages: list[object], field: str, heard: list[str], error: str
) -> None:
    sends = f"[{kind}(each) for each in {messages!r}]"
    run = fly(tmp_path, {"HEARS": hears(kind, field=field), "TALKS": talks(sends, kind)})
    assert run.printed["hears"] == [*heard, "connections 0"]
    told = run.printed["talks"]
    at = told.index(error)
    assert [line for line in told if line.startswith("cfepy:")] == [
        "cfepy: a message for /t could not be serialized. As on ROS, the half of it that was written stays in the"
        " publisher's buffer: the next message goes out behind it, and whoever subscribes then gets nothing any more."
    ]
    # The message behind it still reaches a subscriber, later ones do not.
    assert told[at + 1 :] == ["1"] + ["0"] * (len(told) - at - 2)


def test_failed_message_still_increments_the_sequence_number(tmp_path: Path) -> None:
    sends = "[PointStamped(), PointStamped(point=Point(1, 'x', 1)), PointStamped(), PointStamped()]"
    field = "message.header.seq"
    run = fly(tmp_path, {"HEARS": hears("PointStamped", field=field), "TALKS": talks(sends, "PointStamped")})
    assert run.printed["hears"] == ["1", "connections 0"]


def test_later_subscriber_gets_later_messages(tmp_path: Path) -> None:
    scripts = {
        "HEARS": hears(),
        "BETWEEN": hears(start=1.75, name="between"),
        "LATE": hears(start=2.25, name="late"),
        "TALKS": talks(f"[1, {BAD}, 3, 4, 5]"),
    }
    run = fly(tmp_path, scripts)
    assert run.printed["hears"] == ["1", "connections 0"]
    assert run.printed["between"] == ["connections 0"]
    assert run.printed["late"] == ["4", "connections 1", "5"]


@pytest.mark.parametrize(("start", "heard"), [(3.25, ["99", "5", "6"]), (2.5, ["99"])])
def test_other_publisher_restores_the_connection(tmp_path: Path, start: float, heard: list[str]) -> None:
    """Once the subscriber has given up, a second after the spoilt message, which came at 2 s."""
    scripts = {"HEARS": hears(), "TALKS": talks(f"[1, {BAD}, 2, 3, 4, 5, 6]"), "OTHER": OTHER.format(start=start)}
    lines = fly(tmp_path, scripts).printed["hears"]
    assert [line for line in lines[1:] if not line.startswith("connections")] == heard


def test_bad_latched_message_refuses_new_subscribers(tmp_path: Path) -> None:
    scripts = {
        "HEARS": hears(),
        "LATE": hears(start=1.75, name="late"),
        "TALKS": talks(f"[1, {BAD}, 2]", latch=True),
    }
    run = fly(tmp_path, scripts)
    assert run.printed["hears"] == ["1", "connections 0"]
    assert run.printed["late"] == ["connections 0"]
    text = "Inbound TCP/IP connection failed: field data exceeds specified width [int32]"
    assert any(line.endswith(text) for line in run.printed["talks"])


def test_any_msg_subscriber_gets_the_bytes_after_a_failed_message(tmp_path: Path) -> None:
    scripts = {"HEARS": hears("rospy.AnyMsg"), "TALKS": talks(f"[1, {BAD}, 3, 4]")}
    assert fly(tmp_path, scripts).printed["hears"] == [
        "01000000",
        "nothing",
        "03000000",
        "04000000",
        "connections 1",
    ]


def test_any_msg_subscriber_gets_shifted_messages_after_a_failed_header(tmp_path: Path) -> None:
    sends = "[PointStamped(), PointStamped(point=Point(1, 'x', 1)), PointStamped(), PointStamped()]"
    scripts = {"HEARS": hears("rospy.AnyMsg"), "TALKS": talks(sends, "PointStamped")}
    lines = fly(tmp_path, scripts).printed["hears"]
    assert lines[1:] == ["nothing", "0000", "nothing", "nothing", "connections 1"]

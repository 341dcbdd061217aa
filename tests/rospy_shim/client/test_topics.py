"""Publishing and subscribing between nodes: order, sharing, latching, types, queues, long messages, cFE packets."""

from __future__ import annotations

from pathlib import Path

import pytest

from rospy_shim.types.config import NodeConfig, TopicConfig
from tests.rospy_shim.missions import Run, run_nodes

HEAD = """
import rospy
from std_msgs.msg import *
from geometry_msgs.msg import PointStamped, Point
"""


def run(tmp_path: Path, body: str, **options: object) -> list[str]:
    """Run one node. Returns its output."""
    script = HEAD + 'rospy.init_node("probe")\n' + body
    result = run_nodes(tmp_path, {"PROBE": script}, **options)  # type: ignore[arg-type]
    return result.printed.get("probe", result.lines)


def both(tmp_path: Path, publisher: str, subscriber: str, **options: object) -> Run:
    """Run a subscribing node and a publishing one that starts a second later."""
    scripts = {
        "SUB": HEAD + 'rospy.init_node("sub")\n' + subscriber,
        "PUB": HEAD + 'rospy.init_node("pub")\nrospy.sleep(1.0)\n' + publisher,
    }
    return run_nodes(tmp_path, scripts, **options)  # type: ignore[arg-type]


def test_callbacks_of_a_topic_share_task_pipe_and_message(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
import threading
seen = []
publisher = rospy.Publisher("o", String, queue_size=5)
subscribers = [
    rospy.Subscriber("o", String, lambda m, n=n: seen.append((n, id(m), threading.get_ident()))) for n in range(3)
]
rospy.sleep(0.2)
publisher.publish("x")
rospy.sleep(0.1)
print([n for n, _, _ in seen], len({i for _, i, _ in seen}), len({t for _, _, t in seen}))
print(publisher.get_num_connections(), subscribers[0].get_num_connections())
print(seen[0][2] != threading.get_ident())
""",
    )
    assert lines == ["[0, 1, 2] 1 1", "1 1", "True"]


def test_messages_are_queued_from_the_moment_of_the_subscription(tmp_path: Path) -> None:
    """ES starts its task 50 ms later. It then gets the messages published meanwhile, and the last latched one."""
    lines = run(
        tmp_path,
        """
plain = rospy.Publisher("plain", String, queue_size=5)
latching = rospy.Publisher("latching", String, queue_size=5, latch=True)
latching.publish("before")
seen = []
for topic in ("plain", "latching"):
    rospy.Subscriber(topic, String, lambda message: seen.append(message.data))
print(plain.get_num_connections(), latching.get_num_connections())
for publisher in (plain, latching):
    publisher.publish("at once")
rospy.sleep(0.02)
for publisher in (plain, latching):
    publisher.publish("soon")
rospy.sleep(0.1)
latching.publish("later")
rospy.sleep(0.1)
print(seen)
""",
    )
    assert lines == ["1 1", "['at once', 'soon', 'soon', 'later']"]


def test_subscriber_that_ends_before_its_task_starts_leaves_no_pipe(tmp_path: Path) -> None:
    """A sixty-fourth pipe more would be one too many."""
    lines = run(
        tmp_path,
        """
for _ in range(8):
    passing = [rospy.Subscriber(f"o{n}", String, print) for n in range(20)]
    for each in passing:
        each.unregister()
    rospy.sleep(0.1)
publisher = rospy.Publisher("o1", String, queue_size=5)
publisher.publish("nobody")
print(publisher.get_num_connections())
""",
    )
    assert lines == ["0"]


def test_header_sequence_and_connection_header(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
seen = []
publisher = rospy.Publisher("p", PointStamped, queue_size=5)
publisher.publish(PointStamped())  # nobody is there: not counted
rospy.Subscriber("p", PointStamped, seen.append)
rospy.sleep(0.2)
for stamp in (0, 5):
    message = PointStamped(Header(9, rospy.Time(stamp), "f"), Point())
    message.header.frame_id = None
    publisher.publish(message)
rospy.sleep(0.1)
print([(m.header.seq, m.header.stamp.secs, m.header.frame_id) for m in seen])
print(sorted(seen[0]._connection_header), seen[0]._connection_header["callerid"])
""",
    )
    assert lines == [
        "[(1, 0, '0'), (2, 5, '0')]",
        "['callerid', 'latching', 'md5sum', 'message_definition', 'topic', 'type'] /probe",
    ]


def test_callback_errors_are_logged_and_the_next_message_is_processed(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
seen = []
def bad(message):
    seen.append(message.data)
    raise ValueError("boom")
publisher = rospy.Publisher("e", String, queue_size=5)
rospy.Subscriber("e", String, bad)
rospy.sleep(0.2)
publisher.publish("1")
publisher.publish("2")
rospy.sleep(0.1)
print(seen)
""",
    )
    text = "\n".join(lines)
    assert lines[-1] == "['1', '2']"
    assert "bad callback: <function bad at 0x" in text
    assert 'raise ValueError("boom")' in text
    assert "subscriber.py" not in text


def test_latched_message_reaches_late_subscribers(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
publisher = rospy.Publisher("l", String, queue_size=1, latch=True)
publisher.publish("one")
publisher.publish("two")
late = rospy.wait_for_message("l", String, timeout=1)
print(late.data, late._connection_header["latching"])
first = rospy.Subscriber("l", String, lambda m: print("first", m.data))
rospy.sleep(0.2)
second = rospy.Subscriber("l", String, lambda m: print("second", m.data))
""",
    )
    assert lines == ["two 1", "first two", "second two"]


def test_unregistered_handles(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
seen = []
publisher = rospy.Publisher("u", String, queue_size=1)
one = rospy.Subscriber("u", String, seen.append)
two = rospy.Subscriber("u", String, lambda m: (two.unregister(), seen.append(m)))
rospy.sleep(0.2)
publisher.publish("a")
rospy.sleep(0.1)
print(len(seen), publisher.get_num_connections())
one.unregister()
rospy.sleep(0.1)
print(publisher.get_num_connections())
publisher.publish("b")
rospy.sleep(0.1)
print(len(seen))
publisher.unregister()
publisher.unregister()
try:
    publisher.publish("c")
except rospy.ROSException as error:
    print(error)
""",
    )
    assert lines == ["2 1", "0", "2", "publish() to an unregistered() handle"]


def test_any_message(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
rospy.Subscriber("any", rospy.AnyMsg, lambda m: print(m._buff.hex(), m._connection_header["type"]))
publisher = rospy.Publisher("any", String, queue_size=1)
rospy.sleep(0.2)
publisher.publish("any")
rospy.sleep(0.1)
""",
    )
    assert lines == ["03000000616e79 std_msgs/String"]


def test_subscriber_of_another_type_is_reported_and_not_connected(tmp_path: Path) -> None:
    result = both(
        tmp_path,
        'publisher = rospy.Publisher("t", UInt32, queue_size=1)\npublisher.publish(1)\n'
        "print(publisher.get_num_connections())",
        'rospy.Subscriber("t", String, print)\nrospy.spin()',
    )
    assert result.printed["pub"][-1] == "0"
    assert "has the type std_msgs/UInt32" in result.printed["pub"][0]
    assert result.printed.get("sub") is None


def test_subscribe_listener_and_its_private_publish(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
class Listener(rospy.SubscribeListener):
    def peer_subscribe(self, name, publish, peer_publish):
        print("sub", name)
        peer_publish(String("hello"))
    def peer_unsubscribe(self, name, peers):
        print("unsub", name, peers)
publisher = rospy.Publisher("n", String, subscriber_listener=Listener(), queue_size=5)
subscriber = rospy.Subscriber("n", String, lambda m: print("got", m.data))
rospy.sleep(0.2)
subscriber.unregister()
rospy.sleep(0.1)
""",
    )
    assert lines == ["sub /n", "got hello", "unsub /n 0"]


@pytest.mark.parametrize(("size", "priority"), [(40_000, 90), (40_000, 100), (300_000, 120)])
def test_long_messages_arrive_complete(tmp_path: Path, size: int, priority: int) -> None:
    result = both(
        tmp_path,
        'publisher = rospy.Publisher("big", String, queue_size=1)\n'
        f"for n in range(3): publisher.publish(str(n) * {size})",
        'rospy.Subscriber("big", String, lambda m: print(len(m.data), set(m.data)), queue_size=1)\nrospy.spin()',
        priorities={"SUB": priority},
    )
    assert result.printed["sub"] == [f"{size} {{'{n}'}}" for n in range(3)]
    assert result.topics["/big"].dropped == 0


def test_long_messages_of_two_publishers_do_not_mix(tmp_path: Path) -> None:
    publisher = (
        HEAD
        + 'rospy.init_node("pub{0}")\nrospy.sleep(1.0)\np = rospy.Publisher("big", String, queue_size=1)\n'
        + 'for _ in range(3): p.publish("{0}" * 100_000)'
    )
    subscriber = (
        HEAD
        + 'rospy.init_node("sub")\nrospy.Subscriber("big", String, lambda m: print(len(m.data), set(m.data),'
        + ' m._connection_header["callerid"]), queue_size=2)\nrospy.spin()'
    )
    result = run_nodes(
        tmp_path,
        {"SUB": subscriber, "PUB_A": publisher.format("a"), "PUB_B": publisher.format("b")},
        priorities={"SUB": 110},
    )
    assert sorted(result.printed["sub"]) == ["100000 {'a'} /puba"] * 3 + ["100000 {'b'} /pubb"] * 3


def test_raw_topic_carries_packets(tmp_path: Path) -> None:
    result = both(
        tmp_path,
        'p = rospy.Publisher("/raw", UInt8MultiArray, queue_size=1)\n'
        'p.publish(data=bytes.fromhex("0777c0000003") + b"abcd")\n'
        'try:\n    p.publish(data=b"12345678")\nexcept rospy.ROSException as error:\n    print(error)',
        'rospy.Subscriber("/raw", UInt8MultiArray, lambda m: print(m.data.hex()))\nrospy.spin()',
        topics={"/raw": TopicConfig("/raw", 0x0777, raw=True)},
    )
    assert result.printed["sub"] == ["0777c001000361626364"]
    assert result.printed["pub"] == ["/raw carries packets of MsgId 0x0777, and these bytes begin with 0x3132"]


def test_arguments_are_checked_as_in_rospy(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
def attempt(function, *args, **kwds):
    try:
        function(*args, **kwds)
    except Exception as error:
        print(type(error).__name__, error)
P, S = rospy.Publisher, rospy.Subscriber
attempt(P("c1", ColorRGBA, queue_size=1).publish, 1, 2)
attempt(P("c2", ColorRGBA, queue_size=1).publish, 1, a=2)
attempt(P("c3", String, queue_size=1).publish, UInt32(1))
attempt(P, "c4", int, queue_size=1)
attempt(P, "c5", None, queue_size=1)
attempt(P, "", String, queue_size=1)
attempt(S, "c6", "String", None)
attempt(S, "c7", String, print, queue_size=0)
attempt(S, "c8", String, print, queue_size="a")
attempt(S, "c9", String, print, buff_size=0)
""",
    )
    assert lines == [
        "TypeError Invalid number of arguments, args should be ['r', 'g', 'b', 'a'] args are(1, 2)",
        "TypeError publish() can be called with arguments or keywords, but not both.",
        "TypeError expected [string] but got [std_msgs/UInt32]",
        "ValueError data_class [type] is not a message data class",
        "ValueError topic parameter 'data_class' is not initialized",
        "ValueError topic name is not a non-empty string",
        "ValueError data_class [String] is not a class",
        "ROSException queue size may not be set to zero",
        "ROSException queue size must be an integer",
        "ROSException buffer size must be a positive integer",
    ]


def test_unserialisable_field(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
p = rospy.Publisher("f", Int32, queue_size=1)
p.publish("nobody is there to notice")
rospy.Subscriber("f", Int32, print)
rospy.sleep(0.2)
try:
    p.publish(2.5)
except rospy.ROSSerializationException as error:
    print(error)
""",
    )
    assert lines[1:] == ["field data must be an integer type"]
    assert lines[0].startswith("cfepy: a message for /f could not be serialized.")


def test_numpy_message(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
import numpy
from rospy.numpy_msg import numpy_msg
kind = numpy_msg(Float64MultiArray)
rospy.Subscriber("np", kind, lambda m: print(type(m.data).__name__, m.data.sum()))
p = rospy.Publisher("np", kind, queue_size=1)
rospy.sleep(0.2)
p.publish(data=numpy.arange(4.0))
rospy.sleep(0.1)
""",
    )
    assert lines == ["ndarray 6.0"]


def test_class_generated_by_genpy_is_accepted(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
import codecs, genpy, struct
class Old(genpy.Message):
    _type, _md5sum, _has_header, _full_text = "old_msgs/Old", "0" * 32, False, "string text"
    __slots__, _slot_types = ["text"], ["string"]
    def serialize(self, buff):
        raw = self.text.encode()
        buff.write(struct.pack("<I", len(raw)) + raw)
    def deserialize(self, data):
        codecs.lookup_error("rosmsg").msg_type = self._type
        self.text = data[4:].decode("utf-8", "rosmsg")
        return self
rospy.Subscriber("old", Old, lambda m: print(m.text))
publisher = rospy.Publisher("old", Old, queue_size=1)
rospy.sleep(0.2)
publisher.publish("hello")
rospy.sleep(0.1)
""",
    )
    assert lines == ["hello"]


def test_missing_queue_size_warns_once(tmp_path: Path) -> None:
    lines = run(tmp_path, 'for _ in range(2): rospy.Publisher("w", String)\n')
    assert len([line for line in lines if "SyntaxWarning" in line and "queue_size" in line]) == 1


def test_warnings_point_at_the_line_of_the_node(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
def talk():
    return rospy.Publisher("a", String)
talk()
rospy.set_param("1bad", 0)
rospy.Subscriber("2bad", String)
""",
    )
    assert ["probe.py" in line for line in lines if "Warning:" in line] == [True] * 3
    code = ['return rospy.Publisher("a", String)', 'rospy.set_param("1bad", 0)', 'rospy.Subscriber("2bad", String)']
    assert [line.strip() for line in lines if line.startswith("  ")] == code


def test_remapped_topic_and_published_topics(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        'p = rospy.Publisher("in", String, queue_size=1)\nprint(p.name, rospy.get_published_topics("/lab"))\n',
        nodes={"PROBE": NodeConfig("PROBE", remap={"in": "/lab/out"})},
    )
    assert lines == ["/lab/out [['/lab/out', 'std_msgs/String']]"]

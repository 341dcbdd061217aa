"""The samples of the fuzz driver: valid packets of each area, and the entry point of its node."""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Iterator
from pathlib import Path

from cfepy.extra.convert.entry import FREE_ROWS, NodeEntry
from cfepy.mission import NodeGround
from dev.roscfe.random_messages import LIBRARY, Source, capacities
from rospy_shim.parameters.table import FREE, NAME_BYTES, VALUE_BYTES

TOPICS = {
    "empty": "std_msgs/Empty",
    "string": "std_msgs/String",
    "header": "std_msgs/Header",
    "int64": "std_msgs/Int64",
    "floats": "std_msgs/Float64MultiArray",
    "raw": "std_msgs/UInt8MultiArray",
    "cloud": "sensor_msgs/PointCloud2",
    "joints": "sensor_msgs/JointState",
    "grid": "nav_msgs/OccupancyGrid",
    "diagnostics": "diagnostic_msgs/DiagnosticArray",
    "markers": "visualization_msgs/MarkerArray",
    "trajectory": "trajectory_msgs/MultiDOFJointTrajectory",
    "goals": "actionlib_msgs/GoalStatusArray",
}
OTHERS = ("other_string", "tf", "tf_static", "clock")
"""Further topics, whose messages `topics.cpp` does not read."""
OFFERED = {
    "set_bool": "std_srvs/SetBool",
    "plan": "nav_msgs/GetPlan",
    "configure": "dynamic_reconfigure/Reconfigure",
    "camera": "sensor_msgs/SetCameraInfo",
    "level": "roscpp/SetLoggerLevel",
}
CALLED = {"a": "std_srvs/SetBool", "b": "nav_msgs/GetPlan", "c": "dynamic_reconfigure/Reconfigure"}
TOPIC_ID, OFFERED_ID, CALLED_ID, HOUSEKEEPING_ID, COMMAND_BIT = 0x0A00, 0x0B00, 0x0B10, 0x0C00, 0x1000
SAMPLES = 12  # of a type
VALUE, HEADER, NAMES = 1, 2, 3
"""Kinds of answers of the ROS application, in place of a MsgId."""
FRAMES = ("map", "odom", "base", "tool", "left/wheel", "")
AREAS = ("topics", "reports", "services", "parameters", "table", "transforms", "commands")
Sample = tuple[int, bytes]


def entry() -> NodeEntry:
    """Return the entry point of the node."""
    names = [f"/{name}" for name in (*TOPICS, *OTHERS)]
    topics = {name: (TOPIC_ID + at, name == "/raw") for at, name in enumerate(names)}
    services = {f"/{name}": OFFERED_ID + at for at, name in enumerate(OFFERED)}
    services |= {f"/{name}": CALLED_ID + at for at, name in enumerate(CALLED)}
    return NodeEntry(
        "NODE",
        "fuzzed",
        topics=topics,
        services=services,
        rows=[FREE] * FREE_ROWS,
        ground=NodeGround(HOUSEKEEPING_ID, 1),
    )


def write_corpus(area: str, path: Path) -> None:
    """Write the samples of an area into a file that the driver reads."""
    lines = [struct.pack("<HI", msg_id, len(octets)) + octets for msg_id, octets in _MAKERS[area]()]
    path.write_bytes(b"".join(lines))


def _messages(name: str, count: int = SAMPLES) -> Iterator[bytes]:
    yield bytes(LIBRARY.message_class(name)().__pack__())
    source = Source(name, capacities())
    for _ in range(count - 1):
        yield source.message(name).__pack__()


def _topics() -> Iterator[Sample]:
    for at, (topic, name) in enumerate(TOPICS.items()):
        if topic == "raw":  # whole packets
            yield from ((TOPIC_ID + at, bytes(range(size))) for size in (1, 7, 16, 60))
            continue
        yield from ((TOPIC_ID + at, octets) for octets in _messages(name))
        if topic in ("cloud", "grid"):  # longer than a packet
            made = LIBRARY.message_class(name)()
            made.data = bytes(70000) if topic == "cloud" else [1] * 40000
            yield TOPIC_ID + at, made.__pack__()


def _services() -> Iterator[Sample]:
    for at, name in enumerate(OFFERED.values()):
        yield from ((OFFERED_ID + at | COMMAND_BIT, octets) for octets in _messages(f"{name}Request"))
    for at, name in enumerate(CALLED.values()):
        yield from ((CALLED_ID + at, octets) for octets in _messages(f"{name}Response"))


def _values() -> Iterator[str]:
    deep = "[" * 40 + "]" * 40
    yield from ("1", "-2.5e300", "true", '"text"', "[]", "{}", "null", deep, '{"a": {"b": {"c": [1, 2.0, "x"]}}}')
    yield from (
        '"\\ud83d\\ude00\\u0000\\n"',
        "1e999",
        "123456789012345678901234567890",
        "[1, 2, 3, 4.5]",
        '"' + "x" * 500 + '"',
    )
    yield from (json.dumps({"base64": "AAECAw=="}), json.dumps(list(range(100))), '{"a": 1, "b": 2}', "-0", "0.1")


def _parameters() -> Iterator[Sample]:
    yield from ((VALUE, b"\x01" + text.encode()) for text in _values())
    yield VALUE, b"\x00"
    lists: list[list[object]] = [["/a", "/b/c", "/rosdistro"], [], ["x" * 300], [1, None, {}]]
    yield from ((NAMES, b"\x01" + json.dumps(each).encode()) for each in lists)
    texts = (b"std_msgs/String", b"992ce8a1687cec8c8bd883ec73ca41d1", b"string data\n", b"1")
    yield HEADER, b"".join(struct.pack("<I", len(text)) + text for text in texts)


def _table() -> Iterator[Sample]:
    for name in ("/a", "/b/c", "/b/c/d", "+", "+more", "", "/fuzzed/d", "n" * NAME_BYTES):
        for value in ("", *_values()):
            row = name.encode()[:NAME_BYTES].ljust(NAME_BYTES, b"\0") + value.encode()[:VALUE_BYTES].ljust(
                VALUE_BYTES, b"\0"
            )
            yield 0, row


def _transforms() -> Iterator[Sample]:
    names = [*TOPICS, *OTHERS]
    tf, tf_static, clock = (TOPIC_ID + names.index(name) for name in ("tf", "tf_static", "clock"))
    for second in range(30):
        for child, parent in zip(FRAMES[1:], FRAMES, strict=False):
            yield (tf_static if child == "tool" else tf), _transform_message(second, ((child, parent),))
        yield clock, struct.pack("<II", second, 0)
        if second % 5 == 0:
            yield tf, _transform_message(second, tuple(zip(FRAMES[1:], FRAMES, strict=False)))
            yield tf, _transform_message(second, (("map", "base"),))  # a loop
            yield tf, _transform_message(second, (("n" * 200, "map"), ("odom", "odom")))
    yield tf, struct.pack("<I", 0)


def _transform_message(second: int, edges: tuple[tuple[str, str], ...]) -> bytes:
    octets = struct.pack("<I", len(edges))
    for child, parent in edges:
        octets += struct.pack("<III", 0, second, 0)
        octets += b"".join(struct.pack("<I", len(name)) + name.encode() for name in (parent, child))
        octets += struct.pack("<7d", second, 0.5, 0, 0, 0, math.sin(second / 2), math.cos(second / 2))
    return octets


def _nothing() -> Iterator[Sample]:
    yield 0, b""


_MAKERS = {
    "topics": _topics,
    "reports": _nothing,
    "services": _services,
    "parameters": _parameters,
    "table": _table,
    "transforms": _transforms,
    "commands": _nothing,
}

"""Messages in JSON, PNG and CBOR, and values that cannot be messages."""

from __future__ import annotations

import json
import struct
from base64 import b64decode
from io import BytesIO
from typing import Any

import cbor2
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from cfepy.extra.viewers.rosbridge.json_values import Reading, WrongMessage, json_values
from cfepy.extra.viewers.rosbridge.outgoing import Outgoing, dumps, png_of
from rospy_shim.types.genpy import Time
from rospy_shim.types.msgs import from_full_text, message_class, shipped

READING = Reading(message_class, lambda: (100, 5))
ALL = from_full_text(
    "pkg/All",
    "bool a\nint8[] b\nuint8[3] c\nchar[] d\nfloat32 e\nfloat64[2] f\nstring g\nstring[] h\ntime i\nduration[] j\n"
    "std_msgs/Header k\nstd_msgs/ColorRGBA[2] l\nuint64 m\nbool[] n\nbyte[] o\n"
    f"{'=' * 80}\nMSG: std_msgs/Header\n{shipped().text('std_msgs/Header')}\n"
    f"{'=' * 80}\nMSG: std_msgs/ColorRGBA\n{shipped().text('std_msgs/ColorRGBA')}\n",
).message_class("pkg/All")


def test_header_without_a_stamp_gets_the_time() -> None:
    message: Any = READING.message({"header": {"frame_id": "map"}}, message_class("geometry_msgs/PoseStamped"))
    assert (message.header.stamp.secs, message.header.stamp.nsecs, message.header.frame_id) == (100, 5, "map")
    message = READING.message({"header": {"stamp": {"secs": 1}}}, message_class("geometry_msgs/PoseStamped"))
    assert (message.header.stamp.secs, message.header.stamp.nsecs) == (1, 5), "as rosbridge_library has it"
    message = READING.message({}, message_class("geometry_msgs/PoseStamped"))
    assert message.header.stamp == Time()


def test_now_is_the_missions_time() -> None:
    message: Any = READING.message({"data": "now"}, message_class("std_msgs/Time"))
    assert message.data == Time(100, 5)


def test_publisher_numbers_its_messages() -> None:
    kind = message_class("geometry_msgs/PoseStamped")
    message: Any = kind().deserialize(READING.serialized({"header": {"seq": 9}}, kind, 4))
    assert message.header.seq == 4
    message = kind().deserialize(READING.serialized({"header": {"seq": 9}}, kind))
    assert message.header.seq == 9


@pytest.mark.parametrize(
    ("values", "said"),  # genpy's text about a number that does not fit is its own
    [
        ({"c": "A"}, "requires base64 for field c"),
        ({"c": [1, 2, 256]}, "requires octets for field c"),
        ({"c": 3}, "requires a uint8"),
        ({"f": [1.0]}, "expected 2 items"),
        ({"h": ["x", 3]}, "requires a string for field h"),
        ({"i": {"secs": "x"}}, "."),
        ({"i": {"secs": -1}}, "."),
        ({"j": [{"nsecs": 1e99}]}, "."),
        ({"k": {"stamp": 4, "seq": -1}}, "."),
        ({"l": [{"r": 1.0}, {"r": 1e999, "g": "x"}]}, "requires a float32 for field l.g"),
        ({"m": 1 << 64}, "."),
        ({"e": 1e300}, "."),
        ({"n": [1]}, "requires a bool for field n"),
    ],
)
def test_values_of_a_wrong_type_are_refused(values: dict[str, Any], said: str) -> None:
    with pytest.raises(WrongMessage, match=said):
        READING.serialized(values, ALL)


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text() | st.just("now"),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.sampled_from("abcdefghijklmno"), inner, max_size=4),
    max_leaves=8,
)


@pytest.mark.slow
@settings(max_examples=150, deadline=None)
@given(st.dictionaries(st.sampled_from("abcdefghijklmno"), JSON | st.fixed_dictionaries({"secs": JSON, "nsecs": JSON})))
def test_any_values_are_a_message_or_refused(values: dict[str, Any]) -> None:
    try:
        payload = READING.serialized(values, ALL)
    except WrongMessage:
        return
    message = ALL().deserialize(payload)
    again = READING.serialized(_without_nulls(json.loads(json.dumps(json_values(message)))), ALL)
    assert len(again) == len(payload)


def _without_nulls(values: Any) -> Any:
    """Replace the nulls for numbers that JSON cannot express."""
    if isinstance(values, dict):
        return {name: _without_nulls(value) for name, value in values.items()}
    if isinstance(values, list):
        return [_without_nulls(value) for value in values]
    return 0.0 if values is None else values


@pytest.mark.parametrize("length", [0, 1, 2, 3, 5, 11, 12, 13, 100, 5_000])
def test_a_text_as_pixels(length: int) -> None:
    text = ("caf\u00e9 " * length)[:length]
    with Image.open(BytesIO(b64decode(png_of(text)))) as image:
        assert image.mode == "RGB"
        assert image.tobytes().decode().rstrip("\n") == text


VALUES = [
    *(0, 23, 24, 255, 256, 65_535, 65_536, 1 << 32, (1 << 64) - 1, -1, -24, -25, -256, -(1 << 63)),
    *(0.0, -1.5, 1e300, float("inf"), True, False, None, "", "caf\u00e9", "x" * 300, b"", b"\0" * 70_000),
    *([], [1, [2]], {}, {"a": {"b": [1.5, "c"]}}),
]


@pytest.mark.parametrize("value", VALUES, ids=str)
def test_cbor_is_read_by_another_library(value: Any) -> None:
    assert cbor2.loads(dumps(value)) == value


def test_a_message_in_cbor() -> None:
    kind = message_class("std_msgs/Float64MultiArray")
    payload = READING.serialized({"data": [1.5, -2.0]}, kind)
    found = cbor2.loads(Outgoing(payload, kind, (7, 8)).op("/x", "cbor"))
    assert (found["op"], found["topic"]) == ("publish", "/x")
    assert found["msg"]["layout"] == {"dim": [], "data_offset": 0}
    tag = found["msg"]["data"]
    assert (tag.tag, struct.unpack("<2d", tag.value)) == (86, (1.5, -2.0))
    raw = cbor2.loads(Outgoing(payload, None, (7, 8)).op("/x", "cbor-raw"))
    assert raw["msg"] == {"secs": 7, "nsecs": 8, "bytes": payload}

"""Generated classes: construction, comparison, copies, in-place decoding and errors, as genpy has them."""

from __future__ import annotations

import copy
import io
import pickle
from pathlib import Path
from typing import Any

import pytest

from rospy_shim.types import genpy
from rospy_shim.types.genpy.checks import check_type
from rospy_shim.types.msgs import from_full_text, message_class, shipped
from tests.rospy_shim.missions import run_nodes

String = message_class("std_msgs/String")
UInt32 = message_class("std_msgs/UInt32")
Header = message_class("std_msgs/Header")
PoseStamped = message_class("geometry_msgs/PoseStamped")
JointState = message_class("sensor_msgs/JointState")
Odometry = message_class("nav_msgs/Odometry")

EVERYTHING = (
    """\
bool b
int8 i8
uint8 u8
char c
int64 i64
float32 f
string s
time t
duration d
bool[] vb
bool[2] fb
uint8[] vu
uint8[3] fu
int32[] vi
float64[3] f3
string[] vs
string[2] fs
time[2] ft
std_msgs/String m
std_msgs/String[] vm
std_msgs/String[2] fm
int8 from
"""
    + "=" * 80
    + "\nMSG: std_msgs/String\nstring data\n"
)
Everything = from_full_text("pkg/Everything", EVERYTHING).message_class("pkg/Everything")


def _serialize(**fields: Any) -> bytes:
    buff = io.BytesIO()
    Everything(**fields).serialize(buff)
    return buff.getvalue()


def test_construction() -> None:
    assert String("a") == String(data="a")
    assert String(None).data == ""
    assert String(data=None).data == ""
    assert Header(seq=4).frame_id == ""
    assert PoseStamped(None, None).pose.orientation.w == 0.0
    with pytest.raises(TypeError, match=r"args should be \['data'\] args are\('a', 'b'\)"):
        String("a", "b")
    with pytest.raises(TypeError, match="args OR keywords"):
        String("a", data="b")
    with pytest.raises(AttributeError, match="foo is not an attribute of String"):
        String(foo=1)
    with pytest.raises(AttributeError):
        String().undeclared = 1


def test_defaults_are_fresh() -> None:
    first, second = JointState(), JointState()
    first.name.append("a")
    first.header.stamp.secs = 5
    assert second.name == []
    assert second.header.stamp.secs == 0
    assert len({id(each) for each in Everything().fm}) == 2


def test_kinds_of_decoded_fields() -> None:
    fields = Everything().deserialize(_serialize(vb=[1, 0], vu=[1, 2], vi=[3], vs=["a"], vm=[String("x")], b=True))
    assert fields.b is True
    assert fields.vb == [True, False]
    assert fields.fb == [False, False]
    assert fields.vu == b"\x01\x02"
    assert fields.fu == bytes(3)
    assert fields.vi == (3,)
    assert fields.f3 == (0.0, 0.0, 0.0)
    assert fields.vs == ["a"]
    assert [each.data for each in fields.vm] == ["x"]
    assert fields.from_ == 0


def test_comparison() -> None:
    assert String("a") == String("a")
    assert String("a") != String("b")
    assert String("a") != "a"
    assert UInt32(1) != String("a")
    with pytest.raises(TypeError, match="unhashable"):
        hash(String("a"))


def test_connection_header_is_unset_at_first() -> None:
    with pytest.raises(AttributeError):
        _ = String("a")._connection_header
    message = String("a")
    message._connection_header = {"callerid": "/talker"}
    assert copy.copy(message) == message


@pytest.mark.parametrize("duplicate", [copy.copy, copy.deepcopy, lambda each: pickle.loads(pickle.dumps(each))])
def test_copies(duplicate: Any) -> None:
    message = PoseStamped(Header(1, genpy.Time(2, 3), "map"), None)
    other = duplicate(message)
    assert other == message
    assert type(other) is PoseStamped
    assert type(other.header.stamp) is genpy.Time


def test_deep_copy_shares_nothing() -> None:
    message = PoseStamped()
    other = copy.deepcopy(message)
    other.pose.position.x = 4.0
    assert message.pose.position.x == 0.0


def test_subclass_of_a_message() -> None:
    Named: Any = type("Named", (String,), {"__slots__": []})
    decoded = Named.__unpack__(String("x").__pack__())
    assert type(decoded) is Named
    assert decoded.data == "x"


def test_deserialize_fills_in_place() -> None:
    message = Odometry()
    header, position = message.header, message.pose.pose.position
    message.pose.covariance = None
    message.twist = None
    message.deserialize(Odometry(child_frame_id="base").__pack__())
    assert message.header is header
    assert message.pose.pose.position is position
    assert message.twist.twist.linear.x == 0.0
    assert message.child_frame_id == "base"


def test_times_are_normalised() -> None:
    times = from_full_text("pkg/T", "time a\nduration b\ntime[] c\n").message_class("pkg/T")
    pair = bytes.fromhex("01000000ffffffff")
    message = times.__unpack__(pair + pair + bytes.fromhex("01000000") + pair)
    assert (message.a.secs, message.a.nsecs) == (5, 294967295)
    assert (message.b.secs, message.b.nsecs) == (0, 999999999)
    assert (message.c[0].secs, message.c[0].nsecs) == (1, 4294967295)


@pytest.mark.parametrize(
    ("fields", "text"),
    [
        ({"b": 256}, "field b is not a bool"),
        ({"i8": 128}, r"field i8 exceeds specified width \[int8\]"),
        ({"i8": 1.5}, "field i8 must be an integer type"),
        ({"u8": -1}, "field u8 must be unsigned integer type"),
        ({"c": "a"}, "field c must be unsigned integer type"),
        ({"f": "x"}, "field f must be float type"),
        ({"s": 5}, "field s must be of type bytes or an ascii string"),
        ({"vb": 5}, "field vb must be a list or tuple type"),
        ({"fb": [1]}, "pack expected 2 items for packing"),
        ({"vu": [1, 300]}, r"field vu\[\] exceeds specified width \[uint8\]"),
        ({"vu": "ab"}, "argument for 's' must be a bytes object"),
        ({"fu": [1, 2]}, "pack expected 3 items for packing"),
        ({"vi": ["x"]}, r"field vi\[\] must be an integer type"),
        ({"vi": "ab"}, r"field vi must be a list or tuple type\. Only uint8\[\] can be a string"),
        ({"f3": [1, 2, 3, 4]}, "pack expected 3 items for packing"),
        ({"vs": ["a", 5]}, r"field vs\[\] must be of type bytes or an ascii string"),
        ({"fs": ["a"]}, "Expecting 2 items but found 1 when writing 'self.fs'"),
        ({"ft": [genpy.Time()]}, "Expecting 2 items but found 1 when writing 'self.ft'"),
        ({"m": String(5)}, "field m.data must be of type bytes or an ascii string"),
        ({"fm": [String()] * 3}, "Expecting 2 items but found 3 when writing 'self.fm'"),
    ],
)
def test_serialization_errors(fields: dict[str, Any], text: str) -> None:
    with pytest.raises(genpy.SerializationError, match=text):
        _serialize(**fields)


@pytest.mark.parametrize(
    ("fields", "error"),
    [
        ({"s": b"ab"}, AttributeError),
        ({"s": ["a"]}, AttributeError),
        ({"s": "\ud800"}, UnicodeEncodeError),
        ({"t": 5}, AttributeError),
        ({"vs": [b"x"]}, AttributeError),
        ({"vm": ["x"]}, AttributeError),
        ({"m": 5}, AttributeError),
        ({"f": 1e40}, OverflowError),
    ],
)
def test_errors_ignored_by_genpy_are_ignored(fields: dict[str, Any], error: type[Exception]) -> None:
    with pytest.raises(error):
        _serialize(**fields)


def test_lengths_of_two_fixed_arrays_are_checked_separately() -> None:
    two = from_full_text("pkg/Two", "float64[2] a\nfloat64[2] b\n").message_class("pkg/Two")
    with pytest.raises(genpy.SerializationError):
        two(a=[1.0], b=[1.0, 2.0, 3.0]).__pack__()


def test_short_bytes() -> None:
    with pytest.raises(genpy.DeserializationError, match=r"^unpack requires a buffer of 4 bytes$"):
        UInt32().deserialize(b"\x01")
    with pytest.raises(genpy.DeserializationError):
        JointState.__unpack__(JointState(position=[1.0]).__pack__()[:-1])
    with pytest.raises(genpy.DeserializationError):
        JointState.__unpack__(JointState().__pack__()[:16] + b"\xff\xff\xff\xff")
    # genpy accepts the available part of a truncated string.
    assert String().deserialize(b"\x05\0\0\0ab").data == "ab"


def test_invalid_utf8_is_replaced() -> None:
    assert String.__unpack__(b"\x01\0\0\0\xff").data == "\ufffd"


def test_cached_string_lists_are_not_shared() -> None:
    names = ["a", "b"]
    message = JointState(name=names)
    encoded = message.__pack__()
    decoded = JointState.__unpack__(encoded)
    decoded.name.append("c")
    assert JointState.__unpack__(encoded).name == ["a", "b"]
    names[0] = "changed"
    assert JointState.__unpack__(message.__pack__()).name == ["changed", "b"]
    assert JointState(name=("a", "b")).__pack__() == encoded


def test_bytes_like_input() -> None:
    encoded = String("abc").__pack__()
    assert String().deserialize(bytearray(encoded)).data == "abc"


def test_lists_and_tuples_are_equal() -> None:
    names = JointState(name=["a"], position=[1.0, 2.0])
    decoded = JointState.__unpack__(names.__pack__())
    assert isinstance(decoded.position, tuple)
    assert decoded == names
    assert JointState(position=[1.0]) != JointState(position=(2.0,))


def test_times_do_not_equal_other_objects() -> None:
    assert genpy.TVal(1).__eq__(object()) is False


def test_numpy_scalars_count_as_floats_in_error_texts() -> None:
    import numpy

    for value in (numpy.float32(1), numpy.float64(1), numpy.int32(1), numpy.uint8(1)):
        check_type("x", "float64", value)
    for value in ("1", numpy.str_("1"), None):
        with pytest.raises(genpy.SerializationError, match="field x must be float type"):
            check_type("x", "float64", value)


def test_numpy_msg_returns_one_class_for_a_class(tmp_path: Path) -> None:
    source = """
    from rospy.numpy_msg import numpy_msg
    from rospy_tutorials.msg import Floats
    print(numpy_msg(Floats) is numpy_msg(Floats), isinstance(numpy_msg(Floats)(), Floats))
    """
    assert run_nodes(tmp_path, {"N": source}).printed["N"] == ["True True"]


def test_full_texts_of_services_end_as_in_ros() -> None:
    services = {name: shipped().service_class(name) for name in ("tf/FrameGraph", "tf2_msgs/FrameGraph")}
    texts = [(each._request_class._full_text, each._response_class._full_text) for each in services.values()]
    assert texts == [("", "string dot_graph\n\n"), ("", "string frame_yaml\n\n")]
    level = shipped().service_class("roscpp/SetLoggerLevel")
    assert (level._request_class._full_text, level._response_class._full_text) == ("string logger\nstring level\n", "")

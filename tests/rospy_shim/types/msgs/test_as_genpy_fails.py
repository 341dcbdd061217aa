"""genpy's reactions to values and bytes that do not fit: its written bytes, its read values, its exceptions.

All answers are recorded from genpy 0.6.16 (Debian's python3-genpy), those with arrays of numbers with NumPy 1.26.
"""

from __future__ import annotations

import io
from typing import Any

import numpy
import pytest

from rospy_shim.types import genpy
from rospy_shim.types.msgs import from_full_text, message_class

TEXT = """\
uint8 a
int16 b
string s
float64[3] f3
float64[] f
uint8[] u
std_msgs/Header header
time[] ts
std_msgs/Header[] hs
duration d
"""
HEADER = "=" * 80 + "\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"
LIBRARY = from_full_text("pkg/Mixed", TEXT + HEADER)
Mixed = LIBRARY.message_class("pkg/Mixed")
Header = LIBRARY.message_class("std_msgs/Header")
JointState = message_class("sensor_msgs/JointState")
ONE_TIME = "0100000002000000"


def written(message: Any, module: Any = None) -> tuple[str, str, str]:
    """Kind and text of the error, and the bytes in the buffer."""
    buff = io.BytesIO()
    try:
        message.serialize_numpy(buff, module) if module is not None else message.serialize(buff)
    except Exception as error:
        return type(error).__name__, str(error), buff.getvalue().hex()
    return "", "", buff.getvalue().hex()


@pytest.mark.parametrize(
    ("fields", "kind", "text", "octets"),
    [
        ({"b": 40000}, "SerializationError", "field b exceeds specified width [int16]", ""),
        ({"a": 1, "s": 3}, "SerializationError", "field s must be of type bytes or an ascii string", "010000"),
        (
            {"f3": [1.0]},
            "SerializationError",
            "<class 'struct.error'>: 'pack expected 3 items for packing (got 1)' when writing 'b'''",
            "00" * 7,
        ),
        ({"f": [1.0, "x"]}, "SerializationError", "field f[] must be float type", "00" * 31 + "02000000"),
        ({"u": [1, 300]}, "SerializationError", "field u[] exceeds specified width [uint8]", "00" * 35),
        ({"u": memoryview(b"ab")}, "SerializationError", "field u must be a list or tuple type", "00" * 35),
        (
            {"hs": [Header(frame_id=5)]},
            "SerializationError",
            "field hs[].frame_id must be of type bytes or an ascii string",
            "00" * 59 + "01000000" + "00" * 12,
        ),
        (
            {"hs": [Header(1, genpy.Time(1, 2), "a"), None]},
            "AttributeError",
            "'NoneType' object has no attribute 'seq'",
            "00" * 59 + "02000000" + "01000000" + ONE_TIME + "0100000061",
        ),
        (
            {"ts": [genpy.Time(1, 2), 3]},
            "AttributeError",
            "'int' object has no attribute 'secs'",
            "00" * 55 + "02000000" + ONE_TIME,
        ),
        ({"d": None}, "AttributeError", "'NoneType' object has no attribute 'secs'", "00" * 63),
        ({"d": genpy.Time(1, 2)}, "", "", "00" * 63 + ONE_TIME),
    ],
)
def test_fields_before_the_invalid_one_are_written(fields: dict[str, Any], kind: str, text: str, octets: str) -> None:
    message = Mixed()
    for name, value in fields.items():
        setattr(message, name, value)
    assert written(message) == (kind, text, octets)


@pytest.mark.parametrize(
    ("fields", "kind", "text", "octets"),
    [
        (
            {"f": (1.0, 2.0)},
            "AttributeError",
            "'tuple' object has no attribute 'tostring'",
            "00" * 31 + "02000000",
        ),
        ({"f3": [1.0, 2.0, 3.0]}, "AttributeError", "'list' object has no attribute 'tostring'", "00" * 7),
        ({"f": []}, "AttributeError", "'list' object has no attribute 'tostring'", "00" * 35),
        ({"f3": numpy.array([1.0])}, "", "", "00" * 7 + "000000000000f03f" + "00" * 40),
        ({"f": numpy.array([1, 2], "<i2")}, "", "", "00" * 31 + "02000000" + "01000200" + "00" * 36),
    ],
)
def test_numpy_arrays_are_written_unconverted(fields: dict[str, Any], kind: str, text: str, octets: str) -> None:
    message = Mixed(f3=numpy.zeros(3), f=numpy.zeros(0))
    for name, value in fields.items():
        setattr(message, name, value)
    assert written(message, numpy) == (kind, text, octets)


@pytest.mark.parametrize(
    ("name", "data", "kind", "text"),
    [
        ("std_msgs/Int32", None, TypeError, "'NoneType' object is not subscriptable"),
        ("std_msgs/Int32", "abc", TypeError, "a bytes-like object is required, not 'str'"),
        ("std_msgs/Int32", [1, 2], TypeError, "a bytes-like object is required, not 'list'"),
        ("std_msgs/String", memoryview(b"\1\0\0\0a"), AttributeError, "'memoryview' object has no attribute 'decode'"),
        ("std_msgs/Int32", b"\1", genpy.DeserializationError, "unpack requires a buffer of 4 bytes"),
        ("std_msgs/Header", b"", genpy.DeserializationError, "unpack requires a buffer of 12 bytes"),
    ],
)
def test_invalid_data_is_an_error_of_genpy(name: str, data: Any, kind: type[Exception], text: str) -> None:
    with pytest.raises(kind) as raised:
        message_class(name)().deserialize(data)
    assert str(raised.value) == text


def test_no_data_make_an_empty_message() -> None:
    message_class("std_msgs/Empty")().deserialize(None)


def test_fields_before_the_end_of_the_data_are_read() -> None:
    message = Mixed()
    with pytest.raises(genpy.DeserializationError, match=r"^unpack requires a buffer of 24 bytes$"):
        message.deserialize(b"\1\2\0\3\0\0\0abc")
    assert (message.a, message.b, message.s) == (1, 2, "abc")


def test_octets_keep_the_type_of_their_source() -> None:
    message = message_class("std_msgs/UInt8MultiArray")().deserialize(bytearray(bytes(8) + b"\2\0\0\0ab"))
    assert type(message.data) is bytearray


def test_times_of_the_message_itself_are_normalised() -> None:
    pair = "01000000ffffffff"
    data = bytes.fromhex("00" * 43 + pair + "00" * 4 + "01000000" + pair + "01000000" + "00" * 4 + pair + "00" * 4)
    for message in (Mixed.__unpack__(data + bytes.fromhex(pair)), Mixed().deserialize(data + bytes.fromhex(pair))):
        times = (message.header.stamp, message.ts[0], message.hs[0].stamp, message.d)
        assert [(each.secs, each.nsecs) for each in times] == [(1, 4294967295)] * 3 + [(0, 999999999)]
        assert written(message)[2] == data.hex() + "00000000ffc99a3b"
    header = Header().deserialize(bytes.fromhex("00" * 4 + pair + "00" * 4))
    assert (header.stamp.secs, header.stamp.nsecs) == (5, 294967295)
    span = message_class("std_msgs/Duration").__unpack__(bytes.fromhex("ffffffff01000080"))
    assert (span.data.secs, span.data.nsecs) == (-4, 852516353)


def test_a_tuple_of_strings_cannot_be_printed() -> None:
    assert "name: \n  - a" in str(JointState(name=["a"]))
    with pytest.raises(AssertionError):
        str(JointState(name=("a",)))


def test_kinds_are_compared_by_name() -> None:
    numbers = type("Numbers", (list,), {})
    assert JointState(name=numbers(["a"])) != JointState(name=("a",))
    assert written(JointState(position=numbers(["x"])))[1] == "field position must be a list or tuple type"
    assert written(JointState(position=[numpy.float16(1), "x"]))[1] == "field position[] must be float type"

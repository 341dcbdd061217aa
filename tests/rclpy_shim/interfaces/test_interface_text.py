"""ROS 2's .msg text: fields, defaults, bounds and constants, and the errors of wrong lines."""

from __future__ import annotations

import pytest

from cfepy.status import UsageError
from rclpy_shim.interfaces.interface_text import RosInterface, parse_interface


def parsed(text: str) -> RosInterface:
    return parse_interface(text, "demo_msgs/Demo", "Demo.msg")


def test_field_has_type_name_and_default() -> None:
    (field,) = parsed("int32 count 5  # a comment\n").fields
    assert (field.name, field.base, field.default) == ("count", "int32", 5)


def test_string_default_loses_its_quotes() -> None:
    assert [each.default for each in parsed("string a \"it's\"\nstring b 'x'\nstring c plain\n").fields] == [
        "it's",
        "x",
        "plain",
    ]


def test_array_defaults_are_split_at_commas_outside_of_quotes() -> None:
    (field,) = parsed("string[] names ['a,b', \"c\"]").fields
    assert field.default == ["a,b", "c"]


def test_octet_default_is_a_bytes_object() -> None:
    assert parsed("byte b 7").fields[0].default == b"\x07"


def test_bounds_are_kept() -> None:
    sequence, text = parsed("int32[<=3] values\nstring<=10 name").fields
    assert (sequence.length, sequence.is_bounded, sequence.fixed_length) == (3, True, None)
    assert text.text_bound == 10


def test_bare_type_name_is_of_the_own_package() -> None:
    own, other = parsed("Wheel wheel\ngeometry_msgs/Pose pose").fields
    assert (own.base, other.base) == ("demo_msgs/Wheel", "geometry_msgs/Pose")


def test_constants_have_values() -> None:
    constants = parsed("int8 LOW=-3\nuint8 HEX = 0x10\nstring NAME='x'\nbool ON=true").constants
    assert [(each.name, each.value) for each in constants] == [("LOW", -3), ("HEX", 16), ("NAME", "x"), ("ON", True)]


def test_bus_text_is_in_words_of_ros_1() -> None:
    text = parsed("builtin_interfaces/Time stamp\nstring<=4 name 'x'\nint32[<=3] values\nfloat64[2] pair").bus_text()
    assert text == "time stamp\nstring name\nint32[] values\nfloat64[2] pair\n"


@pytest.mark.parametrize(
    ("line", "error"),
    [
        ("int32", "is not a field"),
        ("int32 Count", "invalid field name 'Count'"),
        ("int32 a__b", "invalid field name 'a__b'"),
        ("int8 x 200", "value 200 of x does not fit into int8"),
        ("int32<=3 x", "only strings have a bound"),
        ("int32[<=] x", "expected a length of at least 1"),
        ("int32[2] x [1]", "must have 2 values, not 1"),
        ("int32[] x 1", "must be in brackets"),
        ("geometry_msgs/Pose x 1", "cannot have a default value"),
        ("int32 low=1", "invalid constant name 'low'"),
        ("bool x maybe", "expected true or false"),
        ("string<=2 x 'abc'", "must have at most 2 characters, not 3"),
    ],
)
def test_wrong_line_is_an_error_with_its_place(line: str, error: str) -> None:
    with pytest.raises(UsageError, match=error) as raised:
        parsed(f"int32 first\n{line}")
    assert "Demo.msg" in str(raised.value)
    assert "2" in str(raised.value)


def test_name_that_is_defined_twice_is_an_error() -> None:
    with pytest.raises(UsageError, match="'a' is defined twice"):
        parsed("int32 a\nint32 a")

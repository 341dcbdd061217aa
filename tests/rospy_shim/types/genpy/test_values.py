"""genpy's functions on values: text with widths and filters, why a field does not fit, plain values into messages.

Expected texts are those of genpy 0.6.16.
"""

from __future__ import annotations

from typing import Any

import pytest

from rospy_shim.types import genpy
from rospy_shim.types.genpy.checks import check_type
from rospy_shim.types.genpy.strify import strify_message
from rospy_shim.types.msgs import make_module, message_class

MESSAGE: Any = make_module("genpy.message")


def pose() -> Any:
    """Return a stamped pose with numbers of several lengths."""
    made = message_class("geometry_msgs/PoseStamped")()
    made.header.seq, made.header.stamp = 7, genpy.Time(12, 42507489)
    made.pose.position.x, made.pose.position.y = -123.456789, 1e20
    return made


def test_width() -> None:
    lines = strify_message(pose(), fixed_numeric_width=5).split("\n")
    assert lines[1:4] == ["  seq:     7", "  stamp: ", "    secs:    12"]
    assert lines[4:6] == ["    nsecs: 42507489", "  frame_id: ''"]
    assert lines[8:11] == ["    x: -123.", "    y: 100000000000000000000", "    z: 0.000"]
    joints = message_class("sensor_msgs/JointState")(position=[1.5, -2.0])
    assert "position: [1.5, -2.]" in strify_message(joints, fixed_numeric_width=3)


def test_filter_selects_but_does_not_order() -> None:
    text = strify_message(pose().header, field_filter=lambda message: ["frame_id", "seq"])
    assert text == "seq: 7\nframe_id: ''"


@pytest.mark.parametrize(
    ("kind", "value", "problem"),
    [
        ("geometry_msgs/Point", "x", "field f must be of type [geometry_msgs/Point]"),
        (
            "geometry_msgs/Point",
            pose(),
            "field f must be of type geometry_msgs/Point instead of geometry_msgs/PoseStamped",
        ),
        ("geometry_msgs/Point", pose().header, "field f must be a Header instead of a std_msgs/Header"),
        ("string", "\u4eca", "field f is a non-ascii string"),
    ],
)
def test_error_explains_why_a_field_does_not_fit(kind: str, value: Any, problem: str) -> None:
    with pytest.raises(genpy.SerializationError) as found:
        check_type("f", kind, value)
    assert str(found.value) == problem


def filled(name: str, arguments: Any, keys: Any = None) -> Any:
    """Return a message of a type with plain values."""
    made = message_class(name)()
    MESSAGE.fill_message_args(made, arguments, keys or {})
    return made


def test_values_of_all_kinds() -> None:
    keys = {"now": genpy.Time(9, 9), "auto": message_class("std_msgs/Header")(frame_id="AUTO")}
    header = filled("std_msgs/Header", [1, "now", "f"], keys)
    assert (header.stamp, header.frame_id) == (genpy.Time(9, 9), "f")
    assert filled("geometry_msgs/PoseStamped", [{"header": "auto"}], keys).header.frame_id == "AUTO"
    assert filled("std_msgs/Time", [1_500_000_000]).data == genpy.Time(1, 500_000_000)
    assert filled("std_msgs/String", [{"data": None}]).data == ""
    assert filled("std_msgs/String", [None]).data is None
    assert filled("std_msgs/Empty", None) == message_class("std_msgs/Empty")()
    path = filled("nav_msgs/Path", [{"poses": [{"header": {"seq": 3}}, {}]}])
    assert [each.header.seq for each in path.poses] == [3, 0]


@pytest.mark.parametrize(
    ("name", "arguments", "error", "problem"),
    [
        ("std_msgs/Header", [1, "later", ""], genpy.MessageException, "No key named [later]"),
        ("std_msgs/Header", [{"stamp": None}], genpy.MessageException, "No key named []"),
        ("std_msgs/Header", [1, None, ""], ValueError, "invalid msg_args type: None"),
        ("std_msgs/Header", [{"nope": 1}], genpy.MessageException, "No field name [nope]"),
        (
            "tf2_msgs/TFMessage",
            [[{"transform": {"nope": 1}}]],
            genpy.MessageException,
            "No field name [transform.nope]",
        ),
        (
            "nav_msgs/Path",
            [{"poses": 3}],
            genpy.MessageException,
            "Field [poses] must be a list or tuple instead of: int",
        ),
        (
            "geometry_msgs/PoseWithCovariance",
            [{"covariance": [1]}],
            genpy.MessageException,
            "Field [covariance] has incorrect number of elements: 1 != 36",
        ),
        (
            "std_msgs/String",
            [1, 2],
            genpy.MessageException,
            "Too many arguments:\n * Given: [1, 2]\n * Expected: ['data']",
        ),
    ],
)
def test_values_that_do_not_fit_are_refused(name: str, arguments: Any, error: type[Exception], problem: str) -> None:
    with pytest.raises(error) as found:
        filled(name, arguments)
    assert str(found.value) == problem


def test_classes_of_times() -> None:
    assert MESSAGE.get_message_class("time") is genpy.Time
    assert MESSAGE.get_message_class("duration") is genpy.Duration

"""ROS messages from JSON."""

from __future__ import annotations

import math
from typing import Any

import pytest

from cfepy.ground import message_from_json
from rospy_shim.types.msgs import message_class


def made(kind: str, value: Any) -> Any:
    """Return the message, through its bytes."""
    message = message_from_json(message_class, kind, value)
    return type(message)().deserialize(message.__pack__())


def test_messages_in_messages() -> None:
    message = made("geometry_msgs/Twist", {"linear": {"x": 1, "z": 2.5}, "angular": {}})
    assert (message.linear.x, message.linear.y, message.linear.z, message.angular.x) == (1.0, 0.0, 2.5, 0.0)


@pytest.mark.parametrize("words", [("sec", "nsec"), ("secs", "nsecs"), ("sec", "nanosec")])
def test_times(words: tuple[str, str]) -> None:
    message = made("std_msgs/Header", {"stamp": dict(zip(words, (5, 7), strict=True)), "frame_id": "base"})
    assert (message.stamp.secs, message.stamp.nsecs, message.frame_id) == (5, 7, "base")


def test_arrays() -> None:
    assert made("std_msgs/UInt8MultiArray", {"data": "AQID"}).data == b"\x01\x02\x03"
    assert made("std_msgs/UInt8MultiArray", {"data": [1, 2, 255]}).data == b"\x01\x02\xff"
    assert list(made("std_msgs/Float64MultiArray", {"data": [1, 2.5]}).data) == [1.0, 2.5]
    path = made("nav_msgs/Path", {"poses": [{"pose": {"position": {"x": 1}}}, {}]})
    assert [each.pose.position.x for each in path.poses] == [1.0, 0.0]


def test_not_a_number_becomes_null() -> None:
    assert math.isnan(made("std_msgs/Float64", {"data": None}).data)


@pytest.mark.parametrize(
    ("kind", "value", "why"),
    [
        ("std_msgs/String", [], r"std_msgs/String: \[\] is not an object"),
        ("std_msgs/String", {"dat": ""}, "std_msgs/String: unknown field 'dat'; did you mean data"),
        ("std_msgs/String", {"data": 5}, "std_msgs/String.data: 5 is not a text"),
        ("std_msgs/Int32", {"data": 1.5}, "std_msgs/Int32.data: 1.5 is not a valid int32"),
        ("std_msgs/Int32", {"data": "1"}, "std_msgs/Int32.data: '1' is not a valid int32"),
        ("std_msgs/Int32", {"data": float("inf")}, "std_msgs/Int32.data: inf is not a valid int32"),
        ("std_msgs/Int32", {"data": None}, "std_msgs/Int32.data: None is not a valid int32"),
        ("geometry_msgs/Twist", {"linear": {"x": {}}}, "geometry_msgs/Twist.linear.x: {} is not a valid float64"),
        ("std_msgs/UInt8MultiArray", {"data": "?"}, "std_msgs/UInt8MultiArray.data: "),
        ("std_msgs/UInt8MultiArray", {"data": [256]}, "an item is not a valid uint8"),
        ("std_msgs/Float64MultiArray", {"data": 5}, "5 is not an array"),
        ("geometry_msgs/PoseWithCovariance", {"covariance": [1.0]}, "must have 36 items, not 1"),
        ("std_msgs/Header", {"stamp": 5}, "std_msgs/Header.stamp: 5 is not like"),
        ("std_msgs/Header", {"stamp": {"sec": "1"}}, "is not like"),
    ],
)
def test_invalid_value_is_reported_with_its_path(kind: str, value: Any, why: str) -> None:
    with pytest.raises(ValueError, match=why):
        message_from_json(message_class, kind, value)

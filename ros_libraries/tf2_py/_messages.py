"""Conversion between messages and numbers: times in ns, transforms as seven floats.

Imports rospy, geometry_msgs and tf2_py.

Times are converted through a float of seconds, as in tf2's Python module, so a stamp loses the precision that a float
cannot hold.
"""

from __future__ import annotations

import warnings
from math import floor, isfinite
from typing import Any

import rospy
from geometry_msgs.msg import Quaternion, TransformStamped, Vector3

from tf2_py._process_end import part_of, terminate
from tf2_py._rotation import Rigid

_NS_PER_S = 1_000_000_000
_TIMES = range(2**32)  # seconds of ros::Time
_DURATIONS = range(-(2**31), 2**31)
_RANGE_ERROR = "std::runtime_error"
_NOT_A_NUMBER = -1.0  # Python's result of an object that is no number, if the caller does not look for an error


def to_ns(time: Any) -> int:
    """Return a rospy.Time in ns. One that ros::Time cannot hold, such as a time below zero, ends the process.

    Raises:
        TypeError: it has no time.
    """
    return _in_ns(time, _TIMES, "Time")


def duration_to_ns(duration: Any) -> int:
    """Return a rospy.Duration in ns. One that ros::Duration cannot hold ends the process.

    Raises:
        TypeError: it has no time.
    """
    return _in_ns(duration, _DURATIONS, "Duration")


def _in_ns(time: Any, possible: range, kind: str) -> int:
    try:
        value = time.to_sec()
    except Exception:
        raise TypeError("time must have a to_sec method, e.g. rospy.Time or rospy.Duration") from None
    value = _number(value)
    if not isfinite(value):
        terminate(_RANGE_ERROR, f"{kind} is out of dual 32-bit range")
    whole = floor(value)
    ns = whole * _NS_PER_S + floor((value - whole) * 1e9 + 0.5)
    if ns // _NS_PER_S not in possible:
        terminate(_RANGE_ERROR, f"{kind} is out of dual 32-bit range")
    return ns


def _number(value: Any) -> float:
    return float(value) if _is_number(value) else _NOT_A_NUMBER


def time_of(ns: int) -> Any:
    """Return a rospy.Time."""
    return rospy.Time(*divmod(ns, _NS_PER_S))


def rigid_of(transform: Any) -> tuple[Rigid, bool]:
    """Return the numbers of a geometry_msgs/Transform, or of an object with the same attributes.

    Returns:
        the numbers, -1 for each part that is none, and True if the rotation has such a part, which C++ does not forget.
    """
    t, r = part_of(transform, "translation"), part_of(transform, "rotation")
    for part, value, kind in (("translation", t, Vector3), ("rotation", r, Quaternion)):
        if not isinstance(value, kind):
            warnings.warn(f"{part} should be of type {kind.__name__}", UserWarning, stacklevel=4)
    try:
        numbers = t.x, t.y, t.z, r.x, r.y, r.z, r.w
    except AttributeError as error:
        part, names = ("translation", "x, y, z") if error.obj is t else ("rotation", "w, x, y, z")
        raise TypeError(f"transform.{part} must have members {names}") from None
    x, y, z, qx, qy, qz, qw = map(_number, numbers)
    return (x, y, z, qx, qy, qz, qw), not all(map(_is_number, numbers[3:]))


def _is_number(value: Any) -> bool:
    try:
        float(value)
    except (TypeError, ValueError, OverflowError):
        return False
    return not isinstance(value, str)


def message_of(target: str, source: str, time: int, rigid: Rigid) -> Any:
    """Return a lookup's result as a geometry_msgs/TransformStamped."""
    found = TransformStamped()
    header, transform = found.header, found.transform
    header.stamp = time_of(time)
    header.frame_id = target
    found.child_frame_id = source
    t, r = transform.translation, transform.rotation
    t.x, t.y, t.z, r.x, r.y, r.z, r.w = rigid
    return found

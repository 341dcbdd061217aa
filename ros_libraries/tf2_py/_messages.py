"""Conversion between messages and numbers: times in ns, transforms as seven floats.

Imports rospy, geometry_msgs and tf2_py.

Times are converted through a float of seconds, as in tf2's Python module, so a stamp loses the precision that a float
cannot hold.
"""

from __future__ import annotations

import warnings
from math import floor
from typing import Any

import rospy
from geometry_msgs.msg import Quaternion, TransformStamped, Vector3

from tf2_py._rotation import Rigid

_NS_PER_S = 1_000_000_000


def to_ns(time: Any) -> int:
    """Return a rospy.Time or rospy.Duration in ns.

    Raises:
        TypeError: it is neither.
    """
    try:
        value: float = time.to_sec()
    except AttributeError:
        raise TypeError("time must have a to_sec method, e.g. rospy.Time or rospy.Duration") from None
    whole = floor(value)
    return whole * _NS_PER_S + floor((value - whole) * 1e9 + 0.5)


def time_of(ns: int) -> Any:
    """Return a rospy.Time."""
    return rospy.Time(*divmod(ns, _NS_PER_S))


def rigid_of(transform: Any) -> Rigid:
    """Return the numbers of a geometry_msgs/Transform, or of an object with the same attributes."""
    t, r = transform.translation, transform.rotation
    for part, value, kind in (("translation", t, Vector3), ("rotation", r, Quaternion)):
        if not isinstance(value, kind):
            warnings.warn(f"{part} should be of type {kind.__name__}", UserWarning, stacklevel=4)
    try:
        numbers = t.x, t.y, t.z, r.x, r.y, r.z, r.w
    except AttributeError as error:
        part, names = ("translation", "x, y, z") if error.obj is t else ("rotation", "w, x, y, z")
        raise TypeError(f"transform.{part} must have members {names}") from None
    x, y, z, qx, qy, qz, qw = map(float, numbers)
    return x, y, z, qx, qy, qz, qw


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

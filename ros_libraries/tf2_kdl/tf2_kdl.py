"""The conversions that `tf2_kdl` registers. The objects have a header, as `tf2_ros.Stamped` makes it."""

from __future__ import annotations

from typing import Any

import PyKDL
import tf2_ros
from geometry_msgs.msg import PointStamped
from tf2_geometry_msgs.tf2_geometry_msgs import transform_to_kdl


def _moved(value: Any, transform: Any) -> Any:
    result = transform_to_kdl(transform) * value
    result.header = transform.header
    return result


def do_transform_vector(vector: PyKDL.Vector, transform: Any) -> Any:
    """Return a vector as seen from another frame.

    It gets the header of `transform`, a geometry_msgs/TransformStamped.
    """
    return _moved(vector, transform)


def do_transform_frame(frame: PyKDL.Frame, transform: Any) -> Any:
    """Return a frame as seen from another one; see `do_transform_vector`."""
    return _moved(frame, transform)


def do_transform_twist(twist: PyKDL.Twist, transform: Any) -> Any:
    """Return a twist as seen from another frame; see `do_transform_vector`."""
    return _moved(twist, transform)


def do_transform_wrench(wrench: PyKDL.Wrench, transform: Any) -> Any:
    """Return a wrench as seen from another frame; see `do_transform_vector`."""
    return _moved(wrench, transform)


def to_msg_vector(vector: Any) -> Any:
    """Return the geometry_msgs/PointStamped of a vector with a header."""
    msg = PointStamped(header=vector.header)
    msg.point.x, msg.point.y, msg.point.z = vector[0], vector[1], vector[2]
    return msg


def from_msg_vector(msg: Any) -> Any:
    """Vector with a header of a geometry_msgs/PointStamped."""
    vector = PyKDL.Vector(msg.point.x, msg.point.y, msg.point.z)
    return tf2_ros.Stamped(vector, msg.header.stamp, msg.header.frame_id)


def convert_vector(vector: Any) -> Any:
    """Return a copy of a vector with a header."""
    return tf2_ros.Stamped(PyKDL.Vector(vector), vector.header.stamp, vector.header.frame_id)


tf2_ros.TransformRegistration().add(PyKDL.Vector, do_transform_vector)
tf2_ros.TransformRegistration().add(PyKDL.Frame, do_transform_frame)
tf2_ros.TransformRegistration().add(PyKDL.Twist, do_transform_twist)
tf2_ros.TransformRegistration().add(PyKDL.Wrench, do_transform_wrench)
tf2_ros.ConvertRegistration().add_to_msg(PyKDL.Vector, to_msg_vector)
tf2_ros.ConvertRegistration().add_from_msg(PyKDL.Vector, from_msg_vector)
tf2_ros.ConvertRegistration().add_convert((PyKDL.Vector, PyKDL.Vector), convert_vector)

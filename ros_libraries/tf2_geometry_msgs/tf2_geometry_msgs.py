"""Transforms messages of geometry_msgs (tf2_geometry_msgs), without PyKDL but with its arithmetic.

Each function takes a stamped message and a geometry_msgs/TransformStamped, and returns a new message with the header
of the transform. Imports geometry_msgs and tf2_ros.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

import tf2_ros
from geometry_msgs.msg import PointStamped, PoseStamped, Vector3Stamped, WrenchStamped

Row = tuple[float, float, float]
Rows = tuple[Row, Row, Row]
_TRACE = 1e-12  # above it a rotation is not near half a turn


def to_msg_msg(msg: Any) -> Any:
    """Return the message unchanged."""
    return msg


def from_msg_msg(msg: Any) -> Any:
    """Return the message unchanged."""
    return msg


def transform_to_kdl(t: Any) -> Any:
    """Return the PyKDL.Frame of a geometry_msgs/TransformStamped."""
    import PyKDL

    rotation, place = t.transform.rotation, t.transform.translation
    turned = PyKDL.Rotation.Quaternion(rotation.x, rotation.y, rotation.z, rotation.w)
    return PyKDL.Frame(turned, PyKDL.Vector(place.x, place.y, place.z))


def do_transform_point(point: Any, transform: Any) -> Any:
    """Return a geometry_msgs/PointStamped, turned and moved."""
    found = PointStamped(header=transform.header)
    t = transform.transform.translation
    x, y, z = _turned(_rows(transform.transform.rotation), point.point)
    found.point.x, found.point.y, found.point.z = x + t.x, y + t.y, z + t.z
    return found


def do_transform_vector3(vector3: Any, transform: Any) -> Any:
    """Return a geometry_msgs/Vector3Stamped, turned."""
    found = Vector3Stamped(header=transform.header)
    found.vector.x, found.vector.y, found.vector.z = _turned(_rows(transform.transform.rotation), vector3.vector)
    return found


def do_transform_pose(pose: Any, transform: Any) -> Any:
    """Return a geometry_msgs/PoseStamped, turned and moved."""
    found = PoseStamped(header=transform.header)
    rows, t = _rows(transform.transform.rotation), transform.transform.translation
    x, y, z = _turned(rows, pose.pose.position)
    found.pose.position.x, found.pose.position.y, found.pose.position.z = x + t.x, y + t.y, z + t.z
    turn = found.pose.orientation
    turn.x, turn.y, turn.z, turn.w = _quaternion(_product(rows, _rows(pose.pose.orientation)))
    return found


def do_transform_wrench(wrench: Any, transform: Any) -> Any:
    """Return a geometry_msgs/WrenchStamped: force and torque are turned, the point where they act stays."""
    found = WrenchStamped(header=transform.header)
    found.wrench.force = do_transform_vector3(Vector3Stamped(vector=wrench.wrench.force), transform).vector
    found.wrench.torque = do_transform_vector3(Vector3Stamped(vector=wrench.wrench.torque), transform).vector
    return found


def _rows(q: Any) -> Rows:
    """Return the rotation matrix of a quaternion of length 1."""
    x, y, z, w = q.x, q.y, q.z, q.w
    xx, yy, zz, ww = x * x, y * y, z * z, w * w
    return (
        (ww + xx - yy - zz, 2 * x * y - 2 * w * z, 2 * x * z + 2 * w * y),
        (2 * x * y + 2 * w * z, ww - xx + yy - zz, 2 * y * z - 2 * w * x),
        (2 * x * z - 2 * w * y, 2 * y * z + 2 * w * x, ww - xx - yy + zz),
    )


def _turned(rows: Rows, v: Any) -> Row:
    (a, b, c), (d, e, f), (g, h, i) = rows
    return a * v.x + b * v.y + c * v.z, d * v.x + e * v.y + f * v.z, g * v.x + h * v.y + i * v.z


def _product(left: Rows, right: Rows) -> Rows:
    def row(of: Row) -> Row:
        a, b, c = (of[0] * x + of[1] * y + of[2] * z for x, y, z in zip(*right, strict=True))
        return a, b, c

    return row(left[0]), row(left[1]), row(left[2])


def _quaternion(rows: Rows) -> tuple[float, float, float, float]:
    """Return the quaternion of a rotation matrix, with the sign that KDL gives it."""
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = rows
    trace = xx + yy + zz
    if trace > _TRACE:
        s = 0.5 / sqrt(trace + 1.0)
        return (zy - yz) * s, (xz - zx) * s, (yx - xy) * s, 0.25 / s
    if xx > yy and xx > zz:
        s = 2.0 * sqrt(1.0 + xx - yy - zz)
        return 0.25 * s, (xy + yx) / s, (xz + zx) / s, (zy - yz) / s
    if yy > zz:
        s = 2.0 * sqrt(1.0 + yy - xx - zz)
        return (xy + yx) / s, 0.25 * s, (yz + zy) / s, (xz - zx) / s
    s = 2.0 * sqrt(1.0 + zz - xx - yy)
    return (xz + zx) / s, (yz + zy) / s, 0.25 * s, (yx - xy) / s


for _kind, _apply in (
    (PointStamped, do_transform_point),
    (Vector3Stamped, do_transform_vector3),
    (PoseStamped, do_transform_pose),
    (WrenchStamped, do_transform_wrench),
):
    tf2_ros.TransformRegistration().add(_kind, _apply)
    if _kind is not WrenchStamped:
        tf2_ros.ConvertRegistration().add_to_msg(_kind, to_msg_msg)
        tf2_ros.ConvertRegistration().add_from_msg(_kind, from_msg_msg)

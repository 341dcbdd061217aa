"""Conversions of poses from and to `PyKDL.Frame`."""

from __future__ import annotations

from typing import Any

import numpy
from geometry_msgs.msg import Point, Pose, Quaternion
from PyKDL import *  # noqa: F403
from PyKDL import Frame, Rotation, Vector

Pair = tuple[tuple[float, float, float], tuple[float, float, float, float]]


def fromTf(tf: Any) -> Frame:
    """Return the frame of a pair (position, quaternion), as `tf.Transformer.lookupTransform` returns it."""
    position, quaternion = tf
    return Frame(Rotation.Quaternion(*quaternion), Vector(*position))


def toTf(f: Frame) -> Pair:
    """(position, quaternion) of a frame."""
    return (f.p[0], f.p[1], f.p[2]), f.M.GetQuaternion()


def fromMsg(p: Any) -> Frame:
    """Return the frame of a geometry_msgs/Pose."""
    q = p.orientation
    return Frame(Rotation.Quaternion(q.x, q.y, q.z, q.w), Vector(p.position.x, p.position.y, p.position.z))


def toMsg(f: Frame) -> Any:
    """Return the geometry_msgs/Pose of a frame."""
    position, quaternion = toTf(f)
    return Pose(Point(*position), Quaternion(*quaternion))


def fromMatrix(m: Any) -> Frame:
    """Return the frame of a 4x4 array."""
    return Frame(Rotation(*(m[i, j] for i in range(3) for j in range(3))), Vector(*(m[i, 3] for i in range(3))))


def toMatrix(f: Frame) -> Any:
    """4x4 array of a frame."""
    return numpy.array([*([f[i, j] for j in range(4)] for i in range(3)), [0, 0, 0, 1]])


def fromCameraParams(cv: Any, rvec: Any, tvec: Any) -> Frame:
    """Return the frame of OpenCV's extrinsic camera parameters.

    Args:
        cv: the OpenCV module, which has Rodrigues or, in old versions, Rodrigues2.
        rvec: rotation vector, 3x1.
        tvec: translation, 3x1, in m.
    """
    matrix = numpy.zeros((4, 4), dtype=numpy.float32)
    matrix[:3, 3], matrix[3, 3] = [tvec[i, 0] for i in range(3)], 1.0
    if hasattr(cv, "Rodrigues2"):
        cv.Rodrigues2(rvec, matrix[:3, :3])
    else:
        matrix[:3, :3] = cv.Rodrigues(rvec)[0]
    return fromMatrix(matrix)

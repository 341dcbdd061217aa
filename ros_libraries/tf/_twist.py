"""The arithmetic of `Transformer.lookupTwistFull`: from poses to velocities. Imports NumPy and tf.transformations."""

from __future__ import annotations

from typing import Any

import numpy as np

from tf.transformations import quaternion_matrix, rotation_from_matrix, translation_matrix

Pose = tuple[list[float], list[float]]


def between_poses(start: Pose, end: Pose, seconds: float) -> tuple[Any, Any]:
    """Return the linear and angular velocity of a frame that got from one pose to another.

    Args:
        start: translation and rotation (x, y, z, w).
        end: the same, later.
        seconds: how much later.
    """
    turn = np.linalg.inv(quaternion_matrix(start[1])) @ quaternion_matrix(end[1])
    angle, axis, _ = rotation_from_matrix(turn)
    return (np.subtract(end[0], start[0]) / seconds), axis * (angle / seconds)


def shifted(velocity: tuple[Any, Any], tracked: Pose, point: Pose) -> tuple[Any, Any]:
    """Return a velocity expressed in another frame, of another point.

    Args:
        velocity: linear and angular.
        tracked: pose of the moving frame in the other frame.
        point: pose of the point in the other frame.

    The last step is tf's: it adds a number where a cross product would be right. For a point other than the tracked
    frame's origin, the result is the same as tf's.
    """
    turn = quaternion_matrix(tracked[1])[:3, :3]
    angular = turn @ velocity[1]
    linear = turn @ velocity[0] + np.cross(tracked[0], angular)
    origin = np.array((*tracked[0], 1.0))
    wanted = translation_matrix(point[0]) @ quaternion_matrix(point[1]) @ origin
    linear = linear + angular @ (wanted - origin)[:3]
    return tuple(linear.tolist()), tuple(angular.tolist())

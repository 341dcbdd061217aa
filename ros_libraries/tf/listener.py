"""`TransformerROS` transforms messages, `TransformListener` also listens to transforms (tf.listener).

Imports geometry_msgs, sensor_msgs and tf2_ros; NumPy, by way of `tf.transformations`, when it is first needed.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import tf2_ros
from geometry_msgs.msg import (
    Point,
    PointStamped,
    Pose,
    PoseStamped,
    Quaternion,
    QuaternionStamped,
    Vector3,
    Vector3Stamped,
)
from sensor_msgs.msg import PointCloud

from tf._transformer import Transformer, strip_leading_slash

__all__ = [
    "TransformListener",
    "Transformer",
    "TransformerROS",
    "strip_leading_slash",
    "xyz_to_mat44",
    "xyzw_to_mat44",
]


def xyz_to_mat44(pos: Any) -> Any:
    """Return the matrix of a message with x, y, z."""
    from tf import transformations

    return transformations.translation_matrix((pos.x, pos.y, pos.z))


def xyzw_to_mat44(ori: Any) -> Any:
    """Return the matrix of a message with x, y, z, w."""
    from tf import transformations

    return transformations.quaternion_matrix((ori.x, ori.y, ori.z, ori.w))


class TransformerROS(Transformer):
    """A `Transformer` that also transforms messages.

    Each `transform...` takes a frame's name and a stamped message. It returns a new message as seen from that frame,
    with the old stamp. Errors are those of `lookupTransform`.
    """

    def asMatrix(self, target_frame: str, hdr: Any) -> Any:
        """Return the 4x4 matrix (numpy.ndarray) that takes coordinates in a header's frame to the target frame."""
        return self.fromTranslationRotation(*self.lookupTransform(target_frame, hdr.frame_id, hdr.stamp))

    def fromTranslationRotation(self, translation: Sequence[float], rotation: Sequence[float]) -> Any:
        """Return the 4x4 matrix (numpy.ndarray) of a translation (x, y, z) and a rotation (x, y, z, w)."""
        from tf import transformations

        return transformations.translation_matrix(translation) @ transformations.quaternion_matrix(rotation)

    def transformPoint(self, target_frame: str, ps: Any) -> Any:
        """Return a geometry_msgs/PointStamped."""
        found = PointStamped(point=_moved(self.asMatrix(target_frame, ps.header), ps.point, Point))
        return _stamped(found, target_frame, ps)

    def transformVector3(self, target_frame: str, v3s: Any) -> Any:
        """Return a geometry_msgs/Vector3Stamped: it is turned, not moved."""
        matrix = self.asMatrix(target_frame, v3s.header)
        matrix[:3, 3] = 0.0
        return _stamped(Vector3Stamped(vector=_moved(matrix, v3s.vector, Vector3)), target_frame, v3s)

    def transformQuaternion(self, target_frame: str, ps: Any) -> Any:
        """Return a geometry_msgs/QuaternionStamped."""
        matrix = self.asMatrix(target_frame, ps.header) @ xyzw_to_mat44(ps.quaternion)
        return _stamped(QuaternionStamped(quaternion=_orientation(matrix)), target_frame, ps)

    def transformPose(self, target_frame: str, ps: Any) -> Any:
        """Return a geometry_msgs/PoseStamped."""
        matrix = self.asMatrix(target_frame, ps.header)
        matrix = matrix @ (xyz_to_mat44(ps.pose.position) @ xyzw_to_mat44(ps.pose.orientation))
        pose = Pose(Point(*matrix[:3, 3].tolist()), _orientation(matrix))
        return _stamped(PoseStamped(pose=pose), target_frame, ps)

    def transformPointCloud(self, target_frame: str, point_cloud: Any) -> Any:
        """Transform a sensor_msgs/PointCloud. Its points become geometry_msgs/Point, as in tf."""
        matrix = self.asMatrix(target_frame, point_cloud.header)
        points = [_moved(matrix, point, Point) for point in point_cloud.points]
        return _stamped(PointCloud(points=points, channels=point_cloud.channels), target_frame, point_cloud)


def _moved(matrix: Any, point: Any, kind: Any) -> Any:
    return kind(*(matrix @ (point.x, point.y, point.z, 1.0))[:3].tolist())


def _orientation(matrix: Any) -> Any:
    from tf import transformations

    return Quaternion(*transformations.quaternion_from_matrix(matrix).tolist())


def _stamped(found: Any, frame: str, original: Any) -> Any:
    found.header.stamp = original.header.stamp
    found.header.frame_id = frame
    return found


class TransformListener(TransformerROS):
    """A `TransformerROS` that listens to /tf and /tf_static. The arguments are those of `Transformer`."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._listener = tf2_ros.TransformListener(self._buffer)
        self.setUsingDedicatedThread(True)

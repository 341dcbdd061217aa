"""`tf.TransformBroadcaster`: publishes a transform on /tf (tf.broadcaster). Imports geometry_msgs and tf2_ros."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from std_msgs.msg import Header
from tf2_ros.transform_broadcaster import TransformBroadcaster as Tf2Broadcaster


class TransformBroadcaster:
    """Publishes transforms as they change.

    Args:
        queue_size: without effect, as in tf.
    """

    def __init__(self, queue_size: int = 100) -> None:
        self.tf2_broadcaster = Tf2Broadcaster()

    def sendTransform(
        self, translation: Sequence[float], rotation: Sequence[float], time: Any, child: str, parent: str
    ) -> None:
        """Publish where a frame is.

        Args:
            translation: (x, y, z) of its origin in the parent frame.
            rotation: (x, y, z, w), a quaternion.
            time: a rospy.Time.
            child: name of the frame.
            parent: name of the frame that it is in.
        """
        x, y, z = translation[:3]
        qx, qy, qz, qw = rotation[:4]
        transform = Transform(Vector3(x, y, z), Quaternion(qx, qy, qz, qw))
        self.sendTransformMessage(TransformStamped(Header(stamp=time, frame_id=parent), child, transform))

    def sendTransformMessage(self, transform: Any) -> None:
        """Publish a geometry_msgs/TransformStamped."""
        self.tf2_broadcaster.sendTransform([transform])

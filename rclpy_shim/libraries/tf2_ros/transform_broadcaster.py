"""`TransformBroadcaster`: publishes transforms on /tf (tf2_ros.transform_broadcaster)."""

from __future__ import annotations

from typing import Any

from rclpy.qos import QoSProfile
from tf2_msgs.msg import TFMessage


class TransformBroadcaster:
    """Publishes transforms.

    Args:
        node: its node.
        qos: quality of service, or depth; None for a depth of 100.
    """

    def __init__(self, node: Any, qos: QoSProfile | int | None = None) -> None:
        self.pub_tf = node.create_publisher(TFMessage, "/tf", QoSProfile(depth=100) if qos is None else qos)

    def sendTransform(self, transform: Any) -> None:
        """Publish a transform, or several.

        Args:
            transform: geometry_msgs/TransformStamped, or an iterable of them.
        """
        self.pub_tf.publish(TFMessage(transforms=as_list(transform)))


def as_list(transform: Any) -> list[Any]:
    """Return a list of transforms from one or several."""
    return list(transform) if hasattr(transform, "__iter__") else [transform]

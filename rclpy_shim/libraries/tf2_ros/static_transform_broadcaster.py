"""`StaticTransformBroadcaster`: publishes transforms on /tf_static (tf2_ros.static_transform_broadcaster)."""

from __future__ import annotations

from typing import Any

from rclpy.qos import DurabilityPolicy, QoSProfile
from tf2_msgs.msg import TFMessage

from tf2_ros.transform_broadcaster import as_list


class StaticTransformBroadcaster:
    """Publishes static transforms, all of them in each message. The first transform of a frame stays.

    Args:
        node: its node.
        qos: quality of service, or depth; None for a depth of 1, transient local.
    """

    def __init__(self, node: Any, qos: QoSProfile | int | None = None) -> None:
        usual = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.pub_tf = node.create_publisher(TFMessage, "/tf_static", usual if qos is None else qos)
        self.net_message = TFMessage()
        self._child_frame_ids: set[str] = set()

    def sendTransform(self, transform: Any) -> None:
        """Publish a transform, or several, with all earlier ones.

        Args:
            transform: geometry_msgs/TransformStamped, or an iterable of them.
        """
        for each in as_list(transform):
            if each.child_frame_id not in self._child_frame_ids:
                self._child_frame_ids.add(each.child_frame_id)
                self.net_message.transforms.append(each)
        self.pub_tf.publish(self.net_message)

"""`TransformBroadcaster`: publishes transforms on /tf (tf2_ros.transform_broadcaster). Imports rospy and tf2_msgs."""

from __future__ import annotations

from typing import Any

import rospy
from tf2_msgs.msg import TFMessage


class TransformBroadcaster:
    """Publishes transforms as they change."""

    def __init__(self) -> None:
        self.pub_tf = rospy.Publisher("/tf", TFMessage, queue_size=100)

    def sendTransform(self, transform: Any) -> None:
        """Publish a geometry_msgs/TransformStamped, or a list of them."""
        self.pub_tf.publish(TFMessage(transform if isinstance(transform, list) else [transform]))

"""`StaticTransformBroadcaster`: publishes transforms on /tf_static (tf2_ros.static_transform_broadcaster).

Imports rospy and tf2_msgs.
"""

from __future__ import annotations

from typing import Any

import rospy
from tf2_msgs.msg import TFMessage


class StaticTransformBroadcaster:
    """Publishes transforms that do not change. A later listener gets those of the last call."""

    def __init__(self) -> None:
        self.pub_tf = rospy.Publisher("/tf_static", TFMessage, queue_size=100, latch=True)

    def sendTransform(self, transform: Any) -> None:
        """Publish a geometry_msgs/TransformStamped, or a list of them."""
        self.pub_tf.publish(TFMessage(transform if isinstance(transform, list) else [transform]))

"""rospy.impl.tcpros_pubsub: the constants of ROS's transport for messages, which go over the Software Bus."""

from __future__ import annotations

from rospy.impl.tcpros_base import TCPROS
from rospy.topics import DEFAULT_BUFF_SIZE

__all__ = ["DEFAULT_BUFF_SIZE", "TCPROS"]

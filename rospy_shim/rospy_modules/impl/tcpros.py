"""rospy.impl.tcpros: what is left of ROS's transport where messages go over the Software Bus."""

from __future__ import annotations

from rospy.topics import DEFAULT_BUFF_SIZE

__all__ = ["DEFAULT_BUFF_SIZE"]

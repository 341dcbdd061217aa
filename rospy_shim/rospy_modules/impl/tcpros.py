"""rospy.impl.tcpros: the constant of ROS's transport; messages go over the Software Bus."""

from __future__ import annotations

from rospy.topics import DEFAULT_BUFF_SIZE

__all__ = ["DEFAULT_BUFF_SIZE"]

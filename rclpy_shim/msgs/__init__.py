"""ROS 2 message types in memory: definitions, generated classes, and the modules that nodes import them from.

    >>> from rclpy_shim.msgs import Interfaces
    >>> Interfaces().message_class("std_msgs/String")(data="hello")
    std_msgs.msg.String(data='hello')

Code belongs here if it defines ROS 2's message types. Their bytes on the Software Bus are those of ROS 1
(`rospy_shim.types.msgs`). The central file is `rclpy_shim/msgs/interfaces.py`.
"""

from __future__ import annotations

from rclpy_shim.msgs.interfaces import Interfaces

__all__ = ["Interfaces"]

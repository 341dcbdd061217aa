"""ROS 2 message types in memory: definitions, generated classes, and the modules that nodes import them from.

    >>> from rclpy_shim.interfaces import Interfaces
    >>> Interfaces().message_class("std_msgs/String")(data="hello")
    std_msgs.msg.String(data='hello')

Code belongs here if it defines ROS 2's message types. Their bytes on the Software Bus are ROS 1's
(`rospy_shim.types.msgs`). The central file is `rclpy_shim/interfaces/interfaces.py`.
"""

from __future__ import annotations

from rclpy_shim.interfaces.interfaces import Interfaces

__all__ = ["Interfaces"]

"""tf2_geometry_msgs: importing it enables tf2_ros to transform stamped points, vectors, poses and wrenches.

As in ROS, the messages are also names of the package, and so are the modules that it uses there. PyKDL is loaded
when it is first needed.
"""

from __future__ import annotations

import importlib
from typing import Any

import rospy
import tf2_ros
from geometry_msgs.msg import PointStamped, PoseStamped, Vector3Stamped, WrenchStamped

from tf2_geometry_msgs.tf2_geometry_msgs import (
    do_transform_point,
    do_transform_pose,
    do_transform_vector3,
    do_transform_wrench,
    from_msg_msg,
    to_msg_msg,
    transform_to_kdl,
)

__all__ = [
    "PointStamped",
    "PoseStamped",
    "Vector3Stamped",
    "WrenchStamped",
    "do_transform_point",
    "do_transform_pose",
    "do_transform_vector3",
    "do_transform_wrench",
    "from_msg_msg",
    "rospy",
    "tf2_ros",
    "to_msg_msg",
    "transform_to_kdl",
]


def __getattr__(name: str) -> Any:
    if name != "PyKDL":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return importlib.import_module("PyKDL")

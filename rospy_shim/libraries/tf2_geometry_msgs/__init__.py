"""tf2_geometry_msgs: importing it teaches tf2_ros to transform stamped points, vectors, poses and wrenches."""

from __future__ import annotations

from tf2_geometry_msgs.tf2_geometry_msgs import (
    do_transform_point,
    do_transform_pose,
    do_transform_vector3,
    do_transform_wrench,
    from_msg_msg,
    to_msg_msg,
)

__all__ = [
    "do_transform_point",
    "do_transform_pose",
    "do_transform_vector3",
    "do_transform_wrench",
    "from_msg_msg",
    "to_msg_msg",
]

"""tf2_kdl for nodes: PyKDL's vectors, frames, twists and wrenches for `tf2_ros.Buffer.transform` and `convert`.

Importing it registers them. Names and results match ROS's tf2_kdl 0.7; the code is cfepy's own.
"""

from __future__ import annotations

from tf2_geometry_msgs.tf2_geometry_msgs import transform_to_kdl

from .tf2_kdl import (
    convert_vector,
    do_transform_frame,
    do_transform_twist,
    do_transform_vector,
    do_transform_wrench,
    from_msg_vector,
    to_msg_vector,
)

__all__ = [
    "convert_vector",
    "do_transform_frame",
    "do_transform_twist",
    "do_transform_vector",
    "do_transform_wrench",
    "from_msg_vector",
    "to_msg_vector",
    "transform_to_kdl",
]

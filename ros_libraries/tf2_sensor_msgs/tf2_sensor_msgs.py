"""`do_transform_cloud`, as in ROS's tf2_sensor_msgs 0.7; the code is cfepy's own."""

from __future__ import annotations

from typing import Any

import PyKDL
import tf2_ros
from sensor_msgs.msg import PointCloud2
from sensor_msgs.point_cloud2 import create_cloud, read_points
from tf2_geometry_msgs.tf2_geometry_msgs import transform_to_kdl


def to_msg_msg(msg: Any) -> Any:
    """Return the cloud, which is a message already."""
    return msg


def from_msg_msg(msg: Any) -> Any:
    """Return the message: a cloud is its own message."""
    return msg


def do_transform_cloud(cloud: Any, transform: Any) -> Any:
    """Return a cloud as seen from another frame.

    Args:
        cloud: its first three fields are x, y and z; the others stay unchanged.
        transform: a geometry_msgs/TransformStamped, whose header the result gets.
    """
    frame = transform_to_kdl(transform)
    points = []
    for x, y, z, *rest in read_points(cloud):
        moved = frame * PyKDL.Vector(x, y, z)
        points.append((*moved.v, *rest))
    return create_cloud(transform.header, cloud.fields, points)


tf2_ros.ConvertRegistration().add_to_msg(PointCloud2, to_msg_msg)
tf2_ros.ConvertRegistration().add_from_msg(PointCloud2, from_msg_msg)
tf2_ros.TransformRegistration().add(PointCloud2, do_transform_cloud)

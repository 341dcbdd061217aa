"""tf2_sensor_msgs for nodes: point clouds for `tf2_ros.Buffer.transform`. Importing it registers them."""

from __future__ import annotations

from tf2_geometry_msgs.tf2_geometry_msgs import transform_to_kdl

from .tf2_sensor_msgs import do_transform_cloud, from_msg_msg, to_msg_msg

__all__ = ["do_transform_cloud", "from_msg_msg", "to_msg_msg", "transform_to_kdl"]

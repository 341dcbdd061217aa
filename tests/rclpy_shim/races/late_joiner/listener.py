"""Needs that message."""

import rclpy
from rclpy.wait_for_message import wait_for_message
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("listener")
assert wait_for_message(String, node, "map", time_to_wait=1.0)[0], "the map never came"

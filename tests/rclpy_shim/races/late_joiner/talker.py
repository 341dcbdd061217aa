"""Publishes its one message as soon as it can, without durability."""

import rclpy
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("talker")
publisher = node.create_publisher(String, "map", 1)
publisher.publish(String(data="map"))

"""Fly public ROS 2 nodes on cfepy and on the real rclpy, and compare the lines that they print."""

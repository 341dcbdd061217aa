"""rclpy_shim: rclpy for ROS 2 nodes that run on cfepy's simulated flight computer.

It stands beside `rospy_shim` and uses its graph, MsgIds, transport and message codec, so nodes of ROS 1 and ROS 2 share
topics. Code belongs here if only ROS 2 nodes need it: `interfaces` has the message types, `seam` connects the entities
of a program (publishers, subscriptions, services, clients) with the Software Bus, and `libraries` is rclpy itself,
which each node executes in its own universe. A mission imports this package when its first ROS 2 node starts; without
the package, all other missions run. The central file is `rclpy_shim/ros2_world.py`.
"""

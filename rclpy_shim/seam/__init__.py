"""The seam between rclpy and the Software Bus: the entities of a ROS 2 program with the meaning that rcl gives them.

Code belongs here if it connects a program with the bus, the graph or the kernel. Python code that a node sees as rclpy
belongs to `rclpy_shim/libraries/rclpy`, which stands on this package alone. The central file is
`rclpy_shim/seam/ros2_program.py`.
"""

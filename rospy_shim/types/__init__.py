"""ROS without a graph: messages, times, names, exceptions, and the description of a link between two nodes.

A module belongs here if it needs no node and no mission. The use of topics by a node belongs to `rospy_shim.client`.
The central file is `rospy_shim/types/msgs/spec.py`.
"""

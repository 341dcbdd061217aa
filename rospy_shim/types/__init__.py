"""ROS without a graph: messages, times, names, exceptions, and how a link between two nodes is described.

What belongs here needs no node and no mission. What a node does with a topic does not: that is `rospy_shim.client`. The
central file is `rospy_shim/types/msgs/spec.py`.
"""

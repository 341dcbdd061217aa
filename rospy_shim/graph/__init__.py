"""The part of ROS that all nodes of a mission share: the graph of topics and services, and their MsgIds.

A module belongs here if it holds knowledge of ROS's master about a running system. The functions that a node calls
belong to `rospy_shim.client`, the master's XML-RPC interface belongs to `rospy_shim.master`. The central file is
`rospy_shim/graph/graph.py`.
"""

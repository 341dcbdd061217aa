"""What all nodes of a mission share: the graph of topics and services, and their MsgIds.

What belongs here stands for what ROS's master knows of a running system. The functions that a node calls are in
`rospy_shim.client`, the master's XML-RPC interface is in `rospy_shim.master`. The central file is
`rospy_shim/graph/graph.py`.
"""

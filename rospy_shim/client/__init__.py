"""What rospy gives a node: its functions and classes, made of one `Node` object for each node.

A module belongs here when a node calls it through `rospy`, or when it serves one that it calls: names, time, topics,
services, parameters' functions, logs, the node's life. What all nodes of a mission share is in `rospy_shim.graph` and
`rospy_shim.parameters`, message classes are in `rospy_shim.types.msgs`, and rospy's modules that are ordinary code of
nodes in `rospy_shim.rospy_modules`. The central file is `rospy_shim/client/node.py`.
"""

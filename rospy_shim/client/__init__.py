"""rospy of a node: its functions and classes, made from one `Node` object for each node.

A module belongs here if a node calls it through `rospy`, or if it serves such a module: names, time, topics, services,
the functions for parameters, logs, the node's life. State that all nodes of a mission share belongs to
`rospy_shim.graph` and `rospy_shim.parameters`, message classes belong to `rospy_shim.types.msgs`, and rospy's modules
that are ordinary code of nodes to `rospy_shim.rospy_modules`. The central file is `rospy_shim/client/node.py`.
"""

"""ROS's parameters: the tree that all nodes read, and the cFE tables that keep it over a processor reset.

A module belongs here if it works on parameters for all nodes together: values, their text, rows and images of tables,
the application ROS, and the table files as tools see them. The functions that a node calls belong to
`rospy_shim.client.params`. The central file is `rospy_shim/parameters/table.py`.
"""

"""Launch files: roslaunch's input as plain records, with the nodes found in their packages.

`reader.read` turns a .launch or .test file and its arguments into a `model.Launch`; `launch_plan.plan_of` turns that
into nodes with their scripts. Code belongs here if it reads tags or finds programs; `rospy_shim.runtime` starts the
nodes of a plan. Stands for roslaunch's XmlLoader (wiki.ros.org/roslaunch/XML). The central file is
`rospy_shim/roslaunch/launch_plan.py`.
"""

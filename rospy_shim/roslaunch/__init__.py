"""Launch files: what roslaunch reads, as plain records, with the nodes found in their packages.

`reader.read` turns a .launch or .test file and its arguments into a `model.Launch`, `plan.plan_of` that into nodes with
their scripts. Reading tags and finding programs belongs here; `rospy_shim.runtime` starts the nodes of a plan. Stands
for roslaunch's XmlLoader (wiki.ros.org/roslaunch/XML). The central file is `rospy_shim/roslaunch/launch_plan.py`.
"""

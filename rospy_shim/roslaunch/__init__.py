"""Launch files: what roslaunch reads, as plain records, with the nodes found in their packages.

`reader.read` turns a .launch or .test file and its arguments into a `model.Launch`; the mission loads it by name.
Stands for roslaunch's XmlLoader (wiki.ros.org/roslaunch/XML). May import cfepy.status and rospy_shim.
"""

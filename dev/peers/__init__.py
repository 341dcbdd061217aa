"""Public test files of ROS packages, unmodified, on cfepy: which there are, how many pass on ROS, and how many here.

Their sources are not here: `python -m dev.peers fetch FOLDER` gets them from GitHub.
"""

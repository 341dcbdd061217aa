"""Run public test files of ROS packages unmodified on cfepy: the list of files, and how many tests pass on ROS and
here.

The sources are not in this repository. `python -m dev.peers fetch FOLDER` gets them from GitHub.
"""

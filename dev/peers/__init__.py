"""Run public test files of ROS packages unmodified on cfepy: list of files, and counts of passes on ROS and here.

The sources are not in this repository. `python -m dev.peers fetch FOLDER` gets them from GitHub.
"""

"""Run public ROS nodes unmodified on cfepy: the inputs and expected results of each, and the program that runs them.

The sources are not in this repository. `python -m dev.corpus fetch FOLDER` gets them from GitHub.
"""

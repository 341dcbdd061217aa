"""Public ROS nodes, unmodified, on cfepy: what each is given and what it must do, and the program that tries it.

Their sources are not here: `python -m dev.corpus fetch FOLDER` gets them from GitHub.
"""

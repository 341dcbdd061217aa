"""The older name of `parameter_generator_catkin`, which .cfg files of rosbuild's time begin with."""

from __future__ import annotations

from .parameter_generator_catkin import *  # noqa: F403

"""The older name of `parameter_generator_catkin`, used by .cfg files from the time of rosbuild."""

from __future__ import annotations

from .parameter_generator_catkin import *  # noqa: F403

"""rospkg.distro: the name of this distribution of ROS. It only has the part of rospkg's module that roslaunch uses."""

from __future__ import annotations

import os


def current_distro_codename() -> str | None:
    """Return the code name of the distribution, such as "noetic", from ROS_DISTRO, or None if that is not set."""
    return os.environ.get("ROS_DISTRO")

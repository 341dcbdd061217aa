"""rospkg.distro: which distribution of ROS this is. Of rospkg's module there is what roslaunch asks for."""

from __future__ import annotations

import os


def current_distro_codename() -> str | None:
    """The code name of the distribution, such as "noetic", from ROS_DISTRO; None when that is not set."""
    return os.environ.get("ROS_DISTRO")

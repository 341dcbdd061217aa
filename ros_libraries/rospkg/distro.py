"""rospkg.distro: the name of this distribution of ROS. It only has the part of rospkg's module that roslaunch uses."""

from __future__ import annotations

import os
from collections.abc import Mapping


def current_distro_codename(env: Mapping[str, str] | None = None) -> str | None:
    """Return the code name of the distribution, such as "noetic", from ROS_DISTRO, or None if that is not set.

    Args:
        env: the environment; None for the node's own.
    """
    return (os.environ if env is None else env).get("ROS_DISTRO")

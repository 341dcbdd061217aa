"""Helpers for programs that launch (roslaunch.rlutil)."""

from __future__ import annotations

import os
from collections.abc import Sequence

from roslaunch.core import RLException, generate_run_id


def get_or_generate_uuid(options_runid: str | None, options_wait_for_master: bool) -> str:
    """Return the run's identifier: the given one, the one of the parameter server, or a new one."""
    import rospy

    return options_runid or str(rospy.get_param("/run_id", None) or generate_run_id())


def resolve_launch_arguments(args: Sequence[str]) -> list[str]:
    """Return paths of launch files from arguments: a path, or a package and the name of a file in it.

    Raises:
        RLException: there is no such file.
    """
    names = [arg for arg in args if ":=" not in arg]
    if not names:
        raise RLException("no input files")
    if os.path.isfile(names[0]) or len(names) == 1:
        if not os.path.isfile(names[0]):
            raise RLException(f"[{names[0]}] is not a launch file name")
        return [names[0]]
    import rospkg

    try:
        top = rospkg.RosPack().get_path(names[0])
    except rospkg.ResourceNotFound:
        top = ""
    found = [os.path.join(folder, names[1]) for folder, _, files in os.walk(top) if names[1] in files] if top else []
    if not found:
        raise RLException(f"[{names[1]}] is neither a launch file in package [{names[0]}] nor a launch file name")
    return [min(found, key=len)]

"""A mission that is one ROS node, as `rosrun` starts one. rospy_shim is loaded by name."""

from __future__ import annotations

import importlib
import os
import re
from collections.abc import Sequence
from pathlib import Path

from cfepy.mission.launch import spec_of
from cfepy.mission.spec import MissionSpec
from cfepy.nodes.config import ROSCORE_PARAMS, NodeConfig
from cfepy.status import UsageError


def node_script(words: Sequence[str]) -> tuple[Path, list[str]]:
    """The script that a command line names, and what is left for the node.

    Args:
        words: a script, or a package and the name of a node in it; then the node's arguments.

    Raises:
        UsageError: there is none.
    """
    if Path(words[0]).is_file():
        return Path(words[0]).resolve(), list(words[1:])
    if len(words) == 1 or words[0].endswith(".py"):
        raise UsageError("there is no such script; give one, or a package and the name of a node in it", file=words[0])
    plans = importlib.import_module("rospy_shim.roslaunch.plan")
    found = plans.node_file(words[0], words[1], Path.cwd() / words[1], os.environ)
    return Path(found), list(words[2:])


def spec_of_script(script: Path, words: Sequence[str]) -> MissionSpec:
    """The mission that one node is, with its arguments."""
    plans = importlib.import_module("rospy_shim.roslaunch.plan")
    environ = plans.node_environment(os.environ, os.environ.get("ROS_NAMESPACE", "/"))
    app = re.sub(r"\W", "_", script.stem, flags=re.ASCII).upper()[: plans.LONGEST_NAME]
    config = NodeConfig(app, args=tuple(words), env=environ, script=script, cwd=Path.cwd(), required=True)
    return spec_of(script, {app: config}, ROSCORE_PARAMS)

"""A node of the ground's in a mission: its spec with one more application; the library `ground_nodes` has the scripts.

It stands for the rosbag, rostopic or rosservice that somebody runs beside a robot. What the latter two print is a line
of JSON.
"""

from __future__ import annotations

import importlib
import json
import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from cfepy.mission.bag import BagReader
from cfepy.mission.launch import lines_for
from cfepy.mission.spec import MissionSpec
from cfepy.nodes.config import NodeConfig

APP, PLAYER = "GROUND_NODE", "ROSBAG_PLAY"


def with_ground_node(spec: MissionSpec, script: str, arguments: Sequence[Any]) -> MissionSpec:
    """A mission with a node of the ground's.

    Args:
        spec: the mission.
        script: name of the script, such as "ground_call".
        arguments: what it is told.
    """
    path = Path(importlib.import_module("rospy_shim.library_path").FOLDER) / "ground_nodes" / f"{script}.py"
    node = NodeConfig(
        APP,
        args=(json.dumps(list(arguments)),),
        env=_package_paths(spec),
        script=path,
        near=spec.script,
        cwd=spec.folder,
    )
    return _with_node(spec, node)


def _package_paths(spec: MissionSpec) -> dict[str, str]:
    """Where the mission's nodes find packages: whoever talks to them needs their message types."""
    near = importlib.import_module("rospy_shim.msgs.packages").near
    nodes = spec.ros.nodes.values()
    folders = [str(folder) for node in nodes if node.script is not None for folder in near(node.script)]
    found: dict[str, str] = {}
    for name, first in (("ROS_PACKAGE_PATH", folders), ("CMAKE_PREFIX_PATH", [])):
        said = os.pathsep.join([*first, *(node.env[name] for node in nodes if node.env.get(name))])
        found[name] = os.pathsep.join(dict.fromkeys(said.split(os.pathsep)))
    return found


def with_player(spec: MissionSpec, bag: str) -> MissionSpec:
    """A mission in which a bag is played, with its time on /clock if the mission's nodes use simulated time.

    Raises:
        UsageError: there is no such bag, or it is broken.
    """
    with BagReader(bag):
        pass
    has_clock = spec.ros.params.get("use_sim_time") is True
    args = (*(["--clock"] if has_clock else []), str(Path(bag).resolve()))
    script = Path(importlib.import_module("rospy_shim.library_path").FOLDER) / "ground_nodes" / "ground_play.py"
    return _with_node(spec, NodeConfig(PLAYER, args=args, script=script, cwd=spec.folder))


def _with_node(spec: MissionSpec, node: NodeConfig) -> MissionSpec:
    head = spec.startup_script.partition(b"!")[0].rstrip() + b"\n"
    ros = replace(spec.ros, nodes={**spec.ros.nodes, node.app: node})
    return replace(spec, ros=ros, startup=head + lines_for({node.app: node}) + b"!\n")


class GroundConsole:
    """Takes the lines of a mission's console, and keeps what the node said.

    Attributes:
        said: the node's lines, as they are after JSON.
        others: what other nodes printed.
    """

    def __init__(self) -> None:
        self.said: list[dict[str, Any]] = []
        self.others: list[str] = []

    def line(self, text: str) -> None:
        """A line of the console."""
        name, bracket, rest = text.partition("] ")
        if not bracket or not text.startswith("["):
            return
        if rest.startswith("{") and name.startswith(("[rosservice_", "[rostopic_", f"[{APP}")):
            self.said.append(json.loads(rest))
        else:
            self.others.append(text)

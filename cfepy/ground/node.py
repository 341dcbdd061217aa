"""A ground node in a mission: its spec with one more application; the library `ground_nodes` has the scripts.

It stands for the rosbag, rostopic or rosservice that an operator runs on a robot. What the last two print is a line
of JSON.
"""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from cfepy.ground.bag import BagReader
from cfepy.mission import Mission, MissionSpec, lines_for, mission_environment, spec_of
from cfepy.nodes import ROSCORE_PARAMS, NodeConfig
from rospy_shim.library_parts import FOLDER
from rospy_shim.msgs.packages import near

SCRIPTS = "ground_nodes"
"""The library whose modules are the scripts."""
APP, PLAYER = "GROUND_NODE", "ROSBAG_PLAY"
_SPEAKERS = (f"[{APP}", "[rosservice_", "[rostopic_", "[tf_echo_", "[view_frames_")


def with_ground_node(spec: MissionSpec, script: str, arguments: Sequence[Any]) -> MissionSpec:
    """A mission with a node of the ground's.

    Args:
        spec: the mission.
        script: name of the script, such as "ground_call".
        arguments: what it is told.
    """
    path = FOLDER / SCRIPTS / f"{script}.py"
    node = NodeConfig(
        APP,
        args=(json.dumps(list(arguments)),),
        env=_package_paths(spec),
        script=path,
        near=spec.script,
        cwd=spec.folder,
    )
    return _with_node(spec, node)


def empty_mission() -> MissionSpec:
    """A mission without nodes, in the current folder, for a tool that needs none: it finds the packages here."""
    return spec_of(Path.cwd() / "tool", {}, ROSCORE_PARAMS)


def _package_paths(spec: MissionSpec) -> dict[str, str]:
    """Where the mission's nodes find packages: a program that talks to them needs their message types.

    In a mission without nodes it finds those that its user does.
    """
    nodes = spec.ros.nodes.values()
    if not nodes:
        return mission_environment()
    folders = [str(folder) for node in nodes if node.script is not None for folder in near(node.script)]
    found: dict[str, str] = {}
    for name, first in (("ROS_PACKAGE_PATH", folders), ("CMAKE_PREFIX_PATH", [])):
        said = os.pathsep.join([*first, *(node.env[name] for node in nodes if node.env.get(name))])
        found[name] = os.pathsep.join(dict.fromkeys(said.split(os.pathsep)))
    return found


def ground_node_ended(mission: Mission) -> bool:
    """Whether the ground's node has come to its end, or died."""
    return mission.ros is not None and APP in mission.ros.monitor.statuses


def with_player(spec: MissionSpec, bag: str) -> MissionSpec:
    """A mission in which a bag is played, with its time on /clock if the mission's nodes use simulated time.

    Raises:
        UsageError: there is no such bag, or it is broken.
    """
    with BagReader(bag):
        pass
    has_clock = spec.ros.params.get("use_sim_time") is True
    args = (*(["--clock"] if has_clock else []), str(Path(bag).resolve()))
    script = FOLDER / SCRIPTS / "ground_play.py"
    return _with_node(spec, NodeConfig(PLAYER, args=args, script=script, cwd=spec.folder))


def _with_node(spec: MissionSpec, node: NodeConfig) -> MissionSpec:
    head = spec.startup_script.partition(b"!")[0].rstrip() + b"\n"
    node = replace(node, on_disk=True)
    ros = replace(spec.ros, nodes={**spec.ros.nodes, node.app: node})
    return replace(spec, ros=ros, startup=head + lines_for({node.app: node}) + b"!\n")


class GroundConsole:
    """Takes the lines of a mission's console, and keeps what the ground node said.

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
        if rest.startswith("{") and name.startswith(_SPEAKERS):
            self.take(json.loads(rest))
        else:
            self.overhear(text)

    def take(self, said: dict[str, Any]) -> None:
        """The node said this."""
        self.said.append(said)

    def overhear(self, text: str) -> None:
        """Another node printed this."""
        self.others.append(text)

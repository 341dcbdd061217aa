"""A ground node in a mission: its spec with one more application; the library `ground_nodes` has the scripts.

It stands for the rosbag, rostopic or rosservice that an operator runs on a robot. What the last two print is a line
of JSON.
"""

from __future__ import annotations

import importlib
import json
import os
import shlex
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from cfepy.ground.bag import BagReader
from cfepy.mission import Mission, MissionSpec, lines_for, mission_environment, spec_of
from cfepy.nodes import ROSCORE_PARAMS, NodeConfig
from cfepy.status import UsageError
from rospy_shim.library_parts import FOLDER
from rospy_shim.types.msgs.packages import near

SCRIPTS = "ground_nodes"
"""The library whose modules are the scripts."""
PLAY_OPTIONS = "ros_libraries.rosbag_storage.play_options"
"""What knows the options of `rosbag play`; nodes import it by another name."""
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


def with_player(spec: MissionSpec, bag: str, options: str = "") -> MissionSpec:
    """A mission in which a bag is played, with its time on /clock if the mission's nodes use simulated time.

    The player is started in the bag's folder, with the bag's name: it tells the name, and where the folder is must not
    decide the run.

    Args:
        spec: the mission.
        bag: the bag, or the MCAP file.
        options: what else `rosbag play` is told, as on a command line, such as "--rate 2 --topics /a /a:=/b".

    Raises:
        UsageError: there is no such bag, it is broken, or an option is none.
    """
    with BagReader(bag):
        pass
    words = play_words(options)
    has_clock = spec.ros.params.get("use_sim_time") is True and "--clock" not in words
    folder, name = os.path.split(os.path.abspath(bag))
    name = f"./{name}" if name.startswith("-") else name  # which would be an option
    args = (*(["--clock"] if has_clock else []), name, *words)
    script = FOLDER / SCRIPTS / "ground_play.py"
    return _with_node(spec, NodeConfig(PLAYER, args=args, script=script, cwd=Path(folder)))


def play_words(options: str) -> list[str]:
    """The words of options of `rosbag play`.

    Raises:
        UsageError: it has no such option, or another bag is named, which has its own `--play`.
    """
    try:
        words = shlex.split(options)
        parser = importlib.import_module(PLAY_OPTIONS).CheckedPlayParser(add_help=False)
        said = parser.parse_play([PLAYER, *(word for word in words if ":=" not in word)])
    except ValueError as error:
        raise UsageError(str(error), field="--play-options") from None
    if len(said.bags) > 1:
        raise UsageError(f"unexpected {said.bags[1]}; name the bag with --play", field="--play-options")
    return words


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

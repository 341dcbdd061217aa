"""A ground node in a mission: the mission's spec with an additional application from the library `ground_nodes`.

It acts as the rosbag, rostopic or rosservice that an operator runs on a robot. The last two print lines of JSON.
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
from cfepy.reading.suggestions import did_you_mean
from cfepy.status import UsageError
from rospy_shim.library_parts import FOLDER
from rospy_shim.roslaunch.launch_plan import with_workspace
from rospy_shim.types.msgs import Library, OnDisk, Packages, shipped
from rospy_shim.types.msgs.packages import near

SCRIPTS = "ground_nodes"
"""Library with the scripts."""
PLAY_OPTIONS = "ros_libraries.rosbag_storage.play_options"
"""Module with the options of `rosbag play`, which nodes load under another name."""
APP, PLAYER = "GROUND_NODE", "ROSBAG_PLAY"
_SPEAKERS = (f"[{APP}", "[rosservice_", "[rostopic_", "[tf_echo_", "[view_frames_")


def with_ground_node(spec: MissionSpec, script: str, arguments: Sequence[Any]) -> MissionSpec:
    """Return a mission with an additional node of the ground.

    Args:
        spec: the mission.
        script: name of the script, such as "ground_call".
        arguments: its arguments.
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


def check_message_type(spec: MissionSpec, name: str) -> None:
    """Check that a node of the ground can load a message type.

    Args:
        spec: the mission, whose packages count.
        name: full name of the type, such as "std_msgs/String".

    Raises:
        UsageError: there is no such type, or its definition is wrong.
    """
    library = Library([OnDisk(Packages(spec.script, _package_paths(spec)))], base=shipped())
    try:
        library.spec(name)
    except UsageError as error:
        known = (f"{package}/{each}" for package in library.packages() for each in library.names(package, "msg") or ())
        raise UsageError(f"{error.text}{did_you_mean(name, known, before='; ')}", field="TYPE") from None


def empty_mission() -> MissionSpec:
    """Return a mission without nodes, in the current folder, for a tool that needs none; packages are found there."""
    return spec_of(Path.cwd() / "tool", {}, ROSCORE_PARAMS)


def _package_paths(spec: MissionSpec) -> dict[str, str]:
    """Return the variables with which the mission's nodes find packages.

    A program that communicates with these nodes needs their message types. For a mission without nodes, the variables
    are the user's own.
    """
    nodes = spec.ros.nodes.values()
    if not nodes:
        environ = mission_environment()
        return {**environ, "ROS_PACKAGE_PATH": with_workspace(environ.get("ROS_PACKAGE_PATH", ""), spec.script)}
    folders = [str(folder) for node in nodes if node.script is not None for folder in near(node.script)]
    found: dict[str, str] = {}
    for name, first in (("ROS_PACKAGE_PATH", folders), ("CMAKE_PREFIX_PATH", [])):
        said = os.pathsep.join([*first, *(node.env[name] for node in nodes if node.env.get(name))])
        found[name] = os.pathsep.join(dict.fromkeys(said.split(os.pathsep)))
    return found


def ground_node_ended(mission: Mission) -> bool:
    """Return whether the ground's node has ended, normally or not."""
    return mission.ros is not None and APP in mission.ros.monitor.statuses


def with_player(spec: MissionSpec, bag: str, options: str = "") -> MissionSpec:
    """Return a mission in which a bag is played, with its time on /clock if the mission's nodes use simulated time.

    The player starts in the bag's folder and gets the bag's name alone. The player prints that name, and the run must
    not depend on where the folder is.

    Args:
        spec: the mission.
        bag: the bag, or the MCAP file.
        options: further arguments of `rosbag play`, as on a command line, such as "--rate 2 --topics /a /a:=/b".

    Raises:
        UsageError: if there is no such bag, it is damaged, or an option is invalid.
    """
    with BagReader(bag):
        pass
    words = play_words(options)
    has_clock = spec.ros.params.get("use_sim_time") is True and "--clock" not in words
    folder, name = os.path.split(os.path.abspath(bag))
    name = f"./{name}" if name.startswith("-") else name  # it would be taken as an option
    args = (*(["--clock"] if has_clock else []), name, *words)
    script = FOLDER / SCRIPTS / "ground_play.py"
    return _with_node(spec, NodeConfig(PLAYER, args=args, script=script, cwd=Path(folder)))


def play_words(options: str) -> list[str]:
    """Return the words of options of `rosbag play`.

    Raises:
        UsageError: if it has no such option, or another bag is named, which has its own `--play`.
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
    """Receives the lines of a mission's console, and keeps the output of the ground node.

    Attributes:
        said: the node's lines, decoded from JSON.
        others: output of other nodes.
    """

    def __init__(self) -> None:
        self.said: list[dict[str, Any]] = []
        self.others: list[str] = []

    def line(self, text: str) -> None:
        """Process a line of the console."""
        name, bracket, rest = text.partition("] ")
        if not bracket or not text.startswith("["):
            return
        if rest.startswith("{") and name.startswith(_SPEAKERS):
            self.take(json.loads(rest))
        else:
            self.overhear(text)

    def take(self, said: dict[str, Any]) -> None:
        """Add output of the node."""
        self.said.append(said)

    def overhear(self, text: str) -> None:
        """Add output of another node."""
        self.others.append(text)

"""Missions of ROS nodes: of launch files, with a startup script or without one, and of a single node as of `rosrun`.

Launch files are found and read by `rospy_shim.roslaunch`, which is imported when there is one.
Nothing is written to disk: the startup script of such a mission is bytes.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from cfepy.mission.limits import MissionLimits
from cfepy.mission.parameter_files import merged
from cfepy.mission.spec import MissionSpec
from cfepy.nodes import ROSCORE_PARAMS, NodeConfig, RosConfig
from cfepy.status import UsageError
from cfepy.suggestions import did_you_mean

PRIORITY, STACK_BYTES, RESTART_NOTHING = 100, 16384, 0
ROOM = 64  # more nodes than there are that limits allow for, since a workstation does not limit threads
LAUNCH_FILES = (".launch", ".test", ".xml")
KEPT_ENVIRONMENT = ("HOME", "PATH", "ROS_PACKAGE_PATH", "CMAKE_PREFIX_PATH")


def spec_of(
    made_from: Path, nodes: Mapping[str, NodeConfig], params: Mapping[str, Any], notes: tuple[str, ...] = ()
) -> MissionSpec:
    """A mission of ROS nodes that is not on disk; the run ends when all of them have.

    Args:
        made_from: the launch file or script; its folder shows as /cf.
        nodes: by cFE name, each with its script.
        params: the tree of parameters.
        notes: what the user should know.
    """
    return MissionSpec(
        name=made_from.stem,
        folder=made_from.parent,
        script=made_from,
        mission_file=None,
        board="linux",
        ros=RosConfig(nodes=nodes, params=params, spread=True, ends_with_nodes=bool(nodes)),
        limits=MissionLimits(nodes=len(nodes) + ROOM, yields=True),
        startup=lines_for(nodes) + b"!\n",
        notes=notes,
    )


def read_launch(file: Path, args: Mapping[str, str] | None = None) -> MissionSpec:
    """The mission that a launch file by itself is, in the user's environment.

    Args:
        file: the launch file.
        args: values of its arguments.

    Raises:
        UsageError: it is wrong, or has no node that can run here.
    """
    from rospy_shim.roslaunch.plan import plan_of

    plan = plan_of(file, args or {}, dict(os.environ), cwd=Path.cwd())
    if not plan.nodes:
        why = "; ".join(plan.notes) or "it has no <node>"
        raise UsageError(f"has no node that can run here: {why}", file=file)
    return spec_of(file, plan.nodes, plan.params, tuple(plan.notes))


def launch_file(words: Sequence[str]) -> tuple[Path, dict[str, str]]:
    """The launch file and the arguments that a command line names.

    Raises:
        UsageError: there is no such file.
    """
    args = dict(word.split(":=", 1) for word in words if ":=" in word)
    names = [word for word in words if ":=" not in word]
    if len(names) > 1 and os.path.isfile(names[0]):
        raise UsageError(f"{names[1]!r} is no argument for it; write NAME:=VALUE", file=names[0])
    if len(names) not in (1, 2):
        raise UsageError(f"{len(names)} names; give a launch file, or a package and the name of a launch file in it")
    file = Path(names[0])
    if len(names) == 1 and os.path.isfile(file):
        return file.resolve(), args
    found = launch_file_of_package(" ".join(names))
    if found is None:
        hint = did_you_mean(names[-1], files_near(file, LAUNCH_FILES), before="; ")
        raise UsageError(f"there is no such launch file{hint}", file=" ".join(names))
    return found, args


def launch_file_of_package(text: str) -> Path | None:
    """The launch file that a package and its name in the package mean, with a blank between them, as roslaunch has it.

    Args:
        text: such as "demo robot.launch".

    Returns:
        None when the text looks like something else.

    Raises:
        UsageError: there is no such package, or no such file in it.
    """
    package, blank, name = text.partition(" ")
    if not blank or "/" in package or not name.endswith(LAUNCH_FILES):
        return None
    from rospy_shim.roslaunch.plan import launch_file

    return launch_file(package, name, Path.cwd() / name, os.environ)


def files_near(path: Path, suffixes: tuple[str, ...]) -> list[str]:
    """The files of some kind in the folder of a path, as they would be written in its place."""
    try:
        return [str(each) for each in sorted(path.parent.iterdir()) if each.suffix in suffixes]
    except OSError:
        return []


def with_launch_files(spec: MissionSpec, launches: Sequence[tuple[Path, Mapping[str, str]]]) -> MissionSpec:
    """A mission with the nodes of launch files added to its own.

    Args:
        spec: the mission.
        launches: launch files, and the arguments of each.

    Raises:
        UsageError: one of them is wrong.
    """
    from rospy_shim.roslaunch.plan import plan_of

    environ = mission_environment()
    nodes, params, notes = dict(spec.ros.nodes), dict(spec.ros.params), list(spec.notes)
    taken = [entry.name for entry in spec.entries]
    added: dict[str, NodeConfig] = {}
    for file, args in launches:
        plan = plan_of(file, args, environ, taken=[*taken, *added])
        added.update(plan.nodes)
        params = merged(plan.params, params)
        notes += plan.notes
    head = spec.startup_script.partition(b"!")[0]
    ros = replace(spec.ros, nodes={**nodes, **added}, params=params)
    return replace(spec, ros=ros, startup=head + lines_for(added) + b"!\n", notes=tuple(notes))


def mission_environment() -> dict[str, str]:
    """What launch files in a mission see of the user's environment: little, to be the same everywhere."""
    return {name: os.environ[name] for name in KEPT_ENVIRONMENT if name in os.environ}


def scripts_of(spec: MissionSpec) -> dict[str, Path]:
    """Scripts of nodes that are not in the mission's folder, by the virtual paths that the startup script has."""
    return {f"/cf/{app}.so": node.script for app, node in spec.ros.nodes.items() if node.script is not None}


def lines_for(nodes: Mapping[str, NodeConfig]) -> bytes:
    """Lines of a startup script; the name is also the file's, which is never opened."""
    numbers = f"{PRIORITY}, {STACK_BYTES}, 0x0, {RESTART_NOTHING}"
    return "".join(f"CFE_APP, {app}, __main__, {app}, {numbers};\n" for app in nodes).encode()


def node_script(words: Sequence[str]) -> tuple[Path, list[str]]:
    """The script that a command line names, and what is left for the node.

    Args:
        words: a script, or a package and the name of a node in it; then the node's arguments.

    Raises:
        UsageError: there is none.
    """
    if os.path.isfile(words[0]):
        return Path(words[0]).resolve(), list(words[1:])
    if len(words) == 1 or words[0].endswith(".py"):
        otherwise = "give one, or a package and the name of a node in it"
        hint = did_you_mean(words[0], files_near(Path(words[0]), (".py",)), otherwise)
        raise UsageError(f"there is no such script; {hint}", file=words[0])
    from rospy_shim.roslaunch.plan import node_file

    return node_file(words[0], words[1], Path.cwd() / words[1], os.environ), list(words[2:])


def spec_of_script(script: Path, words: Sequence[str]) -> MissionSpec:
    """The mission that one node is, with its arguments."""
    from rospy_shim.roslaunch.plan import LONGEST_NAME, node_environment

    environ = node_environment(os.environ, os.environ.get("ROS_NAMESPACE", "/"))
    app = re.sub(r"\W", "_", script.stem, flags=re.ASCII).upper()[:LONGEST_NAME]
    config = NodeConfig(app, args=tuple(words), env=environ, script=script, cwd=Path.cwd(), required=True)
    return spec_of(script, {app: config}, ROSCORE_PARAMS)

"""Launch files in missions: their nodes as applications, beside those of a startup script or without one.

roslaunch's side of it, reading and finding, is `rospy_shim.roslaunch`, loaded by name when there is a launch file.
Nothing is written to disk: the startup script of such a mission is bytes.
"""

from __future__ import annotations

import importlib
import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cfepy.es.startup_script import entries
from cfepy.mission.limits import MissionLimits
from cfepy.nodes.config import NodeConfig, RosConfig
from cfepy.status import UsageError

if TYPE_CHECKING:
    from cfepy.mission.spec import MissionSpec

PRIORITY, STACK_BYTES, RESTART_NOTHING = 100, 16384, 0
ROOM = 64  # more nodes than there are that limits allow for, since on a workstation nobody counts threads
LAUNCH_FILES = (".launch", ".test", ".xml")
KEPT_ENVIRONMENT = ("HOME", "PATH", "ROS_PACKAGE_PATH", "CMAKE_PREFIX_PATH")


def plan_of(file: Path, args: Mapping[str, str], environ: Mapping[str, str], **options: Any) -> Any:
    """What a launch file comes to; see `rospy_shim.roslaunch.plan.plan_of`.

    Raises:
        UsageError: it is wrong.
    """
    return importlib.import_module("rospy_shim.roslaunch.plan").plan_of(file, args, environ, **options)


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
    from cfepy.mission.spec import MissionSpec

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
    if len(names) > 1 and Path(names[0]).is_file():
        raise UsageError(f"{names[1]!r} is no argument for it; write NAME:=VALUE", file=names[0])
    if len(names) == 2:
        here = Path.cwd() / names[1]
        plans = importlib.import_module("rospy_shim.roslaunch.plan")
        return Path(plans.launch_file(names[0], names[1], here, os.environ)), args
    if len(names) != 1:
        raise UsageError(f"{len(names)} names; give a launch file, or a package and the name of a launch file in it")
    file = Path(names[0])
    if not file.is_file():
        raise UsageError("there is no such launch file", file=file)
    return file.resolve(), args


def with_launch_files(spec: MissionSpec, launches: list[tuple[Path, Mapping[str, str]]]) -> MissionSpec:
    """A mission with the nodes of launch files added to its own.

    Args:
        spec: the mission.
        launches: launch files, and the arguments of each.

    Raises:
        UsageError: one of them is wrong.
    """
    environ = mission_environment()
    nodes, params, notes = dict(spec.ros.nodes), dict(spec.ros.params), list(spec.notes)
    taken = [entry.name for entry in entries(spec.startup_script)]
    added: dict[str, NodeConfig] = {}
    for file, args in launches:
        plan = plan_of(file, args, environ, taken=[*taken, *added])
        added.update(plan.nodes)
        params = _merged(plan.params, params)
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
    """Lines of a startup script; the name is also the file's, which nobody opens."""
    numbers = f"{PRIORITY}, {STACK_BYTES}, 0x0, {RESTART_NOTHING}"
    return "".join(f"CFE_APP, {app}, __main__, {app}, {numbers};\n" for app in nodes).encode()


def _merged(tree: Mapping[str, Any], over: Mapping[str, Any]) -> dict[str, Any]:
    """Two trees of parameters as one; `over` counts where both say something."""
    merged = dict(tree)
    for name, value in over.items():
        below = merged.get(name)
        merged[name] = _merged(below, value) if isinstance(below, dict) and isinstance(value, dict) else value
    return merged

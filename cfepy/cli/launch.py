"""`cfepy launch`: run the ROS nodes of a launch file, or tell what is in it."""

from __future__ import annotations

import argparse
import importlib
import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from cfepy.cli.main import ENDED_WELL
from cfepy.cli.run import run_spec
from cfepy.mission import MissionSpec
from cfepy.mission.launch import plan_of, spec_of
from cfepy.mission.limits import MissionLimits
from cfepy.nodes.config import NodeConfig
from cfepy.status import UsageError


def run(arguments: argparse.Namespace) -> int:
    """Run the launch file that the command line names.

    Returns:
        The exit status.

    Raises:
        UsageError: there is none, or something in it is wrong.
    """
    file, args = launch_file(arguments.words)
    plan = plan_of(file, args, dict(os.environ), cwd=Path.cwd())
    if arguments.nodes or arguments.dump_params:
        _tell(plan, arguments)
        return ENDED_WELL
    if not plan.nodes:
        why = "; ".join(plan.notes) or "it has no <node>"
        raise UsageError(f"has no node that can run here: {why}", file=file)
    return run_spec(arguments, mission_of(file, plan.nodes, plan, arguments.board))


def launch_file(words: Sequence[str]) -> tuple[Path, dict[str, str]]:
    """The launch file and the arguments that a command line names.

    Raises:
        UsageError: there is no such file.
    """
    args = dict(word.split(":=", 1) for word in words if ":=" in word)
    names = [word for word in words if ":=" not in word]
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


def mission_of(file: Path, nodes: Mapping[str, NodeConfig], plan: Any, board: str | None) -> MissionSpec:
    """The mission of a plan's nodes; a board that somebody chose keeps its own limits."""
    spec = spec_of(file, nodes, plan.params, tuple(plan.notes))
    return spec if board is None else replace(spec, limits=MissionLimits())


def _tell(plan: Any, arguments: argparse.Namespace) -> None:
    if arguments.nodes:
        for node in (*plan.nodes.values(), *(test.node for test in plan.tests if test.node is not None)):
            print(f"/{node.name}")
    if arguments.dump_params:
        import yaml

        print(yaml.safe_dump(plan.params, default_flow_style=False), end="")

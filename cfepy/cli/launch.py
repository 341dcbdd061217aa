"""`cfepy launch`: run the ROS nodes of a launch file, or tell what is in it."""

from __future__ import annotations

import argparse
import importlib
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from cfepy.cli.main import ENDED_WELL
from cfepy.cli.ros_view import BOOT_S, RosView
from cfepy.cli.run import DEFAULT_S, View, run_spec
from cfepy.mission.launch import plan_of, read_launch
from cfepy.status import UsageError


def run(arguments: argparse.Namespace) -> int:
    """Run the launch file that the command line names.

    Returns:
        The exit status.

    Raises:
        UsageError: there is none, or something in it is wrong.
    """
    file, args = launch_file(arguments.words)
    if arguments.nodes or arguments.dump_params:
        _tell(plan_of(file, args, dict(os.environ), cwd=Path.cwd()), arguments)
        return ENDED_WELL
    spec = read_launch(file, args)
    if arguments.seconds is not None or arguments.realtime is None:
        arguments.seconds = BOOT_S + (DEFAULT_S if arguments.seconds is None else arguments.seconds)
    return run_spec(arguments, spec, View() if arguments.console else RosView())


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


def _tell(plan: Any, arguments: argparse.Namespace) -> None:
    for note in plan.notes:
        print(f"cfepy: {note}", file=sys.stderr, flush=True)
    if arguments.nodes:
        for node in (*plan.nodes.values(), *(test.node for test in plan.tests if test.node is not None)):
            print(f"/{node.name}")
    if arguments.dump_params:
        import yaml

        print(yaml.safe_dump(plan.params, default_flow_style=False), end="")

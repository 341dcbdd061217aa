"""`cfepy launch`: run the ROS nodes of a launch file, or tell what is in it."""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path
from typing import Any

from cfepy.cli.main import ENDED_WELL
from cfepy.cli.recording import recording
from cfepy.cli.ros_view import RosView
from cfepy.cli.run import View, run_spec
from cfepy.mission.course import BOOT_S, DEFAULT_S
from cfepy.mission.launch import launch_file, plan_of, read_launch
from cfepy.mission.run_plan import LAUNCH


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
    with recording(arguments, arguments.words, LAUNCH) as journal:
        spec = read_launch(file, args)
        if arguments.seconds is not None or arguments.realtime is None:
            arguments.seconds = BOOT_S + (DEFAULT_S if arguments.seconds is None else arguments.seconds)
        return run_spec(arguments, spec, View() if arguments.console else RosView(), journal)


def _tell(plan: Any, arguments: argparse.Namespace) -> None:
    for note in plan.notes:
        print(f"cfepy: {note}", file=sys.stderr, flush=True)
    if arguments.nodes:
        for node in (*plan.nodes.values(), *(test.node for test in plan.tests if test.node is not None)):
            print(f"/{node.name}")
    if arguments.dump_params:
        import yaml

        print(yaml.safe_dump(plan.params, default_flow_style=False), end="")

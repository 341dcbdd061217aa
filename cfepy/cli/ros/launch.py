"""`cfepy launch`: run the ROS nodes of a launch file, or print its contents."""

from __future__ import annotations

import argparse
import os
from pathlib import Path

from cfepy.cli.main import ENDED_WELL
from cfepy.cli.options import launch_words, plan_of
from cfepy.cli.ros.view import NodesView
from cfepy.cli.run.run import View, fly_and_tell
from cfepy.cli.user_notes import tell
from cfepy.mission import launch_file
from cfepy.pilot import LAUNCH
from rospy_shim.roslaunch.launch_plan import LaunchPlan
from rospy_shim.roslaunch.launch_plan import plan_of as launch_plan_of


def run(arguments: argparse.Namespace) -> int:
    """Run the launch file that the command line names.

    Returns:
        The exit status.

    Raises:
        UsageError: there is no such file, or it has an error.
    """
    if arguments.nodes or arguments.dump_params:
        file, args = launch_file(launch_words(arguments))
        _show(launch_plan_of(file, args, dict(os.environ), cwd=Path.cwd(), with_compiled=True), arguments)
        return ENDED_WELL
    view = View(arguments) if arguments.console else NodesView(arguments)
    return fly_and_tell(arguments, plan_of(arguments, launch_words(arguments), LAUNCH), view)


def _show(plan: LaunchPlan, arguments: argparse.Namespace) -> None:
    tell(plan.notes)
    if arguments.nodes:
        for node in (*plan.nodes.values(), *(test.node for test in plan.tests if test.node is not None)):
            print(f"/{node.name}")
        for compiled in plan.compiled.values():
            print(compiled.full_name)
    if arguments.dump_params:
        import yaml

        print(yaml.safe_dump(plan.params, default_flow_style=False), end="")

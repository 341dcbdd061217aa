"""`cfepy node`: run one ROS node and show what it prints, as rosrun does."""

from __future__ import annotations

import argparse
import importlib
import os
import re
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TextIO

from cfepy.cli.failures import booting
from cfepy.cli.flight import Interrupts
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS, INTERRUPTED
from cfepy.cli.ros_view import BOOT_S
from cfepy.cli.run import fly, output_path, trace_file, write_numbers
from cfepy.mission import Mission, MissionSpec
from cfepy.mission.launch import spec_of
from cfepy.mission.results import Results
from cfepy.nodes.config import ROSCORE_PARAMS, NodeConfig
from cfepy.status import UsageError

LONGEST_S = 60.0  # virtual time that a node gets when nobody says how long
_OWN_LINE = re.compile(r"\[[\w/]+\] (.*)", re.DOTALL)  # as the console has what nodes print


class NodeDisplay:
    """Shows what the node prints, at once and as it is, and nothing of the flight computer's console.

    Args:
        stream: where to.
    """

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def line(self, text: str) -> None:
        """A line of the console."""
        own = _OWN_LINE.fullmatch(text)
        if own is not None:
            print(own[1], file=self._stream, flush=True)

    def update(self, mission: Mission) -> None:
        """Nothing is drawn between pieces of the run."""

    def close(self) -> None:
        """Every line is shown already."""


def run(arguments: argparse.Namespace) -> int:
    """Run the node that the command line names.

    Returns:
        Its exit status.

    Raises:
        UsageError: there is no such node, or it cannot run like this.
    """
    script, words = node_script(arguments.words)
    spec = spec_of_script(script, words)
    numbers = output_path(arguments.json)
    is_open = arguments.seconds is None
    if not is_open or arguments.realtime is None:
        arguments.seconds = BOOT_S + (LONGEST_S if is_open else arguments.seconds)
    recorder = trace_file(arguments.trace) if arguments.trace else None
    with Interrupts() as interrupts, booting(spec.script):
        flight = fly(arguments, spec, interrupts, None, recorder, lambda quiet, seconds: NodeDisplay(sys.stdout))
    results = Results.of(flight.mission, flight.at, flight.trace)
    unwritten = None if numbers is None else write_numbers(numbers, results, None)
    if unwritten is not None:
        raise unwritten
    return INTERRUPTED if interrupts.asked else _status(flight.mission, results)


def node_script(words: Sequence[str]) -> tuple[Path, list[str]]:
    """The script that a command line names, and what is left for the node.

    Raises:
        UsageError: there is none.
    """
    if Path(words[0]).is_file():
        return Path(words[0]).resolve(), list(words[1:])
    if len(words) == 1 or words[0].endswith(".py"):
        raise UsageError("there is no such script; give one, or a package and the name of a node in it", file=words[0])
    plans = importlib.import_module("rospy_shim.roslaunch.plan")
    found = plans.node_file(words[0], words[1], Path.cwd() / words[1], os.environ)
    return Path(found), list(words[2:])


def spec_of_script(script: Path, words: list[str]) -> MissionSpec:
    """The mission that one node is, with its arguments."""
    plans = importlib.import_module("rospy_shim.roslaunch.plan")
    environ = plans.node_environment(os.environ, os.environ.get("ROS_NAMESPACE", "/"))
    app = re.sub(r"\W", "_", script.stem, flags=re.ASCII).upper()[: plans.LONGEST_NAME]
    config = NodeConfig(app, args=tuple(words), env=environ, script=script, cwd=Path.cwd(), required=True)
    return spec_of(script, {app: config}, ROSCORE_PARAMS)


def _status(mission: Mission, results: Results) -> int:
    """The node's exit status; what went wrong beside it is told."""
    (app,) = mission.spec.ros.nodes
    statuses = {} if mission.ros is None else mission.ros.monitor.statuses
    if app in statuses:
        return int(statuses[app]) & 0xFF
    for problem in (*results.script_problems, *results.problems):
        print(f"cfepy: {problem}", file=sys.stderr)
    if results.script_problems or results.problems:
        return FOUND_PROBLEMS
    seconds = results.virtual_s - BOOT_S
    print(f"cfepy: the node still runs after {seconds:g} virtual seconds; --for runs longer", file=sys.stderr)
    return ENDED_WELL

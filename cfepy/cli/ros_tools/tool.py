"""`cfepy rosbag`, `rosmsg`, `rossrv`, `rosnode` and `tf`: a ROS tool that runs as a node of the ground.

A tool that needs no mission runs in an empty one. A bag for tf is played in an empty one.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from cfepy.cli.json_output import write_text
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS
from cfepy.cli.options import LONGEST_S, refuse_run_options
from cfepy.cli.ros.source import FlightSource
from cfepy.cli.ros_tools import words_of
from cfepy.cli.user_notes import tell, writing
from cfepy.cli.viewed_runs import flight_plan
from cfepy.ground import BagReader, GroundConsole, empty_mission, ground_node_ended, is_bag, with_ground_node
from cfepy.interpreter.host_system import is_absent
from cfepy.mission import MissionSpec
from cfepy.pilot import BOOT_S, DEFAULT_S, RunPlan
from cfepy.status import UsageError
from cfepy.units import NS_PER_S
from cfepy.writing.console import Console

AFTER_BAG_S = 1.0  # time for the last messages of the bag to arrive


def run(arguments: argparse.Namespace) -> int:
    """Carry out the action that the command line names.

    Returns:
        The exit status of the tool.

    Raises:
        UsageError: there is no such mission or bag.
    """
    if hasattr(arguments, "elsewhere"):
        raise UsageError(arguments.elsewhere, field=f"rosbag {arguments.action}")
    if arguments.tool == "tf":
        return _tf(arguments)
    return _rosnode(arguments) if arguments.tool == "rosnode" else _alone(arguments)


class ToolConsole(GroundConsole):
    """Takes the output of a tool, and shows it between two steps of the flight, so that no task fails with the reader.

    Args:
        show: receives its lines; lines of its standard error go to the standard error of this process.
        with_others: show the output of other nodes as well.

    Attributes:
        status: the tool's exit status, when it has ended.
    """

    def __init__(self, show: Callable[[str], Any] = print, with_others: bool = False) -> None:
        super().__init__()
        self.status: int | None = None
        self._show_line, self._with_others = show, with_others
        self._waiting: list[tuple[str, str]] = []

    def take(self, said: dict[str, Any]) -> None:
        """Keep a line of the tool, or its exit status."""
        self.status = said.pop("status", self.status)
        self._waiting += said.items()

    def overhear(self, text: str) -> None:
        """Keep a line of another node."""
        if self._with_others:
            self._waiting.append(("out", text))

    def show(self) -> None:
        """Show the lines since the last call."""
        waiting, self._waiting = self._waiting, []
        for stream, line in waiting:
            if stream == "out":
                self._show_line(line)
            else:
                sys.stdout.flush()
                print(line, file=sys.stderr, flush=True)


def _fly(plan: RunPlan, spec: MissionSpec, console: ToolConsole, flies_on: bool = False) -> None:
    """Fly a mission until its tool has ended, or to the end."""

    def is_over() -> bool:
        console.show()
        return not flies_on and (console.status is not None or ground_node_ended(source.mission))

    with FlightSource(plan, spec, Console(sink=console.line)) as source:
        source.fly(is_over)


# -- without a mission -------------------------------------------------------------------------------------------------


def _alone(arguments: argparse.Namespace) -> int:
    console = ToolConsole()
    spec = with_ground_node(empty_mission(), "ground_tool", [arguments.tool, words_of(arguments), None])
    _fly(RunPlan((arguments.tool,), seconds=LONGEST_S, stall=0), spec, console)  # a large bag takes its time
    return FOUND_PROBLEMS if console.status is None else console.status


# -- nodes -------------------------------------------------------------------------------------------------------------


def _rosnode(arguments: argparse.Namespace) -> int:
    if is_bag(arguments.source):
        raise UsageError("a bag has no nodes; give a mission", file=arguments.source)
    plan, action = flight_plan(arguments), arguments.action
    words = words_of(arguments, ["-c", str(arguments.pings)] if action == "ping" else [])
    at_s = (plan.virtual_s or DEFAULT_S) if arguments.at is None else arguments.at
    flies_on = action == "kill" and arguments.at is not None
    console = ToolConsole(with_others=flies_on)
    spec = with_ground_node(plan.spec(), "ground_tool", ["rosnode", words, at_s])
    _fly(plan if flies_on else replace(plan, seconds=LONGEST_S), spec, console, flies_on=flies_on)
    if console.status is None:
        tell([f"the run ended before {at_s:g} s, the time of rosnode {action}; give an earlier --at"])
        return FOUND_PROBLEMS
    return console.status


# -- transforms --------------------------------------------------------------------------------------------------------


def _tf(arguments: argparse.Namespace) -> int:
    if is_bag(arguments.source):
        plan, base = _played(arguments)
    else:
        plan = flight_plan(arguments)
        base = replace(plan, play=None).spec()
    return (_echo if arguments.action == "echo" else _frames)(arguments, plan, base)


def _played(arguments: argparse.Namespace) -> tuple[RunPlan, MissionSpec]:
    """Make the run that only plays a bag, with the time of the bag as ROS time."""
    refuse_run_options(
        arguments, f"only valid for a mission, and {arguments.source} is a bag; leave it out", but=["seconds"]
    )
    with BagReader(arguments.source) as bag:
        whole_s = bag.length_ns / NS_PER_S + AFTER_BAG_S
    spec = empty_mission()
    spec = replace(spec, ros=replace(spec.ros, params={**spec.ros.params, "use_sim_time": True}))
    seconds = BOOT_S + (whole_s if arguments.seconds is None else arguments.seconds)
    return RunPlan((arguments.source,), seconds=seconds, play=arguments.source), spec


def _tell_transforms(plan: RunPlan, base: MissionSpec, words: Sequence[str], console: ToolConsole) -> None:
    """Fly a mission with a tool that listens to its transforms. A bag is played from when the tool listens."""
    spec = plan.with_played_bag(with_ground_node(base, "ground_tool", ["tf", words, None]))
    _fly(plan, spec, console)


def _echo(arguments: argparse.Namespace, plan: RunPlan, base: MissionSpec) -> int:
    count = 0

    def show(line: str) -> None:
        nonlocal count
        count += line.startswith("At time ")
        print(line)

    limit = [] if arguments.count is None else [str(arguments.count)]
    _tell_transforms(plan, base, ["echo", *arguments.words, str(arguments.rate), *limit], ToolConsole(show))
    if not count:
        tell([f"no transform from {arguments.words[0]} to {arguments.words[1]} in {arguments.source}"])
    return ENDED_WELL if count else FOUND_PROBLEMS


def _frames(arguments: argparse.Namespace, plan: RunPlan, base: MissionSpec) -> int:
    lines: list[str] = []
    until_s = DEFAULT_S if plan.virtual_s is None else plan.virtual_s
    console = ToolConsole(lines.append)
    _tell_transforms(replace(plan, seconds=LONGEST_S), base, ["frames", str(until_s)], console)
    found: dict[str, Any] = json.loads(lines[0]) if lines else {}
    if not found.get("frames"):
        tell([f"no transform in {arguments.source}"])
        return FOUND_PROBLEMS
    if arguments.pdf is not None:
        with writing(arguments.pdf, "--pdf"):
            Path(arguments.pdf).write_bytes(drawn(found["dot"], "pdf"))
    if arguments.dot is not None:
        write_text(arguments.dot, found["dot"] + "\n", "--dot", arguments)
    print(tree_text(found["frames"]))
    return ENDED_WELL


def drawn(dot: str, kind: str) -> bytes:
    """Draw a graph with graphviz, as view_frames does.

    Args:
        dot: the graph.
        kind: a format of `dot -T`, such as "pdf".

    Returns:
        The drawing.

    Raises:
        UsageError: graphviz is not installed, or rejects the graph.
    """
    try:
        run = subprocess.run(["dot", f"-T{kind}"], input=dot.encode(), capture_output=True, check=True)
    except OSError as error:
        if not is_absent("dot", error):
            raise UsageError(f"dot cannot be started: {error.strerror}", field=f"--{kind}") from None
        hint = "requires graphviz, and its command `dot` is not installed; --dot FILE writes the input of `dot`"
        raise UsageError(hint, field=f"--{kind}") from None
    except subprocess.CalledProcessError as error:
        raise UsageError(f"dot: {error.stderr.decode(errors='replace').strip()}", field=f"--{kind}") from None
    return run.stdout


def tree_text(frames: dict[str, dict[str, Any]]) -> str:
    """Format frames as a tree of lines, children below their parent.

    Args:
        frames: the result of `allFramesAsYAML` of tf2, by name.

    Returns:
        The text.
    """
    children: dict[str, list[str]] = {}
    for name, frame in frames.items():
        children.setdefault(frame["parent"], []).append(name)

    def lines(name: str, depth: int) -> Iterator[str]:
        about = f"  {_about(frames[name])}" if name in frames else ""
        yield f"{'  ' * depth}{name}{about}"
        for child in sorted(children.get(name, [])):
            yield from lines(child, depth + 1)

    return "\n".join(line for root in sorted(children) if root not in frames for line in lines(root, 0))


def _about(frame: dict[str, Any]) -> str:
    """Describe who broadcasts a frame, and how often."""
    if not frame["buffer_length"]:
        return f"once, by {frame['broadcaster']}"
    return f"{frame['rate']:.3f} Hz for {frame['buffer_length']:.1f} s, by {frame['broadcaster']}"

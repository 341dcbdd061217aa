"""`cfepy node`: run one ROS node and show what it prints, as rosrun does."""

from __future__ import annotations

import argparse
import re
import sys
from typing import TYPE_CHECKING, TextIO

from cfepy.cli.failures import booting
from cfepy.cli.flight import Interrupts
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS, INTERRUPTED
from cfepy.cli.recording import recording
from cfepy.cli.run import fly, output_path, tell_faults, trace_file, write_numbers
from cfepy.mission import Mission, MissionSpec
from cfepy.mission.course import BOOT_S, NODE_S
from cfepy.mission.results import Results
from cfepy.mission.run_plan import NODE
from cfepy.mission.single_node import node_script, spec_of_script

if TYPE_CHECKING:
    from cfepy.journal.recorder import JournalRecorder
    from cfepy.journal.replay import Replay

FAULT = "cfepy fault "  # how lines about faults begin
_OWN_LINE = re.compile(r"\[[\w/]+\] (.*)", re.DOTALL)  # as the console has what nodes print


def node_display(quiet: bool, seconds: float) -> NodeDisplay:
    """What shows the node; see `cfepy.cli.display.make_display`."""
    return NodeDisplay(sys.stdout)


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
        elif text.startswith(FAULT):
            print(text, file=sys.stderr, flush=True)

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
    with recording(arguments, arguments.words, NODE) as journal:
        spec = spec_of_script(*node_script(arguments.words))
        is_open = arguments.seconds is None
        if not is_open or arguments.realtime is None:
            arguments.seconds = BOOT_S + (NODE_S if is_open else arguments.seconds)
        return run_node(arguments, spec, journal)


def run_node(
    arguments: argparse.Namespace,
    spec: MissionSpec,
    journal: JournalRecorder | None = None,
    replay: Replay | None = None,
) -> int:
    """Run a mission that is one node; see `run`.

    Args:
        arguments: of the command line.
        spec: the mission.
        journal: writes it down.
        replay: makes it the run of a journal.
    """
    numbers = output_path(arguments.json)
    recorder = trace_file(arguments.trace) if arguments.trace else None
    with Interrupts() as interrupts, booting(spec.script):
        flight = fly(arguments, spec, interrupts, None, recorder, node_display, None, journal, replay)
    results = Results.of(flight.mission, flight.at, flight.trace)
    if journal is not None:
        journal.end(results, None, flight.reason)
    if replay is not None:
        replay.compare(results)
    tell_faults(results)
    unwritten = None if numbers is None else write_numbers(numbers, results, None)
    if unwritten is not None:
        raise unwritten
    longer = "--for runs longer" if replay is None else replay.why_over
    return INTERRUPTED if interrupts.asked else _status(flight.mission, results, longer)


def _status(mission: Mission, results: Results, longer: str) -> int:
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
    print(f"cfepy: the node still runs after {seconds:g} virtual seconds; {longer}", file=sys.stderr)
    return ENDED_WELL

"""`cfepy node`: run one ROS node and show what it prints, as rosrun does."""

from __future__ import annotations

import argparse
import re
import sys
from typing import TextIO

from cfepy.cli.display import Display, SilentDisplay
from cfepy.cli.main import BAD_USAGE, ENDED_WELL, FOUND_PROBLEMS, INTERRUPTED
from cfepy.cli.options import plan_of
from cfepy.cli.run.outputs import Outputs
from cfepy.cli.run.report import failed_steps
from cfepy.cli.run.run import View, fly_and_tell
from cfepy.cli.text_table import show_tables
from cfepy.cli.user_notes import tell
from cfepy.mission import Mission
from cfepy.pilot import ENDED, NODE, FailureKind, Flown
from cfepy.writing.escapes import node_text, raw

FAULT = "cfepy fault "  # prefix of lines about faults
_OWN_LINE = re.compile(r"\[[\w/]+\] (.*)", re.DOTALL)  # format of node output on the console


class NodeDisplay:
    """Shows the output of the node at once, with its colours, and nothing of the flight computer's console.

    Args:
        stream: the output.
    """

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._colours = stream.isatty()

    def line(self, text: str) -> None:
        """Show a line of the console if it is from the node."""
        own = _OWN_LINE.fullmatch(text)
        if own is not None:
            stream = raw(self._stream)
            print(node_text(own[1], self._colours), file=stream, flush=True)
        elif text.startswith(FAULT):
            print(text, file=sys.stderr, flush=True)

    def tell(self, text: str) -> None:
        """Print a message to standard error: standard output is the node's."""
        tell([text])

    def update(self, mission: Mission) -> None:
        """Do nothing: this display draws nothing."""

    def close(self) -> None:
        """Do nothing: every line is shown already."""


class NodeView(View):
    """The view of a single node, with its exit status; see `View`."""

    longer = "--for runs longer"

    def display(self, seconds: float) -> Display:
        """Make the display of the node's output."""
        return SilentDisplay() if self.hides_console else NodeDisplay(sys.stdout)

    def end(self, flown: Flown, outputs: Outputs, longer: str) -> int:
        """Print problems other than the node's own. Returns the exit status of the node or of the run's script."""
        outputs.save_files(flown, self.quiet)
        if self.quiet:
            print("".join(f"{line}\n" for line in failed_steps(flown)), end="")
        else:
            show_tables(self.tables, sys.stdout)
            tell([*flown.results.never_happened, *flown.results.traps])
            if flown.outcome is not None:
                print(flown.outcome.text())
        return _status(flown, longer)


def run(arguments: argparse.Namespace) -> int:
    """Run the node that the command line names.

    Returns:
        Its exit status.

    Raises:
        UsageError: there is no such node, or the options do not allow the run.
    """
    return fly_and_tell(arguments, plan_of(arguments, arguments.words, NODE), NodeView(arguments))


def _status(flown: Flown, longer: str) -> int:
    """Return the node's exit status. If it is 0 and the run had problems nevertheless, return another one."""
    mission, results = flown.mission, flown.results
    app = next(iter((*mission.spec.ros.nodes, *mission.spec.built)), "")
    statuses = {} if mission.ros is None else mission.ros.monitor.statuses
    end = int(statuses.get(app, 0)) & 0xFF
    is_end = [FailureKind.ENDED, FailureKind.RAISED]  # the node's own output and status show these
    tell(
        problem.text
        for problem in flown.problems
        if not problem.is_step and not (end and all(each.kind in is_end for each in problem.failures))
    )
    if flown.interrupted:
        return INTERRUPTED
    if end and flown.outcome is None and flown.stall is None:
        return end
    if results.problems:
        return FOUND_PROBLEMS
    if results.booted_s is None and not mission.over:
        tell([f"the node has not started after {results.virtual_s:g} virtual seconds; {longer}"])
        return BAD_USAGE
    is_over = app in statuses or any(each.name in mission.spec.built and each.state == ENDED for each in results.apps)
    if flown.outcome is None and not is_over:
        tell([f"the node still runs after {results.virtual_s:g} virtual seconds; {longer}"])
    return ENDED_WELL

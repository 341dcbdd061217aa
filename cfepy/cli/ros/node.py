"""`cfepy node`: run one ROS node and show what it prints, as rosrun does."""

from __future__ import annotations

import argparse
import re
import sys
from typing import TextIO

from cfepy.cli.display import Display, SilentDisplay
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS, INTERRUPTED
from cfepy.cli.options import plan_of
from cfepy.cli.run.outputs import Outputs
from cfepy.cli.run.run import View, fly_and_tell
from cfepy.cli.user_notes import tell
from cfepy.mission import Mission
from cfepy.pilot import BOOT_S, ENDED, NODE, FailureKind, Flown
from cfepy.writing.escapes import node_text, raw

FAULT = "cfepy fault "  # how lines about faults begin
_OWN_LINE = re.compile(r"\[[\w/]+\] (.*)", re.DOTALL)  # as the console has what nodes print


class NodeDisplay:
    """Shows what the node prints, at once, with its colours, and nothing of the flight computer's console.

    Args:
        stream: where to.
    """

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._colours = stream.isatty()

    def line(self, text: str) -> None:
        """A line of the console."""
        own = _OWN_LINE.fullmatch(text)
        if own is not None:
            stream = raw(self._stream)
            print(node_text(own[1], self._colours), file=stream, flush=True)
        elif text.startswith(FAULT):
            print(text, file=sys.stderr, flush=True)

    def tell(self, text: str) -> None:
        """Standard output is the node's."""
        tell([text])

    def update(self, mission: Mission) -> None:
        """Nothing is drawn between pieces of the run."""

    def close(self) -> None:
        """Every line is shown already."""


class NodeView(View):
    """See `View`; this one is of a single node, with its exit status."""

    longer = "--for runs longer"

    def display(self, seconds: float) -> Display:
        """What shows the node's output."""
        return SilentDisplay() if self.quiet else NodeDisplay(sys.stdout)

    def end(self, flown: Flown, outputs: Outputs, longer: str) -> int:
        """Print what went wrong apart from the node, and return the node's exit status, or that of the run's script."""
        outputs.save_files(flown)
        tell(flown.results.never_happened)
        if flown.outcome is not None:
            print(flown.outcome.text())
        return _status(flown, longer)


def run(arguments: argparse.Namespace) -> int:
    """Run the node that the command line names.

    Returns:
        Its exit status.

    Raises:
        UsageError: there is no such node, or it cannot run like this.
    """
    return fly_and_tell(arguments, plan_of(arguments, arguments.words, NODE), NodeView(arguments.quiet))


def _status(flown: Flown, longer: str) -> int:
    """The node's exit status, unless it is 0 and something went wrong nevertheless, which is printed."""
    mission, results = flown.mission, flown.results
    app = next(iter((*mission.spec.ros.nodes, *mission.spec.built)), "")
    statuses = {} if mission.ros is None else mission.ros.monitor.statuses
    end = int(statuses.get(app, 0)) & 0xFF
    is_end = [FailureKind.ENDED, FailureKind.RAISED]  # of which the node's own output and status tell
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
    is_over = app in statuses or any(each.name in mission.spec.built and each.state == ENDED for each in results.apps)
    if flown.outcome is None and not is_over:
        tell([f"the node still runs after {results.virtual_s - BOOT_S:g} virtual seconds; {longer}"])
    return ENDED_WELL

"""The commands replay and diff, which work on journals; their options are defined here.

A command belongs here if it repeats a recorded run, also step by step, or compares two of them.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable

from cfepy.cli.flight_options import add_outputs
from cfepy.cli.options import NO_CI_OUTPUTS, TASK_KINDS, add_from_disk, add_until, whole_number_of
from cfepy.plugins import Hook

STOPS: Hook[Callable[[argparse.ArgumentParser], None]] = Hook("replay_options")
"""Functions that add the options which stop the whole mission for a debugger. `NO_STOPS` has the default values."""
NO_STOPS = {"stops": [], "step": False, "pdb": None, "gdb": None, "back": False, "back_to": None}
_REPLAY_STATUS = (
    "exit status: 0 the same run: all checkpoints, and at the end the digests of trace and numbers; 1 another run, "
    "whose first difference is shown; 2 bad usage, not a journal, or a mission that cannot boot; 130 ended by Ctrl-C"
)
_DIFF_STATUS = "exit status: 0 the same run, 1 other runs, 2 bad usage"


def add(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add these commands to the parser of `cfepy`."""
    _add_replay(commands)
    _add_diff(commands)


def _add_replay(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    replay = commands.add_parser(
        "replay",
        help="repeat the run of a journal, also step by step",
        description="Repeat a run that `cfepy run --record FILE` wrote down, in virtual time and without network, "
        "and compare.",
        examples=("cfepy replay run.cfepy", "cfepy replay run.cfepy --info"),
        epilog=_REPLAY_STATUS,
    )
    replay.add_argument("journal", metavar="FILE", help="the journal")
    replay.add_argument("--info", action="store_true", help="only show the contents of the journal")
    add_until(replay, "the replay")
    replay.set_defaults(**NO_STOPS, **NO_CI_OUTPUTS)
    for add_stops in STOPS.all():
        add_stops(replay)
    add_from_disk(replay)
    replay.add_argument("--tasks", choices=TASK_KINDS, help="kind of tasks (default: as recorded)")
    replay.add_argument("--console", action="store_true", help="show the flight computer's console of a launch, too")
    add_outputs(replay)
    replay.set_defaults(module="cfepy.cli.journal.replay")


def _add_diff(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    diff = commands.add_parser(
        "diff",
        help="show where two runs differ first",
        examples=("cfepy diff good.cfepy bad.cfepy", "cfepy diff monday.trace tuesday.trace --lines 20"),
        description="Report where two runs differ first: which timer, which message with which values, or which step "
        "of a task, with its line of source; then the differences of each topic. Journals are replayed for that, "
        "each with its own files.",
        epilog=_DIFF_STATUS,
    )
    diff.add_argument("one", metavar="A", help="a journal, or a file that `cfepy run --trace FILE` wrote")
    diff.add_argument("other", metavar="B", help="another one of its kind")
    diff.add_argument(
        "--lines",
        type=whole_number_of,
        metavar="N",
        help="also show the records: the two that differ, with stacks and bytes, and N before them",
    )
    diff.set_defaults(module="cfepy.cli.journal.diff")

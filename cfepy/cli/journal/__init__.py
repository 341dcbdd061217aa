"""The commands replay and diff, which work on journals; here are their options.

A command belongs here when it does a recorded run again, also step by step, or compares two of them. This module
imports argparse only, for a quick start.
"""

from __future__ import annotations

import argparse

from cfepy.cli.flight_options import add_outputs
from cfepy.cli.options import TASK_KINDS, add_from_disk, add_until

_REPLAY_STATUS = """exit status:
  0    the same run as far as it is known: every checkpoint, and at the end the digests of trace and numbers
  1    another run; it is said where the two part
  2    bad usage, a file that is no journal, or a mission that cannot boot
  130  ended by Ctrl-C, SIGTERM or SIGHUP"""
_DIFF_STATUS = "exit status: 0 the same run, 1 other runs, 2 bad usage"


def add(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add these commands to the parser of `cfepy`."""
    _add_replay(commands)
    _add_diff(commands)


def _add_replay(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    replay = commands.add_parser(
        "replay",
        help="do the run of a journal again",
        description="Do a run again that `cfepy run --record FILE` wrote down, in virtual time and without network, "
        "and compare.",
        epilog=_REPLAY_STATUS,
    )
    replay.add_argument("journal", metavar="FILE", help="the journal")
    replay.add_argument("--info", action="store_true", help="only show what the journal has, and run nothing")
    add_until(replay, "the replay")
    _add_stops(replay)
    add_from_disk(replay)
    replay.add_argument("--tasks", choices=TASK_KINDS, help="what tasks run on (default: as recorded)")
    replay.add_argument("--console", action="store_true", help="show the flight computer's console of a launch, too")
    add_outputs(replay)
    replay.set_defaults(module="journal.replay")


def _add_stops(replay: argparse.ArgumentParser) -> None:
    """The options that stop the whole mission for the debugger."""
    replay.add_argument(
        "--break",
        dest="stops",
        action="append",
        default=[],
        metavar="WHAT",
        help="stop at an event (APP:ID or APP:ERROR), at a MsgId, packet or topic by its name, or at messages of which "
        "a Python expression holds, such as 'topic == \"/odom\" and msg.x > 3'; may be given several times",
    )
    replay.add_argument("--step", action="store_true", help="stop at everything that happens, from --until on")
    replay.add_argument(
        "--pdb",
        metavar="APP",
        help="open Python's debugger in this application: at its first line, at the first stop of --break, or from "
        "--until on; and where an exception ends it",
    )
    replay.add_argument(
        "--back",
        action="store_true",
        help="stop at the end of the run, or at --until, too; at each stop, b goes back to what happened before, rc to "
        "the last breakpoint, bt WHAT to the last time at which something happened or held, and in Python's debugger "
        "there are rstep and rcontinue",
    )
    replay.add_argument(
        "--back-to",
        metavar="WHAT",
        help="stop at the last time at which WHAT, as of --break, happened, or at which an expression about variables "
        "held, such as 'self.state == 3'",
    )
    replay.add_argument(
        "--gdb",
        metavar="APP",
        help="open gdb on this process, with the symbols of compiled applications: it stops at the main function of "
        "this application, or at the first stop of --break or --until",
    )


def _add_diff(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    diff = commands.add_parser(
        "diff",
        help="show where two runs part",
        description="Show the first record in which two runs differ, what both did before it, and what else they "
        "differ in. Journals are replayed for that, each with its own files.",
        epilog=_DIFF_STATUS,
    )
    diff.add_argument("one", metavar="A", help="a journal, or a file that `cfepy run --trace FILE` wrote")
    diff.add_argument("other", metavar="B", help="another one of its kind")
    diff.add_argument(
        "--lines", type=int, default=6, metavar="N", help="records that are shown before the one that differs"
    )
    diff.set_defaults(module="journal.diff")

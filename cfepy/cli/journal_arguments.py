"""What the command line understands of journals: replay, diff. Imports only argparse."""

from __future__ import annotations

import argparse

from cfepy.cli.arguments import seconds_of

_REPLAY_STATUS = """exit status:
  0    the same run as far as it is known: every checkpoint, and at the end the digests of trace and numbers
  1    another run; it is said where the two part
  2    bad usage, a file that is no journal, or a mission that cannot boot
  130  ended by Ctrl-C or SIGTERM"""
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
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    replay.add_argument("journal", metavar="FILE", help="the journal")
    replay.add_argument("--info", action="store_true", help="only show what the journal has, and run nothing")
    replay.add_argument(
        "--until", type=seconds_of, metavar="SECONDS", help="end at this virtual time (default: where the run ended)"
    )
    _add_stops(replay)
    add_source(replay)
    replay.add_argument("--tasks", choices=("thread", "greenlet"), help="what tasks run on (default: as recorded)")
    replay.add_argument("--console", action="store_true", help="show the flight computer's console of a launch, too")
    replay.add_argument("--json", metavar="FILE", help="write the report's numbers to a file")
    replay.add_argument("--save-files", metavar="DIR", help="at the end write the files that the mission wrote")
    replay.add_argument("--bag", metavar="FILE", help="record the ROS topics of the run into a bag")
    replay.add_argument("--bag-topics", nargs="+", action="extend", default=[], metavar="TOPIC", help="only these")
    replay.add_argument("--trace", metavar="FILE", help="write everything that happened to a file, a line each")
    replay.add_argument("--quiet", action="store_true", help="no console and no status line, only the report")
    replay.set_defaults(module="replay")


def _add_stops(replay: argparse.ArgumentParser) -> None:
    """Where the whole mission is to stand still, for somebody to look at it."""
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


def add_source(parser: argparse.ArgumentParser) -> None:
    """Which files the mission is made of."""
    parser.add_argument(
        "--from-disk",
        action="store_true",
        help="take the mission's files as they are on this computer now, not those that the journal carries",
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
    diff.set_defaults(module="diff")

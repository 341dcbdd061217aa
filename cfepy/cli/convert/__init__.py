"""The command for ROS nodes in C++: convert; here are its options.

A command belongs here when it makes applications of cFE out of ROS nodes, or says what keeps it from doing so.
"""

from __future__ import annotations

import argparse

from cfepy.cli.options import add_json, add_output

_WORDS = "a package, its folder, or a launch file with its arguments as NAME:=VALUE"
_STATUS = "exit status: 0 well, 1 a node cannot be converted, 2 bad usage, or nothing to convert"


def add(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add these commands to the parser of `cfepy`."""
    convert = commands.add_parser(
        "convert",
        help="make cFE applications of ROS nodes in C++",
        description="Make applications for a cFS 7.0.0 mission tree, and a mission for cfepy, of the ROS nodes in C++ "
        "of a launch file or a package. Their sources stay as they are.",
        epilog=_STATUS,
    )
    convert.add_argument("words", metavar="WORD", nargs="+", help=_WORDS)
    add_output(convert, "a folder of the name here")
    convert.add_argument(
        "--profile",
        choices=("host", "pool", "strict"),
        default="host",
        help="what nodes may do: host: exceptions and the heap; pool: an arena of their own as a heap, no exceptions; "
        "strict: nothing of both (default: host)",
    )
    convert.add_argument("--ids", metavar="MISSION", help="take the MsgIds of this mission and its topics.lock")
    convert.add_argument("--force", action="store_true", help="write over files that were changed by hand, too")
    add_json(convert, "the report")
    convert.set_defaults(module="convert.convert")

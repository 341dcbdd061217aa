"""The command board; its options are defined here.

A command belongs here if it is about boards, or writes the profile of one.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from typing import Any

from cfepy.cli.options import add_json, seconds_of
from cfepy.plugins import Hook

FASTEST_CPU_HZ = 1e11
_NEW = "board new mine.yaml --cpu-hz 120e6 --round-trip 8us --short 6us --long 20us"
ACTIONS: Hook[Callable[[Any], None]] = Hook("board_actions")
"""Functions that add actions to the command board."""


def add(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add these commands to the parser of `cfepy`."""
    board = commands.add_parser(
        "board",
        help="list boards, show whether a mission fits, write a profile",
        description="List boards, report the needs of a mission, or write the profile of your own board.",
        examples=("cfepy board list", f"cfepy {_NEW}"),
    )
    actions = board.add_subparsers(metavar="ACTION", required=True)
    boards = actions.add_parser(
        "list",
        help="list the boards and their main numbers",
        description="List the boards that cfepy has profiles of, and their main numbers.",
        examples=("cfepy board list",),
    )
    add_json(boards, "the table")
    boards.set_defaults(module="cfepy.cli.board.board_list")
    for add_actions in ACTIONS.all():
        add_actions(actions)
    _add_new(actions)
    _add_program(actions)


def _add_new(actions: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    new = actions.add_parser(
        "new",
        help="write a profile from three measurements",
        examples=(f"cfepy {_NEW}",),
        description="Write a profile of a board, whose costs follow from three times that were measured on it; "
        "docs/reference/board_profiles.md explains it.",
    )
    new.add_argument("file", metavar="FILE.yaml", help="the profile to write; the board has the name of this file")
    new.add_argument("--cpu-hz", type=_cycles_of, required=True, metavar="HZ", help="processor clock, such as 120e6")
    new.add_argument(
        "--round-trip",
        type=seconds_of,
        required=True,
        metavar="TIME",
        help="of two tasks that wake each other by binary semaphores, such as 8us",
    )
    new.add_argument(
        "--short",
        type=seconds_of,
        required=True,
        metavar="TIME",
        help="to send a message of 32 bytes on the Software Bus and receive it, in one task",
    )
    new.add_argument("--long", type=seconds_of, required=True, metavar="TIME", help="the same with 2048 bytes")
    new.add_argument("--tick", type=seconds_of, metavar="TIME", help="the kernel's tick, such as 10ms (default: none)")
    new.add_argument("--ram", metavar="SIZE", help="such as 512KiB or 8MiB (default: no limit)")
    new.add_argument("--flash", metavar="SIZE", help="such as 4MiB (default: no limit)")
    new.set_defaults(module="cfepy.cli.board.new")


def _add_program(actions: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    program = actions.add_parser(
        "program",
        help="write the application, in C, that takes these measurements",
        examples=("cfepy board program measure_board",),
        description="Write an application of cFS, in C, that measures the three times on a board and reports them in "
        "an event, as options of `cfepy board new`.",
    )
    program.add_argument("folder", metavar="FOLDER", help="of the application; it must not be there yet")
    program.set_defaults(module="cfepy.cli.board.program")


def _cycles_of(text: str) -> int:
    """Parse a clock rate in Hz, for argparse."""
    try:
        rate = float(text)
    except ValueError:
        rate = 0.0
    if not 1 <= rate <= FASTEST_CPU_HZ:
        raise argparse.ArgumentTypeError(f"invalid clock rate {text!r}; expected a number of Hz, such as 120e6")
    return round(rate)

"""The commands run, check, new, boards and board; here are their options.

A command belongs here when it flies a mission once and reports the results, or makes or checks a mission before it
flies. This module imports argparse only, for a quick start.
"""

from __future__ import annotations

import argparse

from cfepy.cli.flight_options import add_flight
from cfepy.cli.options import (
    RUN_OPTIONS,
    STATUS_HELP,
    add_json,
    add_mission,
    add_mission_or_node,
    add_run_options,
    seconds_of,
)

FASTEST_CPU_HZ = 1e11


def add(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add these commands to the parser of `cfepy`."""
    _add_run(commands)
    _add_check(commands)
    _add_new(commands)
    boards = commands.add_parser("boards", help="list the boards and their main numbers")
    boards.set_defaults(module="run.boards")
    _add_board(commands)


def _add_run(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    run = commands.add_parser(
        "run",
        help="run a mission",
        description="Run a mission in virtual time, and report what happened.",
        epilog=STATUS_HELP,
    )
    add_mission_or_node(run)
    add_run_options(run)
    add_flight(run)
    run.set_defaults(module="run.run")


def _add_check(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    check = commands.add_parser(
        "check",
        help="find everything that is wrong with a mission before it boots",
        description="Find what is wrong with a mission, a launch file or a node, and with all that it consists of; "
        "nothing of it is executed.",
        epilog="exit status: 0 nothing found but warnings, 1 something is wrong, 2 no such mission",
    )
    add_mission(check)
    RUN_OPTIONS["launch_args"](check)
    RUN_OPTIONS["cpp_nodes"](check)
    check.add_argument("--board", metavar="NAME|FILE", help="check against this board instead of the mission's own")
    check.add_argument(
        "--faults",
        metavar="FILE|seed:N",
        help="check a fault plan against the mission, too, which flies for 3 virtual seconds for that",
    )
    add_json(check, "what was found")
    check.set_defaults(module="run.check")


def _add_new(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    new = commands.add_parser("new", help="start an application or a mission from a skeleton that runs at once")
    new.add_argument("kind", choices=("app", "mission"), help="what to start")
    new.add_argument("name", metavar="NAME", help="also the name of the folder that is made")
    new.add_argument("--c", action="store_true", help="an application in C, which `cfepy build` compiles")
    new.set_defaults(module="run.new")


def _add_board(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    board = commands.add_parser("board", help="what a mission needs of a board, and a profile from measurements")
    actions = board.add_subparsers(metavar="ACTION", required=True)
    report = actions.add_parser(
        "report",
        help="RAM by owner, flash, CPU, headroom, and what makes a mission fit",
        description="Fly a mission on a board with as much RAM as it asks for; tell what it needs of RAM, flash and "
        "CPU, and the fewest changes that make it fit.",
        epilog="exit status: 0 it fits, 1 it does not, 2 bad usage, or a mission that cannot boot",
    )
    add_mission_or_node(report)
    add_run_options(report)
    add_json(report, "what was found")
    report.set_defaults(module="run.board_report")
    new = actions.add_parser(
        "new",
        help="write a profile from three measurements",
        description="Write a profile of a board, whose costs follow from three times that were measured on it; "
        "docs/board_profiles.md says how.",
    )
    new.add_argument("file", metavar="FILE.yaml", help="the profile that is made; its name is that of the board")
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
    new.set_defaults(module="run.board_new")
    program = actions.add_parser(
        "program",
        help="write the application, in C, that takes these measurements",
        description="Write an application of cFS, in C, that measures the three times on a board and tells them in an "
        "event, as options of `cfepy board new`.",
    )
    program.add_argument("folder", metavar="FOLDER", help="of the application; it must not be there yet")
    program.set_defaults(module="run.board_program")


def _cycles_of(text: str) -> int:
    """A clock rate in Hz, for argparse."""
    try:
        rate = float(text)
    except ValueError:
        rate = 0.0
    if not 1 <= rate <= FASTEST_CPU_HZ:
        raise argparse.ArgumentTypeError(f"{text!r} is no clock rate in Hz, such as 120e6")
    return round(rate)

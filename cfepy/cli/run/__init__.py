"""The commands run, check and new; their options are defined here.

A command belongs here if it flies a mission once and reports the results, or makes or checks a mission before it flies.
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
)


def add(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add these commands to the parser of `cfepy`."""
    _add_run(commands)
    _add_check(commands)
    _add_new(commands)


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
    run.set_defaults(module="cfepy.cli.run.run")


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
    check.set_defaults(module="cfepy.cli.run.check")


def _add_new(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    new = commands.add_parser("new", help="start an application or a mission from a skeleton that runs at once")
    new.add_argument("kind", choices=("app", "mission"), help="what to start")
    new.add_argument("name", metavar="NAME", help="also the name of the folder that is made")
    new.add_argument("--c", action="store_true", help="an application in C, which `cfepy build` compiles")
    new.set_defaults(module="cfepy.cli.run.new")

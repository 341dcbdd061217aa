"""The commands run, check and new; their options are defined here.

A command belongs here if it flies a mission once and reports the results, or makes or checks a mission before it flies.
"""

from __future__ import annotations

import argparse

from cfepy.cli.flight_options import add_flight
from cfepy.cli.options import (
    RUN_OPTIONS,
    STATUS_HELP,
    add_cfe,
    add_ci_outputs,
    add_json,
    add_mission,
    add_mission_or_node,
    add_run_options,
    whole_number_of,
)
from cfepy.cli.parser import shared_group

INTENSITIES = ("low", "medium", "high")


def add(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add these commands to the parser of `cfepy`."""
    _add_run(commands)
    _add_check(commands)
    _add_new(commands)


def _add_run(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    run = commands.add_parser(
        "run",
        help="run a mission",
        examples=(
            "cfepy run capture --for 20",
            "cfepy run my_mission --board rx64m --script checks.txt --record run.cfepy",
        ),
        description="Run a mission in virtual time, and print a report.",
        epilog=STATUS_HELP,
    )
    add_mission_or_node(run)
    add_run_options(run)
    add_flight(run)
    run.add_argument(
        "--watch",
        action="store_const",
        dest="module",
        const="cfepy.cli.run.watch",
        help="run it again whenever a file changes that lies in its folder or that it opened, and show each result "
        "briefly; Ctrl-C ends",
    )
    run.set_defaults(module="cfepy.cli.run.run")


def _add_check(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    check = commands.add_parser(
        "check",
        help="find mistakes in a mission before it boots",
        examples=("cfepy check my_mission", "cfepy check robot.launch --board rx64m --json -"),
        description="Check a mission, a launch file or a node, and all files that it consists of. Nothing is executed.",
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
    add_json(check, "the mistakes and notes")
    add_ci_outputs(shared_group(check, "continuous integration"))
    check.set_defaults(module="cfepy.cli.run.check")


def _add_new(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    new = commands.add_parser(
        "new",
        help="write a new application, mission, fault plan or schema",
        description="Write the skeleton of an application or a mission, which runs unchanged, a random fault plan, or "
        "JSON schemas for an editor.",
        examples=("cfepy new app thermal", "cfepy new faults capture --seed 3"),
    )
    kinds = new.add_subparsers(metavar="KIND", dest="kind", required=True)
    app = kinds.add_parser(
        "app",
        help="an application in Python or C, and a mission around it",
        description="Write an application and the smallest mission around it, with a test.",
        examples=("cfepy new app thermal", "cfepy new app thermal --c"),
    )
    app.add_argument("--c", action="store_true", help="an application in C, which `cfepy build` compiles")
    mission = kinds.add_parser(
        "mission",
        help="a mission of an application and two ROS nodes, or one from your own cFS tree",
        description="Write a mission of an application and two ROS nodes, with a test. With --from, build a mission "
        "folder from a cFS mission tree or from an application in C, check it, and fly it for 10 virtual seconds. It "
        "ends with the flight, or with a list of at most ten things to do.",
        examples=("cfepy new mission rover", "cfepy new mission --from cFS"),
        epilog="exit status: 0 written, and with --from flown; with --from, cfepy run's status if the flight had a "
        "problem, and 1 if nothing could be built; 2 bad usage",
    )
    mission.set_defaults(c=False, option_hints={"--c": "; only applications can be in C: cfepy new app NAME --c"})
    text = "a cFS mission tree, or the folder of an application in C; NAME may be left out"
    mission.add_argument("--from", dest="source", metavar="TREE|FOLDER", help=text)
    add_cfe(mission)
    app.add_argument("name", metavar="NAME", help="also the name of the new folder")
    mission.add_argument("name", metavar="NAME", nargs="?", help="also the name of the new folder")
    for kind in (app, mission):
        kind.set_defaults(module="cfepy.cli.run.new")
    _add_new_faults(kinds)
    _add_new_schema(kinds)


def _add_new_schema(kinds: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    schema = kinds.add_parser(
        "schema",
        help="JSON schemas, with which an editor completes mission files",
        description="Write the JSON schemas of mission files, board profiles and fault plans, and print the line that "
        "lets an editor complete such a file and mark its mistakes.",
        examples=("cfepy new schema", "cfepy new schema rover/schemas"),
        epilog="exit status: 0 well, 2 a file cannot be written",
    )
    schema.add_argument("folder", nargs="?", default="schemas", metavar="FOLDER", help="the folder (default: schemas)")
    schema.set_defaults(module="cfepy.cli.run.new_schema")


def _add_new_faults(kinds: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    faults = kinds.add_parser(
        "faults",
        help="a random fault plan, or a list of possible faults",
        description="Run a mission quietly for 3 virtual seconds, and list the faults that it can have. With --seed, "
        "print a plan of random faults as YAML, for `cfepy run --faults FILE`.",
        examples=("cfepy new faults capture", "cfepy new faults capture --seed 3 --intensity low > faults.yaml"),
        epilog="exit status: 0 well, 2 bad usage, or a mission that cannot boot",
    )
    add_mission(faults)
    RUN_OPTIONS["launch_args"](faults)
    faults.add_argument(
        "--seed",
        type=whole_number_of,
        metavar="N",
        help="print the plan of this seed; `--faults seed:N` has the same faults",
    )
    faults.add_argument(
        "--intensity", choices=INTENSITIES, default="medium", help="how many faults the plan has (default: medium)"
    )
    faults.set_defaults(module="cfepy.cli.run.new_faults")

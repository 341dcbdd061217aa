"""The options of the command procedures, which flies test procedures of COSMOS."""

from __future__ import annotations

import argparse

from cfepy.cli.options import add_ci_outputs, add_json, add_mission, add_run_options, seconds_of
from cfepy.cli.parser import shared_group


def add(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add this command to the parser of `cfepy`."""
    parser = commands.add_parser(
        "procedures",
        help="fly test procedures in Python, written for OpenC3 COSMOS",
        examples=(
            "cfepy procedures suites lab",
            "cfepy procedures suites lab --requirements ids.yaml --html matrix.html",
            "cfepy procedures noop.py lab --explore 20",
        ),
        description="Fly the suites of a folder, or one script, against a mission in virtual time.",
        epilog="exit status: 0 all passed, 1 a test failed or is racy, 2 bad usage",
    )
    parser.add_argument("procedures", metavar="SUITE|SCRIPT", help="a file of procedures, or a folder with suites")
    add_mission(parser)
    add_run_options(parser, without=["seconds", "script", "stop_on_failure"])
    _add_inputs(parser.add_argument_group("procedures"))
    outputs = parser.add_argument_group("results")
    add_json(outputs, "the results")
    outputs.add_argument("--csv", metavar="FILE|-", help="write the requirement matrix as CSV")
    outputs.add_argument("--html", metavar="FILE", help="write the requirement matrix and the tests as a page")
    outputs.add_argument("--baseline", metavar="FILE", help="report changes since the campaign of an earlier --json")
    outputs.add_argument("--journals", metavar="DIR", help="keep a journal of each suite with a failed test")
    outputs.add_argument("--show-output", action="store_true", help="print the output of passed tests, too")
    add_ci_outputs(shared_group(parser, "continuous integration"))
    parser.set_defaults(module="cfepy.extra.procedures.procedures_command")


def _delay_of(text: str) -> float:
    return 0.0 if text == "0" else seconds_of(text)


def _add_inputs(group: argparse._ArgumentGroup) -> None:
    group.add_argument("--target", metavar="NAME", default="", help="name of the target (default: its folder's)")
    group.add_argument(
        "--variable",
        dest="variables",
        metavar="NAME=X",
        action="append",
        default=[],
        help="set a variable of ERB, such as '$size=64'",
    )
    group.add_argument(
        "--definitions", metavar="DIR", action="append", default=[], help="read cmd_tlm of this target's folder, too"
    )
    group.add_argument("--answers", metavar="FILE", help="answers to ask() and prompt(), in YAML")
    group.add_argument("--requirements", metavar="FILE", help="ids and texts of requirements, in YAML")
    group.add_argument("--test", dest="tests", metavar="TEXT", action="append", default=[], help="only these tests")
    group.add_argument(
        "--line-delay",
        type=_delay_of,
        default=0.1,
        metavar="S",
        help="pause before each line (default: 0.1 s, as in COSMOS)",
    )
    group.add_argument(
        "--ground-seed",
        type=int,
        default=0,
        metavar="N",
        help="seed of a start up to 20 s later and longer pauses",
    )
    group.add_argument("--explore", type=int, metavar="N", help="fly under N schedules, and report racy tests")
    group.add_argument("--bus", action="store_true", help="command and hear the bus itself, not CI_LAB and TO_LAB")
    group.add_argument(
        "--computer",
        metavar="HOST",
        help="test a computer in real time, HOST[:PORT[:PORT]]",
    )

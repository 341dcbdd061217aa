"""`cfepy busiest MISSION`: fly a mission, and rank its traffic."""

from __future__ import annotations

import argparse

import cfepy
from cfepy_busiest.ranking import busiest


def add(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command to the parser of `cfepy`."""
    command = commands.add_parser("busiest", help="fly a mission, and rank its traffic")
    command.add_argument("mission", metavar="MISSION", help="a folder, a launch file, or a mission that cfepy has")
    command.add_argument("--top", type=int, default=5, metavar="N", help="how many (default: 5)")
    command.set_defaults(module=__name__)


def run(arguments: argparse.Namespace) -> int:
    """Carry out the command; return its exit status."""
    results = cfepy.run(arguments.mission).results
    for place, topic in enumerate(busiest(results, arguments.top), 1):
        print(f"{place}. {topic.name}: {topic.sent} in {results.virtual_s:g} s")
    return 1 if results.problems else 0

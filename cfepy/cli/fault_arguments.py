"""What the command line understands of faults: the command `faults`. Imports only argparse."""

from __future__ import annotations

import argparse

from cfepy.cli.arguments import add_mission

INTENSITIES = ("low", "medium", "high")


def add(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add this command to the parser of `cfepy`."""
    faults = commands.add_parser(
        "faults",
        help="write a random fault plan for a mission, or list what faults can strike in it",
        description="Fly a mission quietly for 3 virtual seconds, and list what faults can strike in it; with --seed, "
        "print a plan of random faults, for `cfepy run --faults FILE`.",
        epilog="exit status: 0 well, 2 bad usage, or a mission that cannot boot",
    )
    add_mission(faults)
    faults.add_argument("--seed", type=int, metavar="N", help="print the plan that --faults seed:N makes, as YAML")
    faults.add_argument(
        "--intensity", choices=INTENSITIES, default="medium", help="how much goes wrong in it (default: medium)"
    )
    faults.set_defaults(module="faults")

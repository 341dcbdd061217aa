"""The options of the commands explore and sweep, which find out how a mission can fail.

A command belongs here when it flies a mission many times to find failures.
"""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from cfepy.cli.csv_cells import add_quote_formulas
from cfepy.cli.options import (
    add_ci_outputs,
    add_json,
    add_mission_or_node,
    add_run_options,
    seconds_of,
)
from cfepy.cli.parser import shared_group
from cfepy.status import UsageError

if TYPE_CHECKING:
    from cfepy.mission import ParameterDistribution

DEFAULT_SEEDS = 100
MOST_SEEDS = 100_000_000
STATUS_HELP = "exit status: 0 no failure, 1 a failure, 2 bad usage, 130 ended by Ctrl-C"
AUTO = "auto"
POLICIES = ("all", "random", "pct", "abreast", "dfs", "orders")
EVENTS = ("error", "critical", "none")


def add(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add these commands to the parser of `cfepy`."""
    _add_explore(commands)
    _add_sweep(commands)


def _add_explore(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    explore = commands.add_parser(
        "explore",
        help="run a mission under many schedules, to find races",
        description="Run a mission under many orders of its tasks, and report each failure once.",
        examples=("cfepy explore capture --for 3 --seeds 200", "cfepy explore my_mission --budget 60 --results r.json"),
        epilog=STATUS_HELP,
    )
    add_mission_or_node(explore, nargs="?")
    add_run_options(explore, without=["schedule"])  # explore chooses the schedule
    _add_search(explore)
    _add_failures(explore)
    _add_crew(explore)
    _add_outputs(explore)
    explore.set_defaults(module=f"{__name__}.explore")


def _add_search(explore: argparse.ArgumentParser) -> None:
    """Add the options that choose the schedules."""
    explore.add_argument(
        "--seeds",
        type=_count_or_auto,
        metavar="N|auto",
        help=f"number of schedules (default: {DEFAULT_SEEDS})",
    )
    explore.add_argument("--budget", type=seconds_of, metavar="SECONDS", help="start no schedule after this wall time")
    explore.add_argument(
        "--policy",
        choices=POLICIES,
        default="all",
        metavar="KIND",
        help="all (default), random, pct, abreast, dfs, orders",
    )
    explore.add_argument(
        "--depth", type=_count_of, metavar="N", help="bound of pct, dfs or orders (default: 3, 2, none)"
    )
    explore.add_argument(
        "--first-seed", type=_number_of, default=0, metavar="N", help="seed of the first schedule (default: 0)"
    )
    explore.add_argument("--any-priority", action="store_true", help="ignore priorities, as on several cores")
    explore.add_argument("--hold", type=seconds_of, metavar="TIME", help="delay a task by up to this, such as 500us")
    explore.add_argument(
        "--connect", type=seconds_of, metavar="TIME", help="delay a connection by up to this, such as 50ms"
    )
    explore.add_argument(
        "--points",
        default="",
        metavar="KIND",
        help="preempt at lines, attributes or calls, or shared:NAME",
    )
    explore.add_argument(
        "--from",
        nargs="?",
        type=seconds_of,
        const=0.0,
        metavar="SECONDS",
        help="vary the order from here on (default: OPERATIONAL)",
    )
    explore.add_argument("--fair", type=_count_of, metavar="N", help="pass over a ready task in at most N decisions")
    explore.add_argument("--worst", metavar="MEASURE", help="find the longest latency:/TOPIC, response:APP, wait:TASK")
    explore.add_argument("--until-failure", action="store_true", help="stop at the first failure")


def _add_failures(explore: argparse.ArgumentParser) -> None:
    """Add the options that define a failure."""
    failures = shared_group(explore, "failures")
    failures.add_argument(
        "--events",
        choices=EVENTS,
        default="error",
        metavar="TYPE",
        help="failing events: error (and above), critical, none",
    )
    failures.add_argument(
        "--starved", type=seconds_of, metavar="TIME", help="fail if a ready task does not run for so long"
    )
    failures.add_argument(
        "--livelock", type=seconds_of, metavar="TIME", help="fail if an app runs so long without a message"
    )
    failures.add_argument("--no-stuck", action="store_true", help="do not fail if a task waits for ever")


def _add_crew(parser: argparse.ArgumentParser) -> None:
    """Add the options for the processes that fly runs, each one at a time."""
    crew = shared_group(parser, "processes")
    crew.add_argument("--jobs", type=_count_of, metavar="N", help="processes on this computer (default: one a CPU)")
    crew.add_argument("--cluster", metavar="ADDRESS", help="use a dask cluster: its scheduler, or local:N")
    crew.add_argument(
        "--longest",
        type=seconds_of,
        default=120.0,
        metavar="SECONDS",
        help="wall time limit of one run (default: 120)",
    )


def _add_outputs(explore: argparse.ArgumentParser) -> None:
    """Add the options for output files and displayed text."""
    explore.add_argument("--results", metavar="FILE", help="write all results, and continue from older ones")
    explore.add_argument("--replay-all", metavar="FILE", help="only repeat the failures in a results file")
    add_json(explore, "the findings")
    add_ci_outputs(shared_group(explore, "continuous integration"))
    explore.add_argument(
        "--shrink", type=_number_of, metavar="N", help="most runs to shrink a failure (default: 300 to 800)"
    )
    explore.add_argument(
        "--shrink-time", type=seconds_of, default=60.0, metavar="S", help="most wall time to shrink one (default: 60)"
    )
    explore.add_argument(
        "--quiet", action="store_true", help="print only the failures, the summary and the notes that make it doubtful"
    )


def _add_sweep(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    sweep = commands.add_parser(
        "sweep",
        help="find the highest rate without losses, on many boards",
        description="Run a mission at every combination of boards, rates, values and seeds, or with drawn values. "
        "VALUES are values and ranges with commas between: 10..1000 are the preferred numbers from 10 to 1000, ten a "
        "decade; 10..50:10 are 10, 20, 30, 40 and 50.",
        examples=(
            "cfepy sweep capture --rate 10..1000 --board rx64m",
            "cfepy sweep capture --draws 200 --draw /arm/rate=normal:1000,20 --csv sweep.csv",
        ),
        epilog="exit status: 0 well, whatever was found; 1 an error in cfepy itself; 2 bad usage, or a mission that "
        "cannot be read; 130 ended by Ctrl-C, after a report",
    )
    add_mission_or_node(sweep)
    sweep.add_argument("-r", "--rate", metavar="HZ", help="VALUES in Hz, applied by `sweep:` of the mission file")
    sweep.add_argument(
        "--board",
        dest="boards",
        action="append",
        default=[],
        metavar="NAME|FILE",
        help="boards, with commas between (default: the mission's)",
    )
    sweep.add_argument(
        "--seed", dest="seeds", metavar="N", help="seeds; VALUES (default: 0; of a drawn run its number)"
    )
    sweep.add_argument(
        "--set",
        dest="varied",
        action="append",
        type=_varied_of,
        default=[],
        metavar="/PARAM=VALUE",
        help="VALUES of a ROS parameter (/arm/rate=20,50) or of a launch argument (rate=20,50)",
    )
    sweep.add_argument(
        "--draw",
        dest="drawn",
        action="append",
        type=_drawn_of,
        default=[],
        metavar="/PARAM=KIND",
        help="draw it in each run: normal:10,0.5 or uniform:1,2 or integers:1..6 or choice:a,b (the guide has all)",
    )
    sweep.add_argument("--draws", type=_count_of, metavar="N", help="number of drawn runs (default: 100)")
    sweep.add_argument("--draw-seed", type=_number_of, metavar="N", help="seed of the drawn values (default: 0)")
    sweep.add_argument(
        "--measure",
        action="append",
        default=[],
        metavar="TOPIC",
        help="a topic (default: as in the mission file), or a field: last, min, max or mean:/odom.twist.linear.x",
    )
    add_run_options(sweep, without=["board", "seed", "settings"])
    _add_crew(sweep)
    sweep.add_argument("--csv", metavar="FILE|-", help="write a row for each topic of each run")
    add_quote_formulas(sweep)
    sweep.add_argument("--picture", metavar="FILE", help="draw a picture: .png, .svg or .pdf")
    add_json(sweep, "the findings")
    sweep.add_argument("--quiet", action="store_true", help="show no progress")
    sweep.set_defaults(module=f"{__name__}.sweep")


def _varied_of(text: str) -> tuple[str, str]:
    name, mark, values = text.partition("=")
    if not mark or not name or not values:
        raise argparse.ArgumentTypeError(
            f"invalid parameter setting {text!r}; expected /NAME=VALUES, such as /arm/rate=20,50"
        )
    return name, values


def _drawn_of(text: str) -> tuple[str, ParameterDistribution]:
    from cfepy.mission import ParameterDistribution

    name, mark, distribution = text.partition("=")
    if not mark or not name or not distribution:
        raise argparse.ArgumentTypeError(
            f"invalid drawn parameter {text!r}; expected /NAME=KIND:NUMBERS, such as /arm/rate=normal:1000,20"
        )
    try:
        return name, ParameterDistribution.parse(distribution)
    except UsageError as error:
        raise argparse.ArgumentTypeError(f"{name}: {error.text}") from None


def _count_or_auto(text: str) -> int | str:
    return text if text == AUTO else _count_of(text)


def _count_of(text: str) -> int:
    return _whole(text, 1)


def _number_of(text: str) -> int:
    return _whole(text, 0)


def _whole(text: str, least: int) -> int:
    if not text.isdecimal() or not least <= int(text) <= MOST_SEEDS:
        raise argparse.ArgumentTypeError(
            f"invalid number {text!r}; expected a whole number from {least} to {MOST_SEEDS}"
        )
    return int(text)

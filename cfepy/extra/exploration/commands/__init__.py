"""The options of the commands explore, faults and sweep, which find out how a mission can fail.

A command belongs here when it flies a mission many times, or makes faults happen in it, to find failures.
"""

from __future__ import annotations

import argparse

from cfepy.cli.csv_cells import add_quote_formulas
from cfepy.cli.options import (
    POINTS_HELP,
    RUN_OPTIONS,
    add_json,
    add_mission,
    add_mission_or_node,
    add_run_options,
    seconds_of,
)

INTENSITIES = ("low", "medium", "high")
DEFAULT_SEEDS = 100
MOST_SEEDS = 100_000_000
STATUS_HELP = """exit status:
  0    no schedule made the mission fail
  1    a failure was found (with --replay-all: is still there), or an error in cfepy itself
  2    bad usage, or a mission that cannot be read
  130  ended by Ctrl-C (what was found is reported)"""


def add(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add these commands to the parser of `cfepy`."""
    _add_explore(commands)
    _add_faults(commands)
    _add_sweep(commands)


def _add_explore(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    explore = commands.add_parser(
        "explore",
        help="run a mission under many schedules, in order to find what fails only now and then",
        description="Run a mission under many schedules, which differ in who goes first at each call. Report each "
        "failure once, with the command that replays it and the fewest preemptions that still fail.",
        epilog=STATUS_HELP,
    )
    add_mission_or_node(explore, nargs="?")
    add_run_options(explore, without=["schedule"])  # explore chooses the schedule
    _add_search(explore)
    _add_failures(explore)
    _add_crew(explore, "schedule")
    _add_outputs(explore)
    explore.set_defaults(module=f"{__name__}.explore")


def _add_search(explore: argparse.ArgumentParser) -> None:
    """Add the options that choose the schedules."""
    explore.add_argument(
        "--seeds",
        type=_count_of,
        metavar="N",
        help=f"how many schedules to run (default: {DEFAULT_SEEDS})",
    )
    explore.add_argument(
        "--budget",
        type=seconds_of,
        metavar="SECONDS",
        help="begin no further schedule after this wall time; without --seeds there may then be any number of them",
    )
    explore.add_argument(
        "--policy",
        choices=("all", "random", "pct", "abreast", "dfs", "orders"),
        default="all",
        help="where they come from: random, PCT, every one with few preemptions (dfs), every order of what depends on "
        "each other, once (orders), tasks side by side (abreast), or random, PCT of depths 1 to 3 and abreast by turns "
        "(all, the default)",
    )
    explore.add_argument(
        "--depth",
        type=_count_of,
        metavar="N",
        help="of the bugs that pct looks for; most preemptions of dfs; how many steps orders may differ in (default: "
        "3, 2, all)",
    )
    explore.add_argument(
        "--first-seed", type=_number_of, default=0, metavar="N", help="seed of the first schedule (default: 0)"
    )
    explore.add_argument(
        "--any-priority", action="store_true", help="less urgent tasks may run before more urgent ones"
    )
    explore.add_argument(
        "--hold",
        type=seconds_of,
        metavar="SECONDS",
        help="the running task may be held up until the next timer is due, if that is within a time such as 500us",
    )
    explore.add_argument(
        "--connect",
        type=seconds_of,
        metavar="SECONDS",
        help="a connection between two ROS nodes may take any time up to this, such as 50ms",
    )
    explore.add_argument(
        "--points",
        default="",
        metavar="KIND[:MODULE,...]",
        help=f"others may get in at more points of the mission's Python code than at its calls: {POINTS_HELP}",
    )
    explore.add_argument(
        "--from",
        nargs="?",
        type=seconds_of,
        const=0.0,
        metavar="SECONDS",
        help="begin at this virtual time, such as 600ms, or, without one, when the mission is OPERATIONAL; what comes "
        "before is fifo's",
    )
    explore.add_argument(
        "--fair",
        type=_count_of,
        metavar="N",
        help="a task that could run is passed over in at most so many decisions",
    )
    explore.add_argument(
        "--worst",
        metavar="MEASURE",
        help="look for the schedule under which something takes longest: latency:/topic, latency:/cause->/effect, "
        "response:APP, age:/topic or wait:TASK",
    )
    explore.add_argument("--until-failure", action="store_true", help="stop with the first failure")


def _add_failures(explore: argparse.ArgumentParser) -> None:
    """Add the options that define a failure."""
    explore.add_argument(
        "--events",
        choices=("error", "critical", "none"),
        default="error",
        help="events of the mission's applications that are failures: ERROR and CRITICAL (default), CRITICAL, or none",
    )
    explore.add_argument(
        "--starved",
        type=seconds_of,
        metavar="SECONDS",
        help="a task that is ready for longer than this virtual time and does not run is a failure",
    )
    explore.add_argument(
        "--livelock",
        type=seconds_of,
        metavar="SECONDS",
        help="an application whose tasks run on for longer than this virtual time, and neither send nor take a "
        "message, is a failure",
    )
    explore.add_argument(
        "--no-stuck", action="store_true", help="a task that waits for ever, and does not by default, is no failure"
    )


def _add_crew(explore: argparse.ArgumentParser, what: str) -> None:
    """Add the options for the processes that run them, each one at a time."""
    explore.add_argument(
        "--jobs", type=_count_of, metavar="N", help="processes on this computer (default: one on each CPU)"
    )
    explore.add_argument(
        "--cluster", metavar="ADDRESS", help="run on a dask cluster: its scheduler's address, or local:N"
    )
    explore.add_argument(
        "--longest",
        type=seconds_of,
        default=120.0,
        metavar="SECONDS",
        help=f"wall time that one {what} may take (default: 120)",
    )


def _add_outputs(explore: argparse.ArgumentParser) -> None:
    """Add the options for output files and displayed text."""
    explore.add_argument(
        "--results",
        metavar="FILE",
        help="write the result of every schedule to a file; the same command goes on from there",
    )
    explore.add_argument(
        "--replay-all",
        metavar="RESULTS",
        help="search nothing: fly each failure of a results file again, in the mission as it now is, and tell which "
        "are gone; MISSION may be left out",
    )
    add_json(explore, "what was found")
    explore.add_argument(
        "--shrink",
        type=_number_of,
        metavar="N",
        help="how many runs shrinking a failure may take; 0 leaves it as it is (default: as many as there "
        "were schedules, 300 to 800)",
    )
    explore.add_argument("--quiet", action="store_true", help="show no progress")


def _add_faults(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    faults = commands.add_parser(
        "faults",
        help="write a random fault plan for a mission, or list what faults can strike in it",
        description="Fly a mission quietly for 3 virtual seconds, and list what faults can strike in it; with --seed, "
        "print a plan of random faults, for `cfepy run --faults FILE`.",
        epilog="exit status: 0 well, 2 bad usage, or a mission that cannot boot",
    )
    add_mission(faults)
    RUN_OPTIONS["launch_args"](faults)
    faults.add_argument(
        "--seed",
        type=int,
        metavar="N",
        help="of everything random in the plan that is printed, as YAML: that of --faults seed:N",
    )
    faults.add_argument(
        "--intensity", choices=INTENSITIES, default="medium", help="how much goes wrong in it (default: medium)"
    )
    faults.set_defaults(module=f"{__name__}.faults")


def _add_sweep(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    sweep = commands.add_parser(
        "sweep",
        help="fly a mission at many rates, on many boards, and tell up to where it is carried",
        description="Fly a mission at every combination of boards, rates, values and seeds. VALUES are values and "
        "ranges with commas between: 10..1000 are the preferred numbers from 10 to 1000, ten to the decade, 10..50:10 "
        "are 10, 20, 30, 40 and 50.",
        epilog="exit status: 0 well, whatever was found, 1 an error in cfepy itself, 2 bad usage, or a mission that "
        "cannot be read, 130 ended by Ctrl-C (what was flown is told)",
    )
    add_mission_or_node(sweep)
    sweep.add_argument(
        "-r", "--rate", metavar="HZ", help="how often: VALUES in Hz; what they set, the mission file says (`sweep:`)"
    )
    sweep.add_argument(
        "--board",
        dest="boards",
        action="append",
        default=[],
        metavar="NAME|FILE",
        help="run on this board instead of the mission's own; several with commas, or the option several times",
    )
    sweep.add_argument(
        "--seed",
        dest="seeds",
        default="0",
        metavar="N",
        help="of everything random in it; VALUES (default: 0)",
    )
    sweep.add_argument(
        "--set",
        dest="varied",
        action="append",
        type=_varied_of,
        default=[],
        metavar="/PARAM=VALUE",
        help="VALUES of a ROS parameter (/arm/rate=20,50) or of an argument of the launch file (rate=20,50)",
    )
    sweep.add_argument(
        "--measure",
        action="append",
        default=[],
        metavar="TOPIC",
        help="measure this (default: as the mission says)",
    )
    add_run_options(sweep, without=["board", "seed", "settings"])
    _add_crew(sweep, "run")
    sweep.add_argument("--csv", metavar="FILE|-", help="write a row for each topic of each run")
    add_quote_formulas(sweep)
    sweep.add_argument("--picture", metavar="FILE", help="draw a picture: .png, .svg or .pdf")
    add_json(sweep, "what was found")
    sweep.add_argument("--quiet", action="store_true", help="show no progress")
    sweep.set_defaults(module=f"{__name__}.sweep")


def _varied_of(text: str) -> tuple[str, str]:
    name, mark, values = text.partition("=")
    if not mark or not name or not values:
        raise argparse.ArgumentTypeError(
            f"invalid parameter setting {text!r}; expected /NAME=VALUES, such as /arm/rate=20,50"
        )
    return name, values


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

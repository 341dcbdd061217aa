"""What the command line understands of exploring schedules: explore. Imports only argparse."""

from __future__ import annotations

import argparse

from cfepy.cli.arguments import add_end, add_launch_arguments, seconds_of

DEFAULT_SEEDS = 100
MOST_SEEDS = 100_000_000
MOST_PROBES = 800
MISSION_HELP = (
    "a startup script, a folder with a startup.scr, a shipped mission's name, a launch file, or a node's .py with its "
    "arguments"
)
STATUS_HELP = """exit status:
  0    no schedule made the mission fail
  1    a failure was found, or an error in cfepy itself
  2    bad usage, or a mission that cannot be read
  130  ended by Ctrl-C (what was found is reported)"""


def add(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add this command to the parser of `cfepy`."""
    explore = commands.add_parser(
        "explore",
        help="run a mission under many schedules, in order to find what fails only now and then",
        description="Run a mission under many schedules, which differ in who goes first at each call. Report each "
        "failure once, with the command that replays it and the fewest preemptions that still fail.",
        epilog=STATUS_HELP,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    explore.add_argument("words", metavar="MISSION", nargs="+", help=MISSION_HELP)
    add_launch_arguments(explore)
    _add_search(explore)
    _add_run(explore)
    _add_crew(explore)
    _add_outputs(explore)
    explore.set_defaults(module="explore", hint="; what a node itself is to get comes after --")


def _add_search(explore: argparse.ArgumentParser) -> None:
    """Which schedules."""
    explore.add_argument(
        "--seeds",
        type=_count_of,
        default=DEFAULT_SEEDS,
        metavar="N",
        help=f"how many schedules to run (default: {DEFAULT_SEEDS})",
    )
    explore.add_argument(
        "--policy",
        choices=("all", "random", "pct", "dfs"),
        default="all",
        help="where they come from: random, PCT, every one with few preemptions (dfs), or random and PCT of depths 1 "
        "to 3 by turns (all, the default)",
    )
    explore.add_argument(
        "--depth",
        type=_count_of,
        metavar="D",
        help="of the bugs that pct looks for; most preemptions of dfs (default: 3 for pct, 2 for dfs)",
    )
    explore.add_argument(
        "--first-seed", type=_number_of, default=0, metavar="N", help="seed of the first schedule (default: 0)"
    )
    explore.add_argument(
        "--any-priority", action="store_true", help="less urgent tasks may run before more urgent ones"
    )
    explore.add_argument(
        "--hold",
        metavar="TIME",
        help="the running task may be held up until the next timer is due, if that is within a time such as 500us",
    )
    explore.add_argument(
        "--from", metavar="TIME", help="explore from this virtual time on, such as 600ms; what comes before is fifo's"
    )
    explore.add_argument("--until-failure", action="store_true", help="stop with the first failure")


def _add_run(explore: argparse.ArgumentParser) -> None:
    """What each run is like."""
    add_end(explore)
    explore.add_argument("--script", metavar="FILE", help="a mission script; a step that fails is a failure")
    explore.add_argument("--faults", metavar="FILE|seed:N", help="let faults happen in each run; see cfepy faults")
    explore.add_argument("--seed", type=int, default=0, metavar="N", help="of everything random in the mission")
    explore.add_argument("--board", metavar="NAME|FILE", help="run on this board instead of the mission's own")
    explore.add_argument(
        "--tasks", choices=("thread", "greenlet"), default="thread", help="what tasks run on (default: thread)"
    )
    explore.add_argument(
        "--events",
        choices=("error", "critical", "none"),
        default="error",
        help="events of the mission's applications that are failures: ERROR and CRITICAL (default), CRITICAL, or none",
    )
    explore.add_argument(
        "--no-stuck", action="store_true", help="a task that waits for ever, and does not by default, is no failure"
    )


def _add_crew(explore: argparse.ArgumentParser) -> None:
    """Who runs them."""
    explore.add_argument(
        "--jobs", type=_count_of, metavar="J", help="processes on this computer (default: one on each CPU)"
    )
    explore.add_argument(
        "--cluster", metavar="ADDRESS", help="run on a dask cluster: its scheduler's address, or local:N"
    )
    explore.add_argument(
        "--longest",
        type=seconds_of,
        default=120.0,
        metavar="SECONDS",
        help="wall time that one schedule may take (default: 120)",
    )


def _add_outputs(explore: argparse.ArgumentParser) -> None:
    """What is left behind, and what is shown."""
    explore.add_argument(
        "--results", metavar="FILE", help="keep every verdict in a file; the same command goes on from there"
    )
    explore.add_argument("--json", metavar="FILE", help="write what was found to a file")
    explore.add_argument(
        "--shrink",
        type=_number_of,
        default=MOST_PROBES,
        metavar="RUNS",
        help=f"how many runs shrinking a failure may take; 0 leaves it as it is (default: {MOST_PROBES})",
    )
    explore.add_argument("--quiet", action="store_true", help="show no progress")


def _count_of(text: str) -> int:
    return _whole(text, 1)


def _number_of(text: str) -> int:
    return _whole(text, 0)


def _whole(text: str, least: int) -> int:
    if not text.isdecimal() or not least <= int(text) <= MOST_SEEDS:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number from {least} to {MOST_SEEDS}")
    return int(text)

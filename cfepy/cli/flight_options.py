"""Options of commands that fly a run in front of a person: its output files, and its ties to this computer.

`cfepy.cli.run.run` acts on them.
"""

from __future__ import annotations

import argparse

from cfepy.cli import flight_add_ons
from cfepy.cli.options import add_ci_outputs, add_json, factor_of
from cfepy.cli.parser import shared_group
from cfepy.status import UsageError

DEFAULT_RUNS, MOST_RUNS = 3, 64
HIGHEST_PORT = 65_535


def add_flight(parser: argparse.ArgumentParser) -> None:
    """Add all options that `fly_and_tell` reads."""
    add_pace(parser)
    flight_add_ons.add_options(parser)
    add_outputs(parser)
    add_ci_outputs(shared_group(parser, "continuous integration"))
    add_recording(parser)
    _add_check_determinism(parser)


def add_outputs(parser: argparse.ArgumentParser) -> None:
    """Add the options for the output of the run."""
    run = shared_group(parser, "output")
    add_json(run, "the report's numbers")
    run.add_argument(
        "--save-files",
        metavar="DIR",
        help="write the mission's files, such as /ram/x.log, to this folder at the end, as DIR/ram/x.log",
    )
    run.add_argument("--bag", metavar="FILE", help="record the ROS topics of the run into a bag (rosbag record -a)")
    run.add_argument(
        "--bag-topics",
        nargs="+",
        action="extend",
        default=[],
        metavar="TOPIC",
        help="record only these, such as /odom or '/arm/*' (default: all)",
    )
    run.add_argument("--trace", metavar="FILE", help="write all records of the run to a file, a line each")
    run.add_argument("--no-console", action="store_true", help="print only the report, no console and no status line")
    run.add_argument(
        "--quiet",
        action="store_true",
        help="print only the problems, the rules and moves that never applied, and the verdict",
    )


def add_recording(parser: argparse.ArgumentParser) -> None:
    """Add the options for the journal of the run."""
    run = shared_group(parser, "journal")
    run.add_argument("--record", metavar="FILE", help="write a journal, from which `cfepy replay FILE` repeats the run")
    run.add_argument(
        "--record-no-files",
        action="store_true",
        help="leave the mission's files out of the journal; it still has their checksums",
    )


def add_pace(parser: argparse.ArgumentParser) -> None:
    """Add the options for the pace of the run and for the ports that are open meanwhile."""
    pace = shared_group(parser, "real time")
    pace.add_argument(
        "--realtime",
        nargs="?",
        type=factor_of,
        const=1.0,
        metavar="FACTOR",
        help="pace virtual time to the wall clock, FACTOR times as fast (default: 1); the mission's UDP and TCP ports "
        "are then open on 127.0.0.1",
    )
    pace.add_argument(
        "--port",
        action="append",
        type=ports_of,
        default=[],
        metavar="PORT=HERE",
        help="open the mission's port PORT, or send to it, as port HERE of this computer; 0 takes any free one",
    )


def check_pace(arguments: argparse.Namespace) -> None:
    """Check the options of `add_pace` and of add-ons.

    Raises:
        UsageError: an option requires a run in real time, and this run is not.
    """
    if arguments.realtime is None and arguments.port:
        raise UsageError("requires --realtime; without it no port is opened on this computer", field="--port")
    flight_add_ons.check_options(arguments)


def _add_check_determinism(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--check-determinism",
        nargs="?",
        type=runs_of,
        const=DEFAULT_RUNS,
        metavar="N",
        help="run it N times side by side, under different hash seeds, on threads and on greenlets, and show the first "
        f"difference (default: {DEFAULT_RUNS} runs)",
    )


# -- types of arguments ------------------------------------------------------------------------------------------------


def ports_of(text: str) -> tuple[int, int]:
    """Parse a port of the mission and its port on this computer, for argparse."""
    inside, _, here = text.partition("=")
    if not (inside.isdecimal() and here.isdecimal() and 0 < int(inside) <= HIGHEST_PORT >= int(here)):
        raise argparse.ArgumentTypeError(
            f"invalid port mapping {text!r}; expected MISSION_PORT=HOST_PORT, such as 1234=5000 (0: any free port)"
        )
    return int(inside), int(here)


def runs_of(text: str) -> int:
    """Parse the number of runs to compare, for argparse."""
    if not text.isdecimal() or not 2 <= int(text) <= MOST_RUNS:
        raise argparse.ArgumentTypeError(f"invalid number of runs {text!r}; expected 2 to {MOST_RUNS}")
    return int(text)

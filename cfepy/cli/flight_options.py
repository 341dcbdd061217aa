"""Options of commands that fly a run in front of a person: what it leaves behind, and what it has to do with this
computer. `cfepy.cli.run.run` does what they say.
"""

from __future__ import annotations

import argparse

from cfepy.cli.options import add_json, factor_of
from cfepy.status import UsageError

DEFAULT_RUNS, MOST_RUNS = 3, 64
HIGHEST_PORT = 65_535


def add_flight(parser: argparse.ArgumentParser) -> None:
    """All of them, as `fly_and_tell` takes them."""
    add_pace(parser)
    add_viewers(parser)
    add_outputs(parser)
    add_recording(parser)
    _add_check_determinism(parser)


def add_outputs(parser: argparse.ArgumentParser) -> None:
    """What the run leaves behind, and what it shows."""
    run = parser.add_argument_group("what the run leaves behind")
    add_json(run, "the report's numbers")
    run.add_argument(
        "--save-files",
        metavar="DIR",
        help="at the end write the files that the mission wrote, such as /ram/x.log, to this folder, as DIR/ram/x.log",
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
    run.add_argument("--trace", metavar="FILE", help="write everything that happened to a file, a line each")
    run.add_argument("--quiet", action="store_true", help="no console and no status line, only the report")


def add_recording(parser: argparse.ArgumentParser) -> None:
    """The journal of the run."""
    run = parser.add_argument_group("the journal of the run")
    run.add_argument(
        "--record", metavar="FILE", help="write a journal, from which `cfepy replay FILE` does the same run again"
    )
    run.add_argument(
        "--record-no-files",
        action="store_true",
        help="leave the mission's files out of the journal; it still has their checksums",
    )


def add_pace(parser: argparse.ArgumentParser) -> None:
    """The wall clock, and the ports that are open meanwhile."""
    pace = parser.add_argument_group("the wall clock and this computer")
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
    pace.add_argument(
        "--ros-master",
        type=ros_master_of,
        metavar="URI",
        help="with --realtime: be one graph with ROS on this computer. URI is that of a running roscore, such as "
        "http://localhost:11311; serve or serve:PORT serves a ROS master for others",
    )


def check_pace(arguments: argparse.Namespace) -> None:
    """Check what `add_pace` has added.

    Raises:
        UsageError: something in it is for a run in real time, and this one is none.
    """
    if arguments.realtime is not None:
        return
    if arguments.port:
        raise UsageError("without --realtime no port is opened on this computer", field="--port")
    if arguments.ros_master:
        raise UsageError("without --realtime no ROS node of this computer can keep pace; add it", field="--ros-master")


def add_viewers(parser: argparse.ArgumentParser) -> None:
    """Programs that look at the run while it goes on."""
    viewers = parser.add_argument_group("programs that look at the run while it goes on")
    viewers.add_argument(
        "--foxglove",
        metavar="[HOST:]PORT",
        help="serve Foxglove: topics, telemetry, events, parameters and services, both ways; on 127.0.0.1, if no host "
        "is given, and with --realtime at the pace of the wall clock",
    )
    viewers.add_argument(
        "--rosbridge",
        metavar="[HOST:]PORT",
        help="serve clients of rosbridge, such as roslibjs and roslibpy: topics, services and parameters, both ways",
    )
    viewers.add_argument(
        "--viewer-origin",
        action="append",
        default=[],
        metavar="ORIGIN",
        help="let pages of a web site connect from a browser without a token, such as https://example.org; those of "
        "this computer may in any case",
    )
    viewers.add_argument(
        "--viewer-token",
        metavar="TOKEN",
        help="what such a program must know to connect (default: that of the variable CFEPY_VIEWER_TOKEN; from "
        "other computers always one, which is made and shown if nobody gives one)",
    )


def _add_check_determinism(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--check-determinism",
        nargs="?",
        type=runs_of,
        const=DEFAULT_RUNS,
        metavar="N",
        help="run it N times side by side, each time under another hash seed and both on threads and on greenlets, "
        f"and show the first thing that differs (default: {DEFAULT_RUNS} runs)",
    )


# -- types of arguments ------------------------------------------------------------------------------------------------


def ros_master_of(text: str) -> str:
    """The URI of a ROS master, or `serve` with or without a port, for argparse."""
    word, mark, port = text.partition(":")
    serves = word == "serve" and (not mark or (port.isdecimal() and int(port) <= HIGHEST_PORT))
    if serves or (word == "http" and text.count(":") > 1 and text.rstrip("/").rpartition(":")[2].isdecimal()):
        return text
    raise argparse.ArgumentTypeError(f"{text!r} is not like http://localhost:11311, serve or serve:11312")


def ports_of(text: str) -> tuple[int, int]:
    """A port of the mission and what it is on this computer, for argparse."""
    inside, _, here = text.partition("=")
    if not (inside.isdecimal() and here.isdecimal() and 0 < int(inside) <= HIGHEST_PORT >= int(here)):
        raise argparse.ArgumentTypeError(f"{text!r} is not like 1234=0 or 1234=5000")
    return int(inside), int(here)


def runs_of(text: str) -> int:
    """How many runs to compare, for argparse."""
    if not text.isdecimal() or not 2 <= int(text) <= MOST_RUNS:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of runs; give 2 to {MOST_RUNS}")
    return int(text)

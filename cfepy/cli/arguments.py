"""What the command line understands of missions: run, check, mids, new, boards. Imports only argparse."""

from __future__ import annotations

import argparse

LONGEST_S = 1e9  # virtual time is a signed 64-bit number of ns
SLOWEST, FASTEST = 1e-3, 1e9  # times real time

HIGHEST_PORT = 65_535
DEFAULT_RUNS, MOST_RUNS = 3, 64

MISSION_HELP = "a startup script, a folder with a startup.scr, a shipped mission's name, or a launch file"
STATUS_HELP = """exit status:
  0    the run ended well
  1    an application died or could not be started, a mission's own application sent an ERROR or CRITICAL event,
       or a failure reset the processor; with --script, a step of the script failed and nothing else counts;
       with --check-determinism, two runs differed, and nothing else counts
  2    bad usage, or a mission that cannot boot
  130  ended by Ctrl-C or SIGTERM (the report is still printed)"""


def add(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add these commands to the parser of `cfepy`."""
    _add_run(commands)
    _add_check(commands)
    _add_mids(commands)
    _add_new(commands)
    boards = commands.add_parser("boards", help="list the boards and their main numbers")
    boards.set_defaults(module="boards")


def _add_run(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    run = commands.add_parser(
        "run",
        help="run a mission",
        description="Run a mission in virtual time, and report what happened.",
        epilog=STATUS_HELP,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add_mission(run)
    add_end(run)
    add_machine(run)
    _add_outside(run)
    add_outputs(run)
    _add_comparison(run)
    run.set_defaults(module="run")


def add_mission(parser: argparse.ArgumentParser) -> None:
    """The mission that it is about, and what a launch file that is one gets."""
    parser.add_argument("mission", metavar="MISSION", help=MISSION_HELP)
    add_launch_arguments(parser)


def add_launch_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of a launch file that is given as a mission."""
    parser.add_argument(
        "--arg",
        dest="launch_args",
        action="append",
        type=launch_argument_of,
        default=[],
        metavar="NAME:=VALUE",
        help="an argument of the launch file, if it is one",
    )


def add_end(run: argparse.ArgumentParser) -> None:
    """How long the run is."""
    run.add_argument(
        "--for",
        dest="seconds",
        type=seconds_of,
        metavar="SECONDS",
        help="virtual seconds to run (default: 10, or as long as the script takes; until Ctrl-C with --realtime)",
    )


def add_machine(run: argparse.ArgumentParser) -> None:
    """What the run is on, and what decides in it."""
    run.add_argument("--seed", type=int, default=0, metavar="N", help="of everything random (default: 0)")
    run.add_argument("--board", metavar="NAME|FILE", help="run on this board instead of the mission's own")
    run.add_argument(
        "--tasks", choices=("thread", "greenlet"), default="thread", help="what tasks run on (default: thread)"
    )
    run.add_argument(
        "--faults",
        metavar="FILE|seed:N",
        help="let faults happen: those of a plan, or random ones (seed:N, or seed:N:low, :medium, :high); "
        "cfepy faults has more",
    )
    run.add_argument(
        "--schedule",
        default="fifo",
        metavar="TEXT",
        help="who runs next where there is a choice: fifo (default), random[:SEED], pct:SEED:DEPTH[:STEPS] or at:42=1 "
        "(at decision 42 candidate 1), these with :any (of any priority) or :hold=500us (tasks may be held up)",
    )


def _add_outside(run: argparse.ArgumentParser) -> None:
    """What the run has to do with the world outside: its clock, its ports, a script."""
    run.add_argument(
        "--realtime",
        nargs="?",
        type=factor_of,
        const=1.0,
        metavar="FACTOR",
        help="pace virtual time to the wall clock, FACTOR times as fast (default: 1); the mission's UDP and TCP ports "
        "are then open on 127.0.0.1",
    )
    run.add_argument(
        "--port",
        action="append",
        type=ports_of,
        default=[],
        metavar="PORT=HERE",
        help="open the mission's port PORT, or send to it, as port HERE of this computer; 0 takes any free one",
    )
    run.add_argument("--script", metavar="FILE", help="send commands and check what comes of them, as a script says")
    run.add_argument("--play", metavar="BAG", help="play a bag's topics into the mission, as rosbag play does")
    run.add_argument("--stop-on-failure", action="store_true", help="end the run with the script's first failed step")


def add_outputs(run: argparse.ArgumentParser) -> None:
    """What the run leaves behind, and what it shows."""
    run.add_argument("--json", metavar="FILE", help="write the report's numbers to a file")
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
    add_recording(run)
    run.add_argument("--quiet", action="store_true", help="no console and no status line, only the report")


def add_recording(run: argparse.ArgumentParser) -> None:
    """The journal of the run."""
    run.add_argument(
        "--record", metavar="FILE", help="write a journal, from which `cfepy replay FILE` does the same run again"
    )
    run.add_argument(
        "--record-no-files",
        action="store_true",
        help="leave the mission's files out of the journal; it still has their checksums",
    )


def _add_comparison(run: argparse.ArgumentParser) -> None:
    """Runs that are compared with each other."""
    run.add_argument(
        "--check-determinism",
        nargs="?",
        type=runs_of,
        const=DEFAULT_RUNS,
        metavar="N",
        help="run the mission N times side by side, each time under another hash seed and both on threads and on "
        f"greenlets, and show the first thing that differs (default: {DEFAULT_RUNS} runs)",
    )


def _add_check(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    check = commands.add_parser(
        "check",
        help="find everything that is wrong with a mission before it boots",
        description="Find what is wrong with a mission; none of its code is executed.",
        epilog="exit status: 0 nothing found, 1 something found, 2 no such mission",
    )
    add_mission(check)
    check.add_argument("--board", metavar="NAME|FILE", help="check against this board instead of the mission's own")
    check.add_argument(
        "--faults",
        metavar="FILE",
        help="check a fault plan against the mission, too, which flies for 3 virtual seconds for that",
    )
    check.set_defaults(module="check")


def _add_mids(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    mids = commands.add_parser(
        "mids",
        help="show a mission's MsgIds: who sends and who subscribes",
        description="Run a mission quietly for 10 virtual seconds, and show its MsgIds.",
    )
    add_mission(mids)
    mids.add_argument("--board", metavar="NAME|FILE", help="run on this board instead of the mission's own")
    mids.add_argument(
        "--json",
        nargs="?",
        const="-",
        metavar="FILE",
        help="write the table as JSON to a file, or to standard output instead of the table",
    )
    mids.add_argument(
        "--lock",
        action="store_true",
        help="write topics.lock in the mission's folder, which gives every ROS topic and service a MsgId of its own; "
        "ids that are in it already stay",
    )
    mids.set_defaults(module="mids")


def _add_new(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    new = commands.add_parser("new", help="start an application or a mission from a skeleton that runs at once")
    new.add_argument("kind", choices=("app", "mission"), help="what to start")
    new.add_argument("name", metavar="NAME", help="also the name of the folder that is made")
    new.set_defaults(module="new")


def seconds_of(text: str) -> float:
    """A time in s, for argparse."""
    return _between(text, 0, LONGEST_S, "a number of seconds")


def count_of(text: str) -> int:
    """How many, at least one, for argparse."""
    if not text.isdecimal() or int(text) == 0:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of packets; give 1 or more")
    return int(text)


def runs_of(text: str) -> int:
    """How many runs to compare, for argparse."""
    if not text.isdecimal() or not 2 <= int(text) <= MOST_RUNS:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of runs; give 2 to {MOST_RUNS}")
    return int(text)


def launch_argument_of(text: str) -> tuple[str, str]:
    """An argument of a launch file and its value, for argparse."""
    name, mark, value = text.partition(":=")
    if not mark or not name:
        raise argparse.ArgumentTypeError(f"{text!r} is not like rate:=20")
    return name, value


def factor_of(text: str) -> float:
    """How many times as fast as the wall clock, for argparse."""
    return _between(text, SLOWEST, FASTEST, "a factor")


def ports_of(text: str) -> tuple[int, int]:
    """A port of the mission and what it is on this computer, for argparse."""
    inside, _, here = text.partition("=")
    if not (inside.isdecimal() and here.isdecimal() and 0 < int(inside) <= HIGHEST_PORT >= int(here)):
        raise argparse.ArgumentTypeError(f"{text!r} is not like 1234=0 or 1234=5000")
    return int(inside), int(here)


def _between(text: str, least: float, most: float, what: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = 0
    if not least <= number <= most or not number:
        low = f"{least:g}" if least else "more than 0"
        raise argparse.ArgumentTypeError(f"{text!r} is not {what}; give {low} to {most:g}")
    return number

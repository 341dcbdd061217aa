"""The entry point of the command: what it understands, and which module does it.

Only argparse is imported here; a subcommand imports its module when it is chosen, so that `cfepy --help` is quick.
"""

from __future__ import annotations

import argparse
import contextlib
import importlib
import os
import sys
from collections.abc import Sequence

from cfepy import __version__
from cfepy.status import UsageError

ENDED_WELL = 0
FOUND_PROBLEMS = 1
BAD_USAGE = 2
INTERRUPTED = 130  # 128 + SIGINT, what shells expect

LONGEST_S = 1e9  # virtual time is a signed 64-bit number of ns
SLOWEST, FASTEST = 1e-3, 1e9  # times real time

MISSION_HELP = "a startup script, a folder with a startup.scr, or a shipped mission's name"
STATUS_HELP = """exit status:
  0    the run ended well
  1    an application died or could not be started, a mission's own application sent an ERROR or CRITICAL event,
       or the processor was reset
  2    bad usage, or a mission that cannot boot
  130  ended by Ctrl-C (the report is still printed)"""


def main(argv: Sequence[str] | None = None) -> int:
    """Do what the command line says.

    Args:
        argv: the arguments without the program's name; those of the process when None.

    Returns:
        The exit status.
    """
    _open_closed_streams()
    arguments = _parser().parse_args(argv)
    try:
        run = importlib.import_module(f"cfepy.cli.{arguments.module}").run
        status: int = run(arguments)
        sys.stdout.flush()
        return status
    except UsageError as error:
        print(f"cfepy: {error}", file=sys.stderr)
        return BAD_USAGE
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:
        # Whoever read the output has enough of it; the interpreter must not try to write the rest when it ends.
        with contextlib.suppress(ValueError):  # an app closed it
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return ENDED_WELL
    except OSError as error:
        print(f"cfepy: {error}", file=sys.stderr)
        return BAD_USAGE


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="cfepy", description="NASA's core Flight Executive and ROS 1 nodes on one simulated processor."
    )
    parser.add_argument("--version", action="version", version=f"cfepy {__version__}")
    commands = parser.add_subparsers(metavar="COMMAND", required=True)
    _add_run(commands)
    _add_check(commands)
    _add_mids(commands)
    _add_new(commands)
    boards = commands.add_parser("boards", help="list the boards and their main numbers")
    boards.set_defaults(module="boards")
    return parser


def _add_run(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    run = commands.add_parser(
        "run",
        help="run a mission",
        description="Run a mission in virtual time, and report what happened.",
        epilog=STATUS_HELP,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    run.add_argument("mission", metavar="MISSION", help=MISSION_HELP)
    run.add_argument(
        "--for",
        dest="seconds",
        type=_seconds,
        default=10.0,
        metavar="SECONDS",
        help="virtual seconds to run (default: 10)",
    )
    run.add_argument("--seed", type=int, default=0, metavar="N", help="of everything random (default: 0)")
    run.add_argument("--board", metavar="NAME|FILE", help="run on this board instead of the mission's own")
    run.add_argument(
        "--tasks", choices=("thread", "greenlet"), default="thread", help="what tasks run on (default: thread)"
    )
    run.add_argument(
        "--schedule",
        choices=("fifo", "random"),
        default="fifo",
        help="who is next among ready tasks of equal priority: the first that became ready, or any, by the seed",
    )
    run.add_argument(
        "--realtime",
        nargs="?",
        type=_factor,
        const=1.0,
        metavar="FACTOR",
        help="pace virtual time to the wall clock, FACTOR times as fast (default: 1)",
    )
    run.add_argument("--json", metavar="FILE", help="write the report's numbers to a file")
    run.add_argument("--trace", metavar="FILE", help="write everything that happened to a file, a line each")
    run.add_argument("--quiet", action="store_true", help="no console and no status line, only the report")
    run.set_defaults(module="run")


def _add_check(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    check = commands.add_parser(
        "check",
        help="find everything that is wrong with a mission before it boots",
        description="Find what is wrong with a mission; none of its code is executed.",
        epilog="exit status: 0 nothing found, 1 something found, 2 no such mission",
    )
    check.add_argument("mission", metavar="MISSION", help=MISSION_HELP)
    check.add_argument("--board", metavar="NAME|FILE", help="check against this board instead of the mission's own")
    check.set_defaults(module="check")


def _add_mids(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    mids = commands.add_parser(
        "mids",
        help="show a mission's MsgIds: who sends and who subscribes",
        description="Run a mission quietly for 10 virtual seconds, and show its MsgIds.",
    )
    mids.add_argument("mission", metavar="MISSION", help=MISSION_HELP)
    mids.add_argument("--board", metavar="NAME|FILE", help="run on this board instead of the mission's own")
    mids.add_argument(
        "--json",
        nargs="?",
        const="-",
        metavar="FILE",
        help="write the table as JSON to a file, or to standard output instead of the table",
    )
    mids.set_defaults(module="mids")


def _add_new(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    new = commands.add_parser("new", help="start an application or a mission from a skeleton that runs at once")
    new.add_argument("kind", choices=("app", "mission"), help="what to start")
    new.add_argument("name", metavar="NAME", help="also the name of the folder that is made")
    new.set_defaults(module="new")


def _seconds(text: str) -> float:
    return _between(text, 0, LONGEST_S, "a number of seconds")


def _factor(text: str) -> float:
    return _between(text, SLOWEST, FASTEST, "a factor")


def _between(text: str, least: float, most: float, what: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = 0
    if not least <= number <= most or not number:
        low = f"{least:g}" if least else "more than 0"
        raise argparse.ArgumentTypeError(f"{text!r} is not {what}; give {low} to {most:g}")
    return number


def _open_closed_streams() -> None:
    """A process that was started without standard output or error gets ones that go nowhere."""
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115  # as long as the process

"""The entry point of the command: its subcommands, and the module that carries out each.

Only argparse is imported for that; a subcommand imports its module when it is chosen, so that `cfepy --help` is quick.
"""

from __future__ import annotations

import argparse
import contextlib
import errno
import importlib
import io
import os
import signal
import sys
from collections.abc import Iterator, Sequence
from typing import Any

from cfepy import __version__
from cfepy.cli.failures import NO_ROOM
from cfepy.cli.json_output import standard_output
from cfepy.cli.options import MISSION_HELP
from cfepy.cli.parser import CommandParser, RootParser
from cfepy.escapes import safe_output
from cfepy.garbage import freeze, no_collection
from cfepy.status import StallError, UsageError

ENDED_WELL = 0
FOUND_PROBLEMS = 1
BAD_USAGE = 2
INTERRUPTED = 130  # 128 + SIGINT, what shells expect
ROOMS = {
    "run": ("run", "check", "new", "boards", "board"),
    "ros": ("launch", "node", "rostest", "topic", "service", "param", "bag"),
    "ros_tools": ("rosbag", "rosmsg", "rossrv", "rosnode", "tf"),
    "explore": ("explore", "faults", "sweep"),
    "journal": ("replay", "diff"),
    "look": ("trace", "report", "plot"),
    "ground": ("cmd", "tlm", "console", "mids", "graph", "export"),
    "convert": ("convert",),
    "files": ("build", "tbl", "log"),
    "shell": ("completion",),
}
"""The commands of each room of this package; only the room in question is asked, since setting up all takes 10 ms."""
TITLES = {
    "run": "Fly a mission",
    "ros": "ROS",
    "ros_tools": "ROS's own tools",
    "explore": "Find races and faults",
    "journal": "Do a run again",
    "look": "Look at a run",
    "ground": "Ground",
    "convert": "ROS nodes in C++",
    "files": "Files of cFE",
    "shell": "The shell",
}
"""Under which the commands of a room stand in the help."""


def process() -> int:
    """The whole process `cfepy`: `main`, and a quick end: to look for garbage once more takes a tenth of a boot."""
    try:
        return main()
    finally:
        freeze()


def main(argv: Sequence[str] | None = None) -> int:
    """Do what the command line says.

    Args:
        argv: the arguments without the program's name; those of the process when None.

    Returns:
        The exit status.
    """
    _prepare_streams()
    with safe_output():
        return _obey(sys.argv[1:] if argv is None else argv)


def _obey(words: Sequence[str]) -> int:
    """Do what the words say; the exit status."""
    if "_ARGCOMPLETE" in os.environ:
        _command("shell.completion").complete(parser_for)
    try:
        chosen = parser_for(words).parse_args(words)
        with terminable(), standard_output(chosen):
            status: int = _command(chosen.module).run(chosen)
        sys.stdout.flush()
        return status
    except UsageError as error:
        print(f"cfepy: {error}", file=sys.stderr)
        return BAD_USAGE
    except StallError as error:
        print(f"cfepy: {error}", file=sys.stderr)
        return FOUND_PROBLEMS
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:
        # The reader of the output has closed it; the interpreter must not try to write the rest when it ends.
        with contextlib.suppress(ValueError):  # an app closed it
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return ENDED_WELL
    except MemoryError:
        return _tell_out_of_memory(words)
    except OSError as error:
        if error.errno == errno.ENOMEM:
            return _tell_out_of_memory(words)
        print(f"cfepy: {_without_room(error) or error}", file=sys.stderr)
        return BAD_USAGE


def _without_room(error: OSError) -> str:
    """Name what was written when a disk had no more room and the error names no file; empty for another error."""
    if error.filename is not None or error.errno not in NO_ROOM:
        return ""
    try:
        print(flush=True)  # standard output that had no room for a text has none for an empty line
    except OSError:
        return f"standard output cannot be written: {error.strerror}"
    import tempfile

    return f"a file cannot be written: {error.strerror}; make room where the outputs go and in {tempfile.gettempdir()}"


def _tell_out_of_memory(words: Sequence[str]) -> int:
    """There is no more memory; what was asked for says which file wanted it."""
    print(f"cfepy: there is not enough memory for `cfepy {' '.join(words)}`; make its input smaller", file=sys.stderr)
    return BAD_USAGE


@contextlib.contextmanager
def terminable() -> Iterator[None]:
    """Around what ends with Ctrl-C: SIGTERM does the same, so findings are told and temporary folders taken away."""
    try:
        before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    except ValueError:  # not the main thread: signals do not come here
        yield
        return
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def _command(module: str) -> Any:
    """The module of a command. What is imported stays, so that garbage is not looked for in it, which takes as long."""
    name = f"cfepy.cli.{module}"
    if name in sys.modules:
        return sys.modules[name]
    with no_collection:
        try:
            return importlib.import_module(name)
        finally:
            freeze()


class _Version(argparse.Action):
    """Tells the version and ends; whether something is compiled is found out only then."""

    def __init__(self, option_strings: Sequence[str], dest: str, help: str) -> None:
        super().__init__(option_strings, argparse.SUPPRESS, nargs=0, help=help)

    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> None:
        """See `argparse.Action`."""
        from cfepy.compiled import state

        print(f"cfepy {__version__} ({state()})")
        parser.exit()


def parser_for(words: Sequence[str]) -> argparse.ArgumentParser:
    """A parser for these words: with the command that they begin with, or with all when they begin with none."""
    parser = RootParser(
        {TITLES[room]: names for room, names in ROOMS.items()},
        prog="cfepy",
        description="NASA's core Flight Executive and ROS 1 nodes on one simulated processor.",
        epilog="`cfepy COMMAND --help` explains a command. A MISSION is " + MISSION_HELP + ".",
    )
    parser.add_argument("--version", action=_Version, help="tell the version, and whether kernel and bus are compiled")
    commands = parser.add_subparsers(metavar="COMMAND", required=True, parser_class=CommandParser)
    for part in [part for part, names in ROOMS.items() if words[:1] and words[0] in names] or ROOMS:
        importlib.import_module(f"cfepy.cli.{part}").add(commands)
    return parser


def _prepare_streams() -> None:
    """A process that was started without standard output or error gets ones that go nowhere.

    A text may hold bytes of a packet or a file that the encoding lacks: that must not stop the caller.
    """
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115  # as long as the process
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")

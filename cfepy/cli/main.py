"""The entry point of the command: what it understands, and which module does it.

Only argparse is imported for that; a subcommand imports its module when it is chosen, so that `cfepy --help` is quick.
"""

from __future__ import annotations

import argparse
import contextlib
import gc
import importlib
import io
import os
import sys
from collections.abc import Sequence
from typing import Any

from cfepy import __version__
from cfepy.status import UsageError

ENDED_WELL = 0
FOUND_PROBLEMS = 1
BAD_USAGE = 2
INTERRUPTED = 130  # 128 + SIGINT, what shells expect
COMMANDS = {
    "arguments": ("run", "check", "mids", "new", "boards"),
    "ground_arguments": ("cmd", "tlm", "export"),
    "file_arguments": ("tbl", "log"),
    "ros_arguments": ("param",),
    "topic_arguments": ("topic", "service"),
    "launch_arguments": ("launch", "node", "rostest"),
    "fault_arguments": ("faults",),
    "explore_arguments": ("explore",),
    "journal_arguments": ("replay", "diff"),
    "look_arguments": ("trace", "report"),
}
"""What each module adds to the parser; only the one in question is asked, since setting up all of them takes 10 ms."""


def process() -> int:
    """The whole process `cfepy`: `main`, and a quick end: to look for garbage once more takes a tenth of a boot."""
    try:
        return main()
    finally:
        gc.freeze()


def main(argv: Sequence[str] | None = None) -> int:
    """Do what the command line says.

    Args:
        argv: the arguments without the program's name; those of the process when None.

    Returns:
        The exit status.
    """
    _prepare_streams()
    words = sys.argv[1:] if argv is None else argv
    chosen = _parser(words).parse_args(words)
    try:
        status: int = _command(chosen.module).run(chosen)
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


def _command(module: str) -> Any:
    """The module of a command. What is imported stays, so that garbage is not looked for in it, which takes as long."""
    name = f"cfepy.cli.{module}"
    if name in sys.modules:
        return sys.modules[name]
    enabled = gc.isenabled()
    gc.disable()
    try:
        return importlib.import_module(name)
    finally:
        gc.freeze()
        if enabled:
            gc.enable()


def _parser(words: Sequence[str]) -> argparse.ArgumentParser:
    """A parser for these words: with the command that they begin with, or with all when they begin with none."""
    parser = argparse.ArgumentParser(
        prog="cfepy", description="NASA's core Flight Executive and ROS 1 nodes on one simulated processor."
    )
    parser.add_argument("--version", action="version", version=f"cfepy {__version__}")
    commands = parser.add_subparsers(metavar="COMMAND", required=True, parser_class=_MixedParser)
    for part in [part for part, names in COMMANDS.items() if words[:1] and words[0] in names] or COMMANDS:
        importlib.import_module(f"cfepy.cli.{part}").add(commands)
    return parser


class _MixedParser(argparse.ArgumentParser):
    """The parser of a command: options may stand between its words, which argparse by itself does not understand."""

    _is_mixing = False

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """See `ArgumentParser.parse_known_args`; a command with actions of its own leaves the mixing to them."""
        if self._is_mixing or self._subparsers is not None:
            return super().parse_known_args(args, namespace)
        self._is_mixing = True
        try:
            found, left = self.parse_known_intermixed_args(args, namespace)
        finally:
            self._is_mixing = False
        if left:  # told here, so that the usage shown is that of the command
            self.error(f"unrecognized arguments: {' '.join(left)}{self.get_default('hint') or ''}")
        return found, left


def _prepare_streams() -> None:
    """A process that was started without standard output or error gets ones that go nowhere.

    A text may hold bytes of a packet or a file that the encoding lacks: that must not stop who says it.
    """
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115  # as long as the process
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")

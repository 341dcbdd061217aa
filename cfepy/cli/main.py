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
from collections.abc import Iterable, Iterator, Mapping, Sequence
from types import TracebackType
from typing import Any

from cfepy import __version__
from cfepy.cli.json_output import standard_output
from cfepy.cli.options import MISSION_HELP, STATUS_HELP
from cfepy.cli.parser import HELP_OF_SHARED, CommandParser, RootParser, groups_help, parsers_below
from cfepy.cli.user_notes import NO_ROOM
from cfepy.interpreter.early_end import INTERRUPTED as INTERRUPTED
from cfepy.interpreter.early_end import leave, leave_on_interrupt
from cfepy.interpreter.garbage import freeze, no_collection
from cfepy.interpreter.host_system import (
    ask_for_one_blas_thread,
    ending_signals,
    interrupt_once,
    leave_dead_terminal,
    signal_number,
)
from cfepy.plugins import OWN, Plugin, installed, missing, owner_of
from cfepy.status import StallError, UsageError
from cfepy.writing.escapes import keep_output_safe, raw, safe_output

ENDED_WELL = 0
FOUND_PROBLEMS = 1
BAD_USAGE = 2
HELP, FLYING = "help", "flying"
SHELLS = ("bash", "zsh", "fish")
AGAIN_S = 0.001  # wall time until a dropped interrupt is raised again
ROOMS = {
    "run": ("run", "check", "new"),
    "board": ("board",),
    "ros": ("launch", "node", "rostest", "rostopic", "rosservice", "rosparam"),
    "ros_tools": ("rosnode", "rosmsg", "rosbag", "tf"),
    "journal": ("replay", "diff"),
    "ground": ("cmd", "tlm", "console", "graph", "export"),
    "files": ("tbl", "log"),
}
"""The commands of each subpackage. Only the subpackage of the given command is loaded, since setting up all takes 10
ms.
"""
ALIASES = {"roslaunch": "launch", "rosrun": "node", "rossrv": "rosmsg"}
"""ROS's names of some commands, with the commands that have them."""
TITLES = {
    "run": "Fly a mission",
    "board": "Fly a mission",
    "ros": "ROS",
    "ros_tools": "ROS",
    "journal": "Do a run again",
    "ground": "Ground",
    "files": "Files of cFE",
}
"""Titles in the help, under which the commands of a subpackage are listed."""
FLYING_HELP = """\
Options that commands share which fly a mission, such as run, launch, explore and plot.
`cfepy COMMAND --help` names those that a command takes.
"""
ORDER = (
    "Fly a mission",
    "ROS",
    "Find races and faults",
    "Test procedures",
    "Do a run again",
    "Look at a run",
    "Ground",
    "ROS nodes in C++",
    "Files of cFE",
)
"""Order of the titles in the help; titles of other packages' add-ons follow."""


def process() -> int:
    """Run the whole process `cfepy`: `main`, and a quick exit. A last garbage collection would take a tenth of a boot.

    Ctrl-C ends it at once before a command begins, and after it is done. So does an internal error of cfepy, whose
    traceback is printed through the same safe output.
    """
    leave_on_interrupt()
    ask_for_one_blas_thread()
    _prepare_streams()
    keep_output_safe()
    sys.excepthook, sys.unraisablehook = _print_error, _pass_on_interrupt
    try:
        try:
            status = main()
        finally:
            with contextlib.suppress(OSError, ValueError):  # reported already
                sys.stdout.flush()
            leave_on_interrupt()
    except KeyboardInterrupt:
        status = INTERRUPTED
    freeze()
    return status


def _print_error(kind: type[BaseException], error: BaseException, where: TracebackType | None) -> None:
    """Print a traceback without Python's colours, which are escape sequences."""
    import traceback

    sys.stderr.write("".join(traceback.format_exception(kind, error, where)))


def _pass_on_interrupt(lost: sys.UnraisableHookArgs) -> None:
    """Raise a KeyboardInterrupt again soon, if it was raised in a callback or a finalizer, where Python drops it."""
    if lost.exc_type is not KeyboardInterrupt or not hasattr(signal, "setitimer"):
        sys.__unraisablehook__(lost)
        return
    signal.signal(signal.SIGALRM, lambda *_: signal.raise_signal(signal.SIGINT))
    signal.setitimer(signal.ITIMER_REAL, AGAIN_S)


def main(argv: Sequence[str] | None = None) -> int:
    """Carry out the command line.

    Args:
        argv: the arguments without the program's name; None for the arguments of the process.

    Returns:
        The exit status.
    """
    _prepare_streams()
    with safe_output():
        try:
            return _obey(sys.argv[1:] if argv is None else argv)
        except OSError:  # raised while another error was reported
            if leave_dead_terminal():
                return INTERRUPTED
            raise


def _obey(words: Sequence[str]) -> int:
    """Carry out the words. Returns the exit status."""
    if "_ARGCOMPLETE" in os.environ:
        _command(f"{__package__}.shell_completion").complete(parser_for)
    chosen = argparse.Namespace()
    try:
        if words[:1] == [HELP]:
            return _print_help(words[1:])
        chosen = parser_for(words).parse_args(words)
        chosen.given = words
        command = _command(chosen.module)
        with terminable(), standard_output(chosen):
            status: int = command.run(chosen)
        sys.stdout.flush()
        return status
    except UsageError as error:
        print(f"cfepy: {error}", file=sys.stderr)
        if getattr(chosen, "github", False):
            _command(f"{__package__}.ci_outputs").annotate(error)
        return BAD_USAGE
    except StallError as error:
        print(f"cfepy: {error}", file=sys.stderr)
        return FOUND_PROBLEMS
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:
        _drop_output()  # its reader has closed it
        return ENDED_WELL
    except MemoryError:
        return _tell_out_of_memory(words)
    except OSError as error:
        if error.errno == errno.ENOMEM:
            return _tell_out_of_memory(words)
        if leave_dead_terminal():
            return INTERRUPTED
        print(f"cfepy: {_without_room(error) or error}", file=sys.stderr)
        return BAD_USAGE


def _print_help(words: Sequence[str]) -> int:
    """Print the help of a command, of all, or of the options that commands share. Returns the exit status."""
    if list(words) != [FLYING]:
        parser_for(words).parse_args([*words, "--help"])
    groups: dict[str | None, argparse._ArgumentGroup] = {}
    parsers = parsers_below(parser_for([]))
    for each in parsers:
        for group in each.shared:
            groups.setdefault(group.title, group)
    print(f"{FLYING_HELP}\n{groups_help(each, groups.values())}\n{STATUS_HELP}")
    return ENDED_WELL


def _drop_output() -> None:
    """Redirect standard output to the null device, so that Python does not write the rest of it at exit."""
    with contextlib.suppress(ValueError):  # an app closed it
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _without_room(error: OSError) -> str:
    """Return which output failed if a disk is full and the error names no file; an empty text for another error."""
    if error.filename is not None or error.errno not in NO_ROOM:
        return ""
    try:
        print(flush=True)  # a full standard output has no room for an empty line either
    except OSError:
        _drop_output()
        return f"standard output cannot be written: {error.strerror}"
    import tempfile

    return f"a file cannot be written: {error.strerror}; make room where the outputs go and in {tempfile.gettempdir()}"


def _tell_out_of_memory(words: Sequence[str]) -> int:
    """Report that memory ran out; the command line shows which file needed it. Returns the exit status."""
    print(f"cfepy: out of memory in `cfepy {' '.join(words)}`; make its input smaller", file=sys.stderr)
    return BAD_USAGE


@contextlib.contextmanager
def terminable() -> Iterator[None]:
    """Let Ctrl-C, SIGTERM and SIGHUP end a command, so that it reports its findings and removes temporary folders."""
    before: dict[int, Any] = {}
    try:
        for each in ending_signals():
            if each != signal.SIGINT or signal.getsignal(each) is leave:
                is_hangup = each == signal_number("SIGHUP")
                before[each] = signal.signal(each, interrupt_once if is_hangup else signal.default_int_handler)
    except ValueError:  # not the main thread: signals do not arrive here
        pass
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _command(module: str) -> Any:
    """Import and freeze a command's module: collecting garbage in it would take as long as the import."""
    if module in sys.modules:
        return sys.modules[module]
    with no_collection:
        try:
            return importlib.import_module(module)
        finally:
            freeze()


class _Completion(argparse.Action):
    """Prints the completion script of a shell and exits."""

    def __call__(self, parser: argparse.ArgumentParser, namespace: Any, shell: Any, option: str | None = None) -> None:
        print(_command(f"{__package__}.shell_completion").script(shell))
        parser.exit()


class _Version(argparse.Action):
    """Prints the version and exits. It checks for compiled parts only then."""

    def __init__(self, option_strings: Sequence[str], dest: str, help: str) -> None:
        super().__init__(option_strings, argparse.SUPPRESS, nargs=0, help=help)

    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> None:
        from cfepy.config.versions import DEFAULT_RELEASE, RELEASES
        from cfepy.interpreter.compiled import state

        print(f"cfepy {__version__} ({state()})")
        for name in sorted(RELEASES, key=lambda name: name != DEFAULT_RELEASE):
            usual = ", the default" if name == DEFAULT_RELEASE else ""
            print(f"cfe_version {name}: {RELEASES[name].bundle}{usual}")
        parser.exit()


def parser_for(words: Sequence[str]) -> CommandParser:
    """Make a parser for a command line.

    Args:
        words: the command line. If it begins with a command, the parser has only that command and its neighbours.

    Raises:
        UsageError: the command belongs to an add-on that is not installed.
    """
    first = ALIASES.get(words[0], words[0]) if words else ""
    rooms = {room: names for room, names in ROOMS.items() if first in names}
    plugins: Sequence[Plugin] = ()
    if not rooms:
        usable = _with_new_commands(installed())
        plugins = [each for each in usable if first in each.commands]
        owner = None if plugins else owner_of(first)
        if owner is not None:
            raise UsageError(missing(f"the command {first}", owner.name))
        if not plugins:
            rooms, plugins = dict(ROOMS), usable
    groups = _groups(rooms, plugins)
    parser = RootParser(
        groups,
        prog="cfepy",
        description="NASA's core Flight Executive and ROS 1 nodes on one simulated processor.",
        epilog=f"`cfepy COMMAND --help` explains a command, `{HELP_OF_SHARED}` the options that many commands share. "
        f"A MISSION is {MISSION_HELP}.{_add_ons(plugins)}",
    )
    parser.add_argument("--version", action=_Version, help="print the version, and whether the engine is compiled")
    parser.add_argument(
        "--completion",
        action=_Completion,
        choices=SHELLS,
        metavar="SHELL",
        help="print the script that completes words in bash, zsh or fish",
    )
    commands = parser.add_subparsers(metavar="COMMAND", required=True, parser_class=CommandParser)
    for room in rooms:
        importlib.import_module(f"cfepy.cli.{room}").add(commands)
    for plugin in plugins:
        try:
            if plugin.commands:
                plugin.add_commands(commands)
        except UsageError as error:  # raised by another package
            if not rooms:
                raise
            print(f"cfepy: {error}", file=sys.stderr)
            del groups[plugin.title]
    return parser


def _with_new_commands(plugins: Iterable[Plugin]) -> list[Plugin]:
    """Leave out add-ons whose commands exist already, and report them."""
    taken = {name for names in ROOMS.values() for name in names}
    usable = []
    for each in plugins:
        twice = sorted(taken.intersection(each.commands))
        if twice:
            print(f"cfepy: the add-on {each.name} is left out: the command {twice[0]} already exists", file=sys.stderr)
        else:
            taken.update(each.commands)
            usable.append(each)
    return usable


def _groups(rooms: Mapping[str, Sequence[str]], plugins: Sequence[Plugin]) -> dict[str, list[str]]:
    """Return the commands by the titles above them, in the order of the help."""
    groups: dict[str, list[str]] = {title: [] for title in ORDER}
    for each in plugins:
        if each.commands:
            groups.setdefault(each.title, []).extend(each.commands)
    for room, names in rooms.items():
        groups[TITLES[room]].extend(names)
    return {title: names for title, names in groups.items() if names}


def _add_ons(plugins: Sequence[Plugin]) -> str:
    """Name the add-ons of other packages for the help; it lists the commands of cfepy's own add-ons anyway."""
    names = [each.name for each in plugins if each not in OWN]
    return f" Add-ons of other packages: {', '.join(names)}." if names else ""


def _prepare_streams() -> None:
    """Prepare standard output and error: open the null device if the process was started without them.

    A text may hold bytes of a packet or a file that the encoding lacks; they are escaped, so that the caller does not
    fail.
    """
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115  # as long as the process
    stdout = raw(sys.stdout)
    if isinstance(stdout, io.TextIOWrapper):
        stdout.reconfigure(errors="backslashreplace")

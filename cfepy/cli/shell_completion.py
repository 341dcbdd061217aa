"""`cfepy --completion SHELL`: completion of commands, options and names in a shell, by argcomplete.

The shell asks this command for the completions of a word. They are taken from the parsers and from files; no mission is
flown.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

from cfepy.cli.parser import LAUNCH_FILES, MissionAction, parsers_below
from cfepy.status import UsageError

if TYPE_CHECKING:
    from cfepy.ground import Dictionary
    from rospy_shim.types.msgs.packages import Packages

COMMANDS_OF, TELEMETRY_OF = "cfepy.cli.ground.cmd", "cfepy.cli.ground.tlm"
NEEDS = "requires the library argcomplete: pip install 'cfepy[completion]'"
_MISSIONS = (*LAUNCH_FILES, ".scr", ".py", ".bag", ".cfepy")
_FILES = ("FILE", "FILE|-", "FILE|seed:N", "PATH", "BAG", "FILE.yaml", "FILE.tbl", "A", "B", "DIR", "FILE.tbl|DIR")
_Complete = Callable[..., Iterable[str]]


def script(shell: str) -> str:
    """Return the script that a shell must evaluate.

    Args:
        shell: "bash", "zsh" or "fish".

    Raises:
        UsageError: argcomplete is not installed.
    """
    try:
        from argcomplete.shell_integration import shellcode
    except ImportError:
        raise UsageError(NEEDS, field="--completion") from None
    return str(shellcode(["cfepy"], shell=shell))


def complete(
    make_parser: Callable[[list[str]], argparse.ArgumentParser],
    stream: TextIO | None = None,
    end: Callable[[int], object] = os._exit,
) -> None:
    """Print the completions of a word for the shell, and end the process.

    Args:
        make_parser: makes the parser for the words of a command line.
        stream: the output; None is the one that the shell's script expects.
        end: ends the process.
    """
    try:
        from argcomplete.finders import CompletionFinder, safe_actions
    except ImportError:
        sys.exit(1)  # its script was left in the shell; a message would reach no one
    safe_actions.add(MissionAction)
    parser = make_parser(os.environ["COMP_LINE"].split()[1:])
    for each in parsers_below(parser):
        each.mixes = False
        for action in each._actions:
            completer = _completer(action)
            if completer is not None:
                action.completer = completer  # type: ignore[attr-defined]  # argcomplete's

    class Finder(CompletionFinder):
        """The finder of argcomplete, extended for a mission in two words."""

        def _init_debug_stream(self) -> None:
            """Do nothing: argcomplete would take descriptor 9, which may belong to another program."""

        def collect_completions(self, active_parsers: Any, parsed_args: Any, cword_prefix: str) -> list[str]:
            """Add the launch files of a package after its name."""
            found = super().collect_completions(active_parsers, parsed_args, cword_prefix)
            return [*found, *_second_words(active_parsers[-1], parsed_args, cword_prefix)]

    Finder()(parser, always_complete_options=False, exit_method=end, output_stream=stream)


def _completer(action: argparse.Action) -> _Complete | None:
    """Return the completer of an argument; None for one with choices, and for a file."""
    if isinstance(action, MissionAction):
        return missions
    if action.choices is not None or action.metavar in _FILES:
        return None
    by_name: dict[str, _Complete] = {"--board": boards, "--show": packets, "name": packets, "fields": fields}
    return by_name.get(action.option_strings[0] if action.option_strings else action.dest, _nothing)


def _nothing(**_: object) -> list[str]:
    """Complete nothing: a number, a time, or free text."""
    return []


# -- names -------------------------------------------------------------------------------------------------------------


def missions(prefix: str, parsed_args: argparse.Namespace, action: argparse.Action, **_: object) -> list[str]:
    """Return missions that cfepy ships, packages, and files and folders that can be missions."""
    from cfepy.mission import shipped_missions

    if getattr(parsed_args, action.dest, None):  # the first of several words
        return packets(prefix, parsed_args)
    found = [*shipped_missions(), *(_packages().names() if "/" not in prefix else [])]
    return [*found, *_paths(prefix, _MISSIONS)]


def _second_words(parser: argparse.ArgumentParser, parsed_args: argparse.Namespace, prefix: str) -> list[str]:
    """Return the launch files of a package that stands where a mission may."""
    said = [getattr(parsed_args, each.dest, None) for each in parser._actions if isinstance(each, MissionAction)]
    names = [name for each in said if each for name in (each if isinstance(each, list) else [each])]
    folders = [folder for name in names[-1:] for folder in _packages().folders(name)] if prefix[:1] != "-" else []
    return sorted({file.name for folder in folders for file in folder.rglob(f"{prefix}*.launch")})


def boards(prefix: str, **_: object) -> list[str]:
    """Return boards by name, and board files."""
    from cfepy.psp import available_boards

    return [*available_boards(), *_paths(prefix, (".yaml",))]


def packets(prefix: str, parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """Return commands for `cfepy cmd`, and telemetry for `cfepy tlm`, of the mission on the command line."""
    module = getattr(parsed_args, "module", "")
    if module not in (COMMANDS_OF, TELEMETRY_OF):
        return []
    dictionary = _dictionary(parsed_args)
    return sorted(dictionary.commands if module == COMMANDS_OF else dictionary.telemetry)


def fields(prefix: str, parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """Return the fields of a command, with the names of their values."""
    dictionary, name = _dictionary(parsed_args), getattr(parsed_args, "name", None)
    if name not in dictionary.commands:
        return []
    cells = list(dictionary.commands[name].payload.cells())
    named = [f"{cell.path}={value}" for cell in cells if cell.names is not None for value in cell.names.values]
    return named if "=" in prefix else [f"{cell.path}=" for cell in cells]


def _dictionary(parsed_args: argparse.Namespace) -> Dictionary:
    """Return the dictionary of the mission on the command line, or of all that cfepy ships."""
    from cfepy.ground import dictionary_of
    from cfepy.mission import read_mission

    words = getattr(parsed_args, "words", None) or [None]
    mission = getattr(parsed_args, "target", None) or getattr(parsed_args, "mission", None) or words[0]
    try:
        return dictionary_of(None if mission is None else read_mission(mission))
    except UsageError:
        return dictionary_of(None)


def _packages() -> Packages:
    """Return the packages that are found from the working directory."""
    from rospy_shim.roslaunch.launch_plan import packages_near

    return packages_near(Path.cwd() / "here", os.environ)


def _paths(prefix: str, suffixes: tuple[str, ...]) -> list[str]:
    """Return folders and files of some kinds that begin with a prefix."""
    folder, _, name = prefix.rpartition("/")
    start = f"{folder}/" if "/" in prefix else ""
    try:
        found = [each for each in Path(start or ".").iterdir() if each.name.startswith(name)]
    except OSError:
        return []
    shown = [each for each in found if each.is_dir() or each.suffix in suffixes]
    return [f"{start}{each.name}{'/' if each.is_dir() else ''}" for each in shown if name or each.name[0] != "."]

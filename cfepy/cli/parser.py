"""The parser of the command line: options between words, `PACKAGE FILE` as one word, hints, and help in groups.

It is argparse, whose parser each command gets as this one.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Mapping, Sequence
from typing import Any

from cfepy.reading.suggestions import did_you_mean
from cfepy.writing.escapes import raw

LAUNCH_FILES = (".launch", ".test", ".xml")
_PACKAGE = re.compile(r"\w[\w-]*")
_CONTINUED = re.compile(r"\n {3,}(?=\S)")
_ENTRY = re.compile(r" +\d+ +")
FROM_ROS = {"rosrun": "node", "tf_echo": "tf echo", "view_frames": "tf frames", "rqt_graph": "graph"}
"""ROS's names of some commands. Names that are alike need no row."""
_FEW = 2  # options that are shown in a usage; a command with more shows a placeholder


class HelpFormatter(argparse.HelpFormatter):
    """Wraps a list of exit statuses entry by entry, and all other text as argparse does."""

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        """Wrap a text; a deeply indented line continues the entry before it."""
        import textwrap

        lines: list[str] = []
        for line in _CONTINUED.sub(" ", text).splitlines():
            entry = _ENTRY.match(line)
            below = indent + " " * (0 if entry is None else entry.end())
            lines += textwrap.wrap(line, width, initial_indent=indent, subsequent_indent=below)
        return "\n".join(lines)

    def _format_action_invocation(self, action: argparse.Action) -> str:
        """Show several words of one argument side by side, which argparse cannot do."""
        if not action.option_strings and isinstance(action.metavar, tuple):
            return " ".join(action.metavar)
        return super()._format_action_invocation(action)


class MissionAction(argparse.Action):
    """An argument that is a mission; a package and the name of a launch file in it are one mission in two words."""

    def __call__(
        self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, values: Any, option_string: Any = None
    ) -> None:
        setattr(namespace, self.dest, values)


class CommandParser(argparse.ArgumentParser):
    """The parser of a command: options may stand between its words, which argparse does not support.

    Attributes:
        mixes: True if they may. For shell completion it is False.
    """

    mixes = True
    _is_mixing = False

    def __init__(self, **settings: Any) -> None:
        # A later option must not break a script, so abbreviations of options are not accepted.
        super().__init__(**{**settings, "allow_abbrev": False, "formatter_class": HelpFormatter})

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Parse the arguments. A command with actions of its own leaves the mixing of options and words to them."""
        if self._is_mixing:
            return super().parse_known_args(args, namespace)
        if not self.mixes:
            return super().parse_known_args(self._with_missions_joined(args), namespace)
        if self._subparsers is not None:
            found, left = super().parse_known_args(args, namespace)
        else:
            found, left = self._mixed(self._with_missions_joined(args), namespace)
        if left:  # reported here, so that the message shows the usage of the command
            self._refuse(left)
        return found, left

    def _mixed(self, args: Sequence[str], namespace: Any) -> tuple[argparse.Namespace, list[str]]:
        self.usage = self._usage().replace("%", "%%")  # now, because argparse removes the words while it mixes
        self._is_mixing = True
        try:
            return self.parse_known_intermixed_args(args, namespace)
        finally:
            self._is_mixing = False

    def _with_missions_joined(self, args: Sequence[str]) -> list[str]:
        """Join PACKAGE FILE to one word, where a mission may stand."""
        joined: list[str] = []
        takes_missions = any(isinstance(action, MissionAction) for action in self._actions)
        for word in args:
            if takes_missions and word.endswith(LAUNCH_FILES) and joined and self._is_package(joined):
                joined[-1] = f"{joined[-1]} {word}"
            else:
                joined.append(word)
        return joined

    def _is_package(self, words: Sequence[str]) -> bool:
        """Return True if the last word may be a package: it looks like one, and is not a value of an option."""
        option = self._option_string_actions.get(words[-2]) if len(words) > 1 else None
        is_value = option is not None and option.nargs != 0 and not isinstance(option, MissionAction)
        return _PACKAGE.fullmatch(words[-1]) is not None and not is_value and "--" not in words

    def _refuse(self, words: Sequence[str]) -> None:
        """Report unexpected words, with a hint for an unknown option."""
        hints = (
            did_you_mean(word.partition("=")[0], self._option_string_actions, before="; ")
            for word in words
            if word.startswith("-")
        )
        hint = next(filter(None, hints), self.get_default("hint") or "")
        self.error(f"unrecognized arguments: {' '.join(words)}{hint}")

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        """Check a choice as argparse does, and add a hint; argparse intends this method for that."""
        try:
            super()._check_value(action, value)
        except argparse.ArgumentError as error:
            hint = did_you_mean(str(value), [str(choice) for choice in action.choices or ()], before="; ")
            text = f"invalid choice: {value!r}{hint}" if hint else error.message
            raise argparse.ArgumentError(action, text) from None

    def print_help(self, file: Any = None) -> None:
        """Print the help with the colours that Python may add; all of it is cfepy's own text."""
        super().print_help(raw(sys.stdout if file is None else file))

    def print_usage(self, file: Any = None) -> None:
        """Print the usage in the same way as the help."""
        super().print_usage(raw(sys.stdout if file is None else file))

    def format_usage(self) -> str:
        """Return the words of the command; its options are in its help."""
        return f"usage: {self._usage() if self.usage is None else self.usage.replace('%%', '%')}"

    def _usage(self) -> str:
        options = [action for action in self._actions if action.option_strings]
        words = [action for action in self._actions if not action.option_strings]
        few = len(options) <= _FEW
        formatter = self.formatter_class(prog=self.prog if few else f"{self.prog} [OPTION ...]")
        formatter.add_usage(None, [*options, *words] if few else words, [])
        return formatter.format_help().removeprefix("usage: ")

    def format_help(self) -> str:
        """Format the help as argparse does, with this usage."""
        _, _, rest = super().format_help().partition("\n\n")
        return f"{self.format_usage()}\n{rest}"


class RootParser(CommandParser):
    """The parser of `cfepy` itself, whose help has its commands in groups.

    Args:
        groups: the commands of each group, by its title.
        settings: as for `ArgumentParser`.
    """

    def __init__(self, groups: Mapping[str, Sequence[str]], **settings: Any) -> None:
        super().__init__(**settings)
        self._groups = groups

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        """Check a choice as all parsers do; for a ROS tool with another name here, name the command."""
        meant = FROM_ROS.get(value) if isinstance(action, argparse._SubParsersAction) else None
        if meant is not None:
            raise argparse.ArgumentError(action, f"invalid choice: {value!r}; did you mean {meant}?")
        super()._check_value(action, value)

    def format_help(self) -> str:
        """Format the help with the commands in their groups."""
        formatter = self._get_formatter()
        formatter.add_text(self.description)
        commands = next(action for action in self._actions if isinstance(action, argparse._SubParsersAction))
        lines = {each.dest: each for each in commands._choices_actions}
        for title, names in self._groups.items():
            formatter.start_section(title)
            formatter.add_arguments([lines[name] for name in names])
            formatter.end_section()
        formatter.start_section("options")
        formatter.add_arguments([action for action in self._actions if action.option_strings])
        formatter.end_section()
        formatter.add_text(self.epilog)
        return f"{self.format_usage()}\n{formatter.format_help()}"

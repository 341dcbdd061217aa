"""The parser of the command line: options between words, `PACKAGE FILE` as one word, hints, and help in groups.

It is argparse, whose parser each command gets as this one.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, NoReturn

from cfepy.reading.suggestions import did_you_mean
from cfepy.writing.escapes import raw

HELP_OF_SHARED = "cfepy help flying"
LAUNCH_FILES = (".launch", ".test", ".xml")
_PACKAGE = re.compile(r"\w[\w-]*")
_CONTINUED = re.compile(r"\n {3,}(?=\S)")
_ENTRY = re.compile(r" +\d+ +")
OTHER_NAMES = {
    "bag": "rosbag",
    "boards": "board list",
    "completion": "--completion",
    "faults": "new faults",
    "mids": "graph --mids",
    "param": "rosparam",
    "rqt_graph": "graph",
    "service": "rosservice",
    "tf_echo": "tf echo",
    "topic": "rostopic",
    "view_frames": "tf frames",
}
"""Names of commands in ROS, and in earlier versions, with today's. Names that are alike need no row."""
_ALMOST = 0.8  # likeness of two options, one of which is likely to be a mistake
_SIMILAR = 0.7  # likeness of an option and a misspelt one
_REQUIRED = "the following arguments are required: "
_WITHOUT_VALUE = re.compile(r"argument (\S+): expected one argument")
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


def shared_group(parser: argparse.ArgumentParser, title: str) -> argparse._ArgumentGroup:
    """Add a group for options that commands share. The help of a command names them; `cfepy help flying` explains them.

    Args:
        parser: parser of the command.
        title: title of the group, the same for all commands.
    """
    group = parser.add_argument_group(title)
    if isinstance(parser, CommandParser):
        parser.shared.append(group)
    return group


def hand_options_to_nodes(parser: argparse.ArgumentParser, is_node: Callable[[str], bool]) -> None:
    """Let a node get the words after it and the options that the command does not have, as with rosrun.

    Args:
        parser: parser of the command.
        is_node: returns whether a first word is a node.
    """
    if isinstance(parser, CommandParser):
        parser.is_for_nodes = is_node


def add_example(parser: argparse.ArgumentParser, example: str) -> None:
    """Add an example to the help of a command, such as one with the options of an add-on.

    Args:
        parser: parser of the command.
        example: the whole command line.
    """
    if isinstance(parser, CommandParser):
        parser.examples = (*parser.examples, example)


class CommandParser(argparse.ArgumentParser):
    """The parser of a command: options may stand between its words, which argparse does not support.

    Args:
        examples: command lines that the help shows first.
        settings: as for `ArgumentParser`.

    Attributes:
        examples: these command lines.
        mixes: True if options may stand between words. For shell completion it is False.
        is_for_nodes: see `hand_options_to_nodes`.
        shared: the groups of `shared_group`.
    """

    mixes = True
    _is_mixing = False

    def __init__(self, *, examples: Sequence[str] = (), **settings: Any) -> None:
        # A later option must not break a script, so abbreviations of options are not accepted.
        super().__init__(**{**settings, "allow_abbrev": False, "formatter_class": HelpFormatter})
        self.examples = tuple(examples)
        self.shared: list[argparse._ArgumentGroup] = []
        self.is_for_nodes: Callable[[str], bool] = lambda word: False

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Parse the arguments. A command with actions of its own leaves the mixing of options and words to them."""
        if self._is_mixing:
            return super().parse_known_args(args, namespace)
        if not self.mixes:
            return super().parse_known_args(self._with_missions_joined(args), namespace)
        if self._subparsers is not None:
            found, left = super().parse_known_args(args, namespace)
        else:
            found, left = self._mixed(self._with_node_options_last(self._with_missions_joined(args)), namespace)
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

    def _with_node_options_last(self, args: Sequence[str]) -> list[str]:
        """Move a node's own options, and the words after them, behind `--`."""
        own: list[str] = []
        of_node: list[str] = []
        first, rest = "", list(args)
        while rest:
            word = rest.pop(0)
            if word == "--":
                of_node += rest
                break
            option = self._option_string_actions.get(word.partition("=")[0])
            if option is not None:
                own += [word, *_values_of(option, rest, has_value="=" in word)]
            elif word.startswith("-") and self.is_for_nodes(first) and not self._negative_number_matcher.match(word):
                of_node.append(word)
                self._note_similar(word)
            else:
                (of_node if of_node else own).append(word)
                first = first or word
        return [*own, "--", *of_node] if of_node else list(args)

    def _note_similar(self, word: str) -> None:
        """Tell the user that a node gets an option which is almost one of the command."""
        hint = did_you_mean(word.partition("=")[0], self._option_string_actions, before="; ", likeness=_ALMOST)
        if hint:
            print(f"cfepy: {word} is passed to the node{hint}", file=sys.stderr)

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
        known = self._option_string_actions
        names = [word.partition("=")[0] for word in words if word.startswith("-")]
        hints = [did_you_mean(name, known, before="; ", likeness=_SIMILAR) for name in names]
        own = self.get_default("option_hints") or {}  # of options that other commands have
        hint = "".join(own.get(name, "") for name in names)
        hint = hint or "".join(dict.fromkeys(hints)) or self.get_default("hint") or ""
        self.error(f"unrecognized arguments: {' '.join(words)}{hint}")

    def error(self, message: str) -> NoReturn:
        """Report a mistake and exit. It names only words that are missing, and the kind of a missing value."""
        missing = message.partition(_REQUIRED)[2]
        if missing:
            optional = [
                each.metavar for each in self._actions if each.nargs in (argparse.OPTIONAL, argparse.ZERO_OR_MORE)
            ]
            message = _REQUIRED + ", ".join(name for name in missing.split(", ") if name not in optional)
        found = _WITHOUT_VALUE.fullmatch(message)
        if found is not None:
            option = self._option_string_actions.get(found[1].rpartition("/")[2])
            if option is not None and isinstance(option.metavar, str):
                message = f"argument {found[1]}: missing value; expected {option.option_strings[-1]} {option.metavar}"
        super().error(message)

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
        """Format the help: usage, purpose, examples, the arguments and options of this command, and the names of those
        that commands share."""
        formatter = self._get_formatter()
        formatter.add_text(self.description)
        text = formatter.format_help()
        if self.examples:
            text += "".join(["\nexamples:\n", *(f"  {each}\n" for each in self.examples)])
        return (
            f"{self.format_usage()}\n{text}{self._own_help()}{self._shared_help()}{self._epilog_help()}".rstrip() + "\n"
        )

    def _own_help(self) -> str:
        text = groups_help(self, [each for each in self._action_groups if each not in self.shared])
        return f"\n{text}" if text else ""

    def _shared_help(self) -> str:
        """Name the options of shared groups."""
        if not self.shared:
            return ""
        import textwrap

        lines = [f"\nmore options, which `{HELP_OF_SHARED}` explains:"]
        for group in self.shared:
            names = [action.option_strings[-1] for action in group._group_actions]
            text = f"{group.title}: {' '.join(names)}"
            lines += textwrap.wrap(
                text, self._width(), initial_indent="  ", subsequent_indent="    ", break_on_hyphens=False
            )
        return "\n".join(lines) + "\n"

    def _epilog_help(self) -> str:
        formatter = self._get_formatter()
        formatter.add_text(self.epilog)
        text = formatter.format_help()
        return f"\n{text}" if text else ""

    def _width(self) -> int:
        return int(self._get_formatter()._width)


def _values_of(option: argparse.Action, words: list[str], has_value: bool) -> list[str]:
    """Remove the values of an option from the words after it. Returns them.

    Args:
        option: the option.
        words: the words after it.
        has_value: whether the option has its value in the same word.
    """
    is_fixed = option.nargs is None or isinstance(option.nargs, int)
    most = option.nargs if isinstance(option.nargs, int) else 1 if option.nargs in (None, "?") else len(words)
    count = 0 if has_value else most
    taken: list[str] = []
    while words and len(taken) < count and (is_fixed or not words[0].startswith("-")):
        taken.append(words.pop(0))
    return taken


def groups_help(parser: argparse.ArgumentParser, groups: Iterable[argparse._ArgumentGroup]) -> str:
    """Format the help of groups of options."""
    formatter = parser._get_formatter()
    for group in groups:
        formatter.start_section(group.title)
        formatter.add_text(group.description)
        formatter.add_arguments(group._group_actions)
        formatter.end_section()
    return formatter.format_help()


def parsers_below(parser: argparse.ArgumentParser) -> Iterator[CommandParser]:
    """Yield a parser and those of all commands and actions below it, each once."""
    assert isinstance(parser, CommandParser)
    yield parser
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for each in dict.fromkeys(action.choices.values()):  # an alias has the same parser
                yield from parsers_below(each)


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
        """Check a choice as all parsers do; for a command with another name in ROS, or in earlier versions, name it."""
        meant = OTHER_NAMES.get(value) if isinstance(action, argparse._SubParsersAction) else None
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

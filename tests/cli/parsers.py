"""All parsers of the command: one for each subcommand and action, by its words."""

from __future__ import annotations

import argparse
import functools
from collections.abc import Iterator

from cfepy.cli.main import parser_for
from cfepy.cli.parser import CommandParser


def parsers() -> dict[str, CommandParser]:
    """Return the parsers that have no subcommands, such as `run` and `rostopic echo`."""
    return dict(_leaves("", whole()))


@functools.cache
def whole() -> CommandParser:
    """Return the parser of all commands, which takes a tenth of a second to make."""
    return parser_for([])


def _leaves(words: str, parser: CommandParser) -> Iterator[tuple[str, CommandParser]]:
    below = [action for action in parser._actions if isinstance(action, argparse._SubParsersAction)]
    if not below:
        yield words, parser
    for action in below:
        for name, each in action.choices.items():
            yield from _leaves(f"{words} {name}".strip(), each)


def options(parser: argparse.ArgumentParser) -> list[argparse.Action]:
    """Return its options, except for --help and the arguments passed on to a tool of ROS."""
    return [action for action in parser._actions if action.option_strings and action.dest not in ("help", "handed")]

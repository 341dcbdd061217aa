"""`--json FILE|-`: what a command found, for programs, in a file or alone on standard output.

A command prints its text and writes its JSON; with `-` the text goes nowhere, so that no command needs to ask. It is
the same with every other option that takes `FILE|-`.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import sys
from collections.abc import Callable, Iterator
from typing import Any, Literal, TextIO

from cfepy.cli.user_notes import check_writable, writing
from cfepy.writing.escapes import for_data

STDOUT = "-"
_MAY_BE_STDOUT = ("json", "csv", "sarif", "yaml", "output", "dot", "svg")


@contextlib.contextmanager
def standard_output(arguments: argparse.Namespace) -> Iterator[None]:
    """Around a command: standard output is for the option that takes it with `-`, and only for it.

    Args:
        arguments: of the command line; gets `stdout`, the standard output. What is written there is as it is in a
            file, but a terminal gets no control characters.
    """
    arguments.stdout = for_data(sys.stdout)
    if not any(getattr(arguments, name, None) == STDOUT for name in _MAY_BE_STDOUT):
        yield
        return
    with open(os.devnull, "w", encoding="utf-8", errors="replace") as nowhere, contextlib.redirect_stdout(nowhere):
        yield


def check_json(arguments: argparse.Namespace) -> None:
    """That the file can be written is better known before a run than after it.

    Raises:
        UsageError: it cannot.
    """
    if arguments.json not in (None, STDOUT):
        check_writable(arguments.json, "--json")


def write_json(arguments: argparse.Namespace, value: Any, indent: int | None = 2) -> None:
    """Write what a command found, if the command line asks for it.

    Args:
        arguments: of the command line.
        value: plain data.
        indent: of a level; None for all in one line.

    Raises:
        UsageError: the file could not be written.
    """
    if arguments.json is None:
        return
    write_text(arguments.json, json_text(value, indent) + "\n", "--json", arguments)


def json_text(value: Any, indent: int | None = None, default: Callable[[Any], Any] | None = None) -> str:
    """Plain data as JSON without a control character: DEL, which JSON lets pass, is an escape as all others are.

    Args:
        value: the data.
        indent: see `write_json`.
        default: makes plain data of what is not.
    """
    import json

    return json.dumps(value, indent=indent, default=default).replace("\x7f", "\\u007f")


def write_text(file: str, text: str, option: str, arguments: argparse.Namespace) -> None:
    """Write a text.

    Args:
        file: its path, or `-` for standard output.
        text: the text.
        option: that named the file.
        arguments: of the command line.

    Raises:
        UsageError: it could not be written.
    """
    with _opened(file, "w", option, arguments) as stream:
        stream.write(text)


@contextlib.contextmanager
def json_lines(arguments: argparse.Namespace) -> Iterator[TextIO | None]:
    """Around what writes a line of JSON again and again: where to; None when the command line does not ask for it.

    Raises:
        UsageError: the file could not be written.
    """
    if arguments.json is None:
        yield None
        return
    with _opened(arguments.json, "w", "--json", arguments) as stream:
        yield stream


@contextlib.contextmanager
def _opened(file: str, mode: Literal["w", "a"], option: str, arguments: argparse.Namespace) -> Iterator[TextIO]:
    if file == STDOUT:
        stream: TextIO = arguments.stdout
        yield stream
        stream.flush()
        return
    with writing(file, option), open(file, mode, encoding="utf-8") as opened:
        yield opened

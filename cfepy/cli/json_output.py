"""`--json FILE|-`: the findings of a command, for programs, in a file or alone on standard output.

A command prints its text and writes its JSON. With `-` the text is discarded, so that a command does not need to check
for it. The same holds for every other option that takes `FILE|-`.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import sys
from collections.abc import Callable, Iterator
from typing import Any, Literal, TextIO

from cfepy.cli.user_notes import check_writable, writing
from cfepy.status import UsageError
from cfepy.writing.escapes import for_data

STDOUT = "-"
_MAY_BE_STDOUT = ("json", "csv", "junit", "sarif", "yaml", "output", "dot", "svg")


@contextlib.contextmanager
def standard_output(arguments: argparse.Namespace) -> Iterator[None]:
    """Reserve standard output for the option that was given as `-`, while a command runs.

    Args:
        arguments: the command line; its attribute `stdout` is set to the standard output. Data is written there
            unchanged as to a file, except that a terminal gets no control characters.
    """
    arguments.stdout = for_data(sys.stdout)
    if not _takes_stdout(arguments):
        yield
        return
    with open(os.devnull, "w", encoding="utf-8", errors="replace") as nowhere, contextlib.redirect_stdout(nowhere):
        yield


def _takes_stdout(arguments: argparse.Namespace) -> bool:
    """Return whether an option was given as `-`."""
    return any(getattr(arguments, name, None) == STDOUT for name in _MAY_BE_STDOUT)


def check_json(arguments: argparse.Namespace) -> None:
    """Check before a run that the file can be written.

    Raises:
        UsageError: it cannot be written.
    """
    if arguments.json not in (None, STDOUT):
        check_writable(arguments.json, "--json")


def check_ci_outputs(arguments: argparse.Namespace) -> None:
    """Check before a run that the files for continuous integration can be written; see `cfepy.cli.ci_outputs`.

    Raises:
        UsageError: one cannot be written, or two outputs go to standard output.
    """
    if arguments.github and _takes_stdout(arguments):
        text = "cannot be combined with `-` of another option; both go to standard output"
        raise UsageError(text, field="--github")
    for name in ("junit", "sarif"):
        file = getattr(arguments, name)
        if file not in (None, STDOUT):
            check_writable(file, f"--{name}")


def wants_ci_outputs(arguments: argparse.Namespace) -> bool:
    """Return whether the command line asks for an output of `cfepy.cli.ci_outputs`, which is loaded only then."""
    return bool(arguments.github or arguments.junit or arguments.sarif)


def write_json(arguments: argparse.Namespace, value: Any, indent: int | None = 2) -> None:
    """Write the findings of a command as JSON, if the command line asks for it.

    Args:
        arguments: the command line.
        value: plain data.
        indent: blanks a level; None for all in one line.

    Raises:
        UsageError: the file could not be written.
    """
    if arguments.json is None:
        return
    write_text(arguments.json, json_text(value, indent) + "\n", "--json", arguments)


def json_text(value: Any, indent: int | None = None, default: Callable[[Any], Any] | None = None) -> str:
    """Return plain data as JSON without control characters. DEL, which JSON permits, is escaped like all others.

    Args:
        value: the data.
        indent: see `write_json`.
        default: converts other objects to plain data.
    """
    import json

    return json.dumps(value, indent=indent, default=default).replace("\x7f", "\\u007f")


def write_text(file: str, text: str, option: str, arguments: argparse.Namespace) -> None:
    """Write a text.

    Args:
        file: its path, or `-` for standard output.
        text: the text.
        option: the option that named the file.
        arguments: the command line.

    Raises:
        UsageError: it could not be written.
    """
    with _opened(file, "w", option, arguments) as stream:
        stream.write(text)


@contextlib.contextmanager
def json_lines(arguments: argparse.Namespace) -> Iterator[TextIO | None]:
    """Yield a stream for lines of JSON, or None if the command line does not ask for it.

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

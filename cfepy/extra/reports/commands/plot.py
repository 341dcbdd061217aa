"""`cfepy plot`: values over time as a picture."""

from __future__ import annotations

import argparse
from pathlib import Path

from cfepy.cli.user_notes import check_writable, writing
from cfepy.cli.viewed_runs import look_at_series
from cfepy.extra.reports import Curves, curves_of, picture_of, save
from cfepy.status import UsageError

KINDS = (".png", ".svg", ".pdf")


def run(arguments: argparse.Namespace) -> int:
    """Draw the values that the command line names.

    Returns:
        The exit status.

    Raises:
        UsageError: there is no such run, message or field, it cannot be drawn, or the file cannot be written.
    """
    path = Path(arguments.output)
    if path.suffix.lower() not in KINDS:
        raise UsageError(
            f"must be a picture with a name that ends with {', '.join(KINDS)}", file=path, field="--output"
        )
    picture_of([[]])  # fail before a long run if matplotlib is not installed
    check_writable(path, "--output")
    series, status = look_at_series(arguments, arguments.names)
    found = [curves for word in arguments.names for curves in curves_of(series, word, arguments.raw)]
    drawn = [curves.since(arguments.from_s or 0.0) for curves in found]
    if not any(each.changes or any(len(line.times) for line in each.lines) for each in drawn):
        raise UsageError(f"no message was sent after {arguments.from_s:g} s", field="--from")
    title = Path(arguments.source).stem if arguments.title is None else arguments.title
    picture = picture_of(_axes(drawn, arguments.subplots), title=title, size=arguments.size)
    with writing(path, "--output"):
        save(picture, path)
    print(f"{path}: {sum(len(each.lines) for each in drawn)} lines")
    return status


def _axes(drawn: list[Curves], is_apart: bool) -> list[list[Curves]]:
    return [[each] for each in drawn] if is_apart else [drawn]

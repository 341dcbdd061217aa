"""`cfepy diff`: the first difference between two runs, and a summary of the others."""

from __future__ import annotations

import argparse
import contextlib
import sys
from collections import deque
from collections.abc import Iterator, Mapping
from io import TextIOWrapper
from itertools import zip_longest
from pathlib import Path
from typing import Any, TextIO

from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS
from cfepy.cli.run.compared_run import ComparedRun
from cfepy.cli.run.compared_runs import FirstDifference, facts_of, failure, show_sides, started
from cfepy.journal import Journal, differences, is_journal, read_journal
from cfepy.pilot import SUDDEN
from cfepy.pilot.determinism import RunEndedError, first_parting
from cfepy.pilot.determinism_look import Look
from cfepy.reading.input_files import open_input
from cfepy.status import UsageError

MOST_FIELDS = 12


def compare_texts(one: str, other: str, before: int, stream: TextIO) -> bool:
    """Compare two traces.

    Args:
        one: path of the first.
        other: path of the second.
        before: number of lines to show before the first difference.
        stream: the output.

    Returns:
        True if they are equal.

    Raises:
        UsageError: one is not UTF-8 text.
    """
    latest: deque[str] = deque(maxlen=before)
    count = 0
    with _lines(one) as first, _lines(other) as second:
        for mine, theirs in zip_longest(_texts(first, one), _texts(second, other), fillvalue=""):
            count += 1
            if mine != theirs:
                _show(count, latest, {one: mine, other: theirs}, stream)
                return False
            latest.append(mine)
    if not count:
        print("nothing to compare: both files are empty", file=stream)
        return False
    print(f"the same run: all {count:,} lines are alike", file=stream)
    return True


def _lines(file: str) -> TextIO:
    return TextIOWrapper(open_input(file, handed=True), encoding="utf-8")


def _texts(lines: TextIO, file: str) -> Iterator[str]:
    try:
        yield from lines
    except UnicodeDecodeError:
        raise UsageError("is not a journal or a trace", file=file) from None


def _show(number: int, before: deque[str], sides: dict[str, str], stream: TextIO) -> None:
    print(f"the first {number - 1:,} lines are alike; line {number:,} differs", file=stream)
    if before:
        print("\nbefore it, in both:", file=stream)
        stream.writelines(f"  {line}" for line in before)
    for path, line in sides.items():
        print(f"\n{path}\n  {line.rstrip() or 'the run is over'}", file=stream)


def run(arguments: argparse.Namespace) -> int:
    """Compare the two runs that the command line names.

    Returns:
        The exit status.

    Raises:
        UsageError: a file is neither a journal nor a trace, or one of each kind.
    """
    paths = (arguments.one, arguments.other)
    if arguments.lines < 0:
        raise UsageError(f"must be 0 or more, not {arguments.lines}", field="--lines")
    kinds = {_is_journal(path) for path in paths}
    if len(kinds) > 1:
        raise UsageError("cannot compare a journal with a trace; give two journals, or two files of --trace")
    if not kinds.pop():
        return ENDED_WELL if compare_texts(*paths, arguments.lines, sys.stdout) else FOUND_PROBLEMS
    return _Comparison(read_journal(paths[0]), read_journal(paths[1]), arguments.lines).run()


def _is_journal(path: str) -> bool:
    try:
        return is_journal(path)
    except OSError as error:
        raise UsageError(f"cannot be read: {error.strerror}", file=path) from None


class _Comparison:
    """Compares two journals by replaying both."""

    def __init__(self, one: Journal, other: Journal, lines: int) -> None:
        self._journals = (one, other)
        self._lines = lines

    def run(self) -> int:
        """Compare, and print the findings. Returns the exit status."""
        one, other = self._journals
        for line in differences(one, other):
            print(line)
        if one.end is not None and other.end is not None and one.end.trace == other.end.trace != "":
            is_same = one.end.results == other.end.results and one.end.beside == other.end.beside
            what = "the same run" if is_same else "the same trace"
            print(f"{what}: all {one.end.records:,} records are alike\ntrace: {one.end.trace}")
            if not is_same:
                print("but the numbers of the report differ; compare them with cfepy replay --json")
            return ENDED_WELL if is_same else FOUND_PROBLEMS
        index, agreed = self._first_difference()
        if index is None:
            print(f"all {agreed:,} records that can be replayed are alike" if agreed else "nothing was compared")
            return self._without_difference()
        facts = [self._facts(each, index) for each in self._journals]
        looks = (Look.from_dict(facts[0]), Look.from_dict(facts[1]))
        print(f"\nthe first {index:,} records are alike; record {index:,} differs (counted from 0)")
        show_sides(FirstDifference((one.path, other.path), index, looks), sys.stdout)
        _show_fields(facts[0]["fields"], facts[1]["fields"])
        return FOUND_PROBLEMS

    def _first_difference(self) -> tuple[int | None, int]:
        with contextlib.ExitStack() as stack:
            runs = [stack.enter_context(started(_plan(each))) for each in self._journals]
            try:
                parting, agreed = first_parting([run.reader for run in runs])
            except RunEndedError:
                raise failure(runs) from None
            return (None if parting is None else parting.index), agreed

    def _facts(self, journal: Journal, index: int) -> dict[str, Any]:
        """Return the facts that a replay shows at a record."""
        with started(_plan(journal, index, self._lines)) as run:
            return facts_of(run)

    def _without_difference(self) -> int:
        """Report replays without a difference. Then the journals are equal too, unless a replay deviates from its
        recording.
        """
        cut_off = [journal.path for journal in self._journals if journal.end is None]
        if cut_off:  # the replays may deviate from the recordings after the ends of the journals
            text = "is truncated: its run" if len(cut_off) == 1 else "are truncated: their runs"
            print(f"{' and '.join(cut_off)} {text} may have gone on otherwise")
            return FOUND_PROBLEMS
        if all(journal.end is not None and journal.end.reason in SUDDEN for journal in self._journals):
            return ENDED_WELL  # the run was stopped in the middle of a task, and there is nothing to compare after that
        print("but the recorded runs differ: a replay deviates from its recording; `cfepy replay` reports where")
        return FOUND_PROBLEMS


def _show_fields(one: Mapping[str, str], other: Mapping[str, str]) -> None:
    """Print the fields in which two packets differ, among the fields that both have."""
    names = [name for name in one if name in other and one[name] != other[name]]
    if names:
        print("\nfields that differ:")
    for name in names[:MOST_FIELDS]:
        print(f"  {name}: {one[name]}, {other[name]}")
    if len(names) > MOST_FIELDS:
        print(f"  and {len(names) - MOST_FIELDS} more")


def _plan(journal: Journal, look_at: int | None = None, lines: int = 0) -> ComparedRun:
    return ComparedRun(journal=str(Path(journal.path).resolve()), look_at=look_at, lines=lines)

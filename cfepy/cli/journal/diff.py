"""`cfepy diff`: the first difference between two runs, and a summary of the others."""

from __future__ import annotations

import argparse
import contextlib
import sys
from collections import deque
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from io import TextIOWrapper
from itertools import accumulate, zip_longest
from pathlib import Path
from typing import Any, TextIO

from cfepy import trace as tr
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS
from cfepy.cli.run.compared_run import ComparedRun
from cfepy.cli.run.compared_runs import FirstDifference, facts_of, failure, show_sides, started
from cfepy.cli.run.record_event import RecordEvent, difference_lines, is_message, line_difference, value_texts
from cfepy.journal import Journal, differences, is_journal, read_journal
from cfepy.msg import CMD_HEADER_SIZE, PRIMARY_HEADER_SIZE, TLM_HEADER_SIZE
from cfepy.pilot import SUDDEN, RecordReader, RunEndedError
from cfepy.pilot.determinism import first_parting
from cfepy.pilot.determinism_look import Look
from cfepy.reading.input_files import open_input
from cfepy.status import UsageError

DEFAULT_LINES = 6
Decoded = tuple[str, Mapping[str, str]]
"""The name of a message and its fields."""
MOST_TOPICS = 12
MOST_BYTES = 40_000  # of messages that are decoded, because they go through a command line
_COMMAND, _HAS_SECONDARY = 0x10, 0x08  # bits of the first byte of a packet


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
    for text in line_difference(list(sides.items())):
        print(f"  {text}", file=stream)
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
    if arguments.lines is not None and arguments.lines < 0:
        raise UsageError(f"must be 0 or more, not {arguments.lines}", field="--lines")
    kinds = {_is_journal(path) for path in paths}
    if len(kinds) > 1:
        raise UsageError("cannot compare a journal with a trace; give two journals, or two files of --trace")
    if not kinds.pop():
        before = DEFAULT_LINES if arguments.lines is None else arguments.lines
        return ENDED_WELL if compare_texts(*paths, before, sys.stdout) else FOUND_PROBLEMS
    return _Comparison(read_journal(paths[0]), read_journal(paths[1]), arguments.lines).run()


def _is_journal(path: str) -> bool:
    try:
        return is_journal(path)
    except OSError as error:
        raise UsageError(f"cannot be read: {error.strerror}", file=path) from None


class _Comparison:
    """Compares two journals by replaying both."""

    def __init__(self, one: Journal, other: Journal, lines: int | None) -> None:
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
        runs = (one.path, other.path)
        index, agreed, topics = self._first_difference()
        if index is None:
            print(f"all {agreed:,} records that can be replayed are alike" if agreed else "nothing was compared")
            return self._without_difference()
        differing = ranked(topics)
        pairs = to_decode(differing)
        facts = [
            self._facts(each, index, [pair[side].hex() for pair in pairs]) for side, each in enumerate(self._journals)
        ]
        events = (RecordEvent(**facts[0]["event"]), RecordEvent(**facts[1]["event"]))
        until = f", until {float(facts[0]['last'].partition(' ')[0]):.6f} s" if index else ""
        print(f"\nthe first {index:,} records are alike{until}; then the runs differ:")
        for line in difference_lines(*events, runs):
            print(f"  {line}")
        if topics:
            print("\nfrom there on, by topic and packet:")
        decoded = [each["decoded"] for each in facts]
        for line in topic_lines(differing, decoded, len(topics) - len(differing), runs):
            print(f"  {line}")
        if self._lines is not None:
            looks = (Look.from_dict(facts[0]), Look.from_dict(facts[1]))
            print(f"\nrecord {index:,} is the first that differs (counted from 0)")
            show_sides(FirstDifference(runs, index, looks), sys.stdout)
        return FOUND_PROBLEMS

    def _first_difference(self) -> tuple[int | None, int, list[TopicDifference]]:
        """Return the number of the first record that differs, the number of equal records, and the differences of all
        messages after it.
        """
        with contextlib.ExitStack() as stack:
            runs = [stack.enter_context(started(_plan(each))) for each in self._journals]
            readers = [run.reader for run in runs]
            try:
                parting, agreed = first_parting(readers)
            except RunEndedError:
                raise failure(runs) from None
            topics = [] if parting is None else list(rest_of(readers).values())
            return (None if parting is None else parting.index), agreed, topics

    def _facts(self, journal: Journal, index: int, decode: Sequence[str]) -> dict[str, Any]:
        """Return the facts that a replay shows at a record, with the names and fields of other records."""
        lines = DEFAULT_LINES if self._lines is None else self._lines
        with started(_plan(journal, index, lines, decode)) as run:
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


def _plan(journal: Journal, look_at: int | None = None, lines: int = 0, decode: Sequence[str] = ()) -> ComparedRun:
    place = str(Path(journal.path).resolve())
    return ComparedRun(journal=place, look_at=look_at, lines=lines, decode=tuple(decode))


# -- messages after the first difference -------------------------------------------------------------------------------
# The n-th message of a topic in one run is compared with the n-th in the other, by its contents without its header.


@dataclass(slots=True)
class TopicDifference:
    """The messages of a topic or packet after the first difference.

    Attributes:
        counts: numbers of messages in the two runs.
        other: number of pairs with different contents.
        pair: the first such pair, two records; before there is one, a message twice.
    """

    counts: list[int] = field(default_factory=lambda: [0, 0])
    other: int = 0
    pair: tuple[bytes, bytes] = (b"", b"")
    _waiting: tuple[deque[bytes], deque[bytes]] = field(default_factory=lambda: (deque(), deque()))

    def add(self, side: int, record: bytes) -> None:
        """Add a message of run 0 or 1."""
        if not any(self.counts):
            self.pair = (record, record)
        self.counts[side] += 1
        mine, theirs = self._waiting[side], self._waiting[1 - side]
        if not theirs:
            mine.append(record)
            return
        pair = (record, theirs.popleft()) if side == 0 else (theirs.popleft(), record)
        if _contents(pair[0]) != _contents(pair[1]):
            self.pair = self.pair if self.other else pair
            self.other += 1

    @property
    def is_same(self) -> bool:
        """Whether both runs have the same messages."""
        return not self.other and self.counts[0] == self.counts[1]


def _contents(record: bytes) -> bytes:
    if record[:1] == tr.UNSENT:
        topic, _, packet = record[1:].partition(b"\0")
        return packet if topic or not packet else _contents(packet)
    if not record[0] & _HAS_SECONDARY:
        return record[PRIMARY_HEADER_SIZE:]
    return record[CMD_HEADER_SIZE if record[0] & _COMMAND else TLM_HEADER_SIZE :]


def rest_of(runs: Sequence[RecordReader]) -> dict[bytes, TopicDifference]:
    """Read two runs to their ends.

    Args:
        runs: the runs, at their first difference.

    Returns:
        The difference of each topic or packet, by MsgId or topic.
    """
    found: dict[bytes, TopicDifference] = {}
    is_going_on = True
    while is_going_on:
        is_going_on = False
        for side, run in enumerate(runs):
            try:
                run.fill()
            except RunEndedError:
                continue
            is_going_on |= bool(run.pending)
            for record in run.pending:
                if is_message(record):
                    found.setdefault(_key(record), TopicDifference()).add(side, record)
            run.pending.clear()
    return found


def _key(record: bytes) -> bytes:
    if record[:1] != tr.UNSENT:
        return record[:2]
    topic, _, packet = record[1:].partition(b"\0")
    return topic or packet[:2]


def ranked(topics: Iterable[TopicDifference]) -> list[TopicDifference]:
    """Return the topics that differ: those with other values first, then those with other numbers of messages."""
    return sorted((each for each in topics if not each.is_same), key=lambda each: (not each.other, -each.other))


def to_decode(topics: Sequence[TopicDifference]) -> list[tuple[bytes, bytes]]:
    """Return the pairs of the first topics, as many as a command line can hold."""
    sizes = accumulate(len(each.pair[0]) + len(each.pair[1]) for each in topics)
    return [each.pair for each, size in zip(topics[:MOST_TOPICS], sizes, strict=False) if size <= MOST_BYTES]


def topic_lines(
    ranked: Sequence[TopicDifference], decoded: Sequence[Sequence[Decoded]], same: int, runs: tuple[str, str]
) -> Iterator[str]:
    """Yield a line for each topic or packet that differs, and a line about the others.

    Args:
        ranked: the topics that differ, the most important first.
        decoded: for each run, name and fields of the messages in the pairs of the first of these topics.
        same: number of topics that do not differ.
        runs: the names of the runs.
    """
    for each, (name, one_values), (_, other_values) in zip(ranked, *decoded, strict=False):
        one, other = each.counts
        parts = [f"{one} messages in {runs[0]}, {other} in {runs[1]}"] if one != other else []
        if each.other:
            parts.append(f"{each.other} of {min(one, other)} with other values")
            values = value_texts(one_values, other_values)
            parts += [f"the first: {'; '.join(values)}"] if values else []
        way = " (not over the bus)" if each.pair[0][:1] == tr.UNSENT else ""
        yield f"{name}{way}: {', '.join(parts)}"
    if len(ranked) > len(decoded[0]):
        yield f"and {len(ranked) - len(decoded[0])} more"
    if same:
        others = ("other" if same == 1 else "others") if ranked else ("topic" if same == 1 else "topics and packets")
        yield f"{same} {others}: the same values"

"""`cfepy trace`: everything that happened in a run, as lines of text or as a file for Perfetto."""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Callable, Sequence
from fnmatch import fnmatchcase
from typing import TextIO

from cfepy.attachment import Attachment
from cfepy.cli.trace_text import TraceText
from cfepy.cli.user_notes import writing
from cfepy.cli.viewed_runs import look_at
from cfepy.mission import Mission
from cfepy.status import UsageError
from cfepy.trace import TimedRecords, Trace
from cfepy.units import NS_PER_S

_SEND = re.compile(r"send (0x[0-9A-F]{4}) (?:(.+) )?sequence \d+ length \d+")


class Lines(Attachment):
    """Prints the trace while the mission runs.

    Args:
        stream: the output.
        wanted: selects records by virtual time in ns, the task's name, and the event.

    Attributes:
        count: lines so far.
        error: the error of writing. It is kept here because host errors must not be raised inside the simulation.
    """

    def __init__(self, stream: TextIO, wanted: Callable[[int, str, str], bool]) -> None:
        self.count = 0
        self.error: OSError | None = None
        self._stream = stream
        self._wanted = wanted
        self._text = TraceText()

    def begin(self, mission: Mission) -> None:
        self._text.watch(mission)
        mission.trace.also(self._take)

    def _take(self, records: Sequence[bytes]) -> None:
        if self.error is not None:
            return
        text = self._text
        try:
            for line in text.lines(records):
                what = line.split(" ", 1)[1].removeprefix(f"{text.task} ")
                if self._wanted(text.now_ns, text.task, what):
                    self.count += 1
                    self._stream.write(f"{line}\n")
        except OSError as error:
            self.error = error


def run(arguments: argparse.Namespace) -> int:
    """Print or write the trace of the run that the command line names.

    Returns:
        The exit status.

    Raises:
        UsageError: there is no such run, or the file cannot be written.
    """
    if arguments.perfetto is not None:
        return _write(arguments, arguments.perfetto)
    lines = Lines(sys.stdout, _filter(arguments))
    looked_at = look_at(arguments, [lines], trace=Trace(records=TimedRecords()))
    if lines.error is not None:
        raise lines.error
    if not lines.count:
        print("cfepy: no matching record in the trace", file=sys.stderr)
    return looked_at.status()


def _write(arguments: argparse.Namespace, path: str) -> int:
    """Write the file for Perfetto, which has the whole run."""
    for name, option in (("from_s", "--from"), ("task", "--task"), ("topic", "--topic")):
        if getattr(arguments, name):
            raise UsageError("cannot be combined with --perfetto; a Perfetto trace is always complete", field=option)
    from cfepy.extra.reports import PerfettoTrace

    with writing(path, "--perfetto"), open(path, "w", encoding="utf-8") as file:
        trace = PerfettoTrace(file)
        looked_at = look_at(arguments, [trace])
        if trace.error is not None:
            raise trace.error
    print(f"{path}: open it in https://ui.perfetto.dev")
    return looked_at.status()


def _filter(arguments: argparse.Namespace) -> Callable[[int, str, str], bool]:
    """Make the filter of records that the command line asks for."""
    from_ns = round((arguments.from_s or 0) * NS_PER_S)
    until_ns = None if arguments.until is None else round(arguments.until * NS_PER_S)
    tasks, topics = arguments.task, arguments.topic

    def wanted(now_ns: int, task: str, what: str) -> bool:
        if now_ns < from_ns or (until_ns is not None and now_ns > until_ns):
            return False
        if tasks and not _matches(task, tasks):
            return False
        return not topics or _is_sent(what, topics)

    return wanted


def _is_sent(what: str, topics: Sequence[str]) -> bool:
    match = _SEND.fullmatch(what)
    return match is not None and (_matches(match[1], topics) or _matches(match[2] or "", topics))


def _matches(name: str, patterns: Sequence[str]) -> bool:
    return any(fnmatchcase(name, pattern) for pattern in patterns)

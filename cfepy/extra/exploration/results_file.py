"""The results of a campaign in a file: JSON, a line a verdict behind a line that says which campaign it is.

Behind the verdicts there is a line for each distinct failure, with the shortest schedule that is known to show it.

Lines are only ever added, each in one write, as verdicts come in. Whatever ends the process in the middle of a write
leaves half a line at the end, which the next run cuts off; then it goes on with what is missing.
"""

from __future__ import annotations

import json
import os
from array import array
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, BinaryIO

from cfepy.extra.exploration.verdict import Verdict
from cfepy.interpreter.host_system import lock_file
from cfepy.reading.input_files import open_input
from cfepy.schedules import Schedule
from cfepy.status import UsageError

FORMAT = "cfepy exploration 1"
OPTION = "--results"
SHOWN = 5  # differences between two campaigns
_MISSING = 0  # no verdict starts where the first line is


class ResultsFile:
    """A results file that this process writes; no other process can until it is closed.

    Args:
        path: of the file; it is made when it is not there.
        identity: what makes the campaign, as plain data. A file of another one is refused.

    Raises:
        UsageError: the file is no results file, belongs to another campaign, is in use, or cannot be written.
    """

    def __init__(self, path: str | Path, identity: Mapping[str, Any]) -> None:
        self.path = Path(path)
        self._starts = array("Q")  # by number of the schedule: where in the file its verdict is
        self._end = 0
        self._file = self._open()
        try:
            self._lock()
            self._read(json.loads(json.dumps(identity)))
        except BaseException:
            self.close()
            raise

    def __len__(self) -> int:
        """How many verdicts there are."""
        return len(self._starts) - self._starts.count(_MISSING)

    def verdict(self, number: int) -> dict[str, Any] | None:
        """The verdict on the schedule of this number, as plain data; None when there is none yet."""
        start = self._starts[number] if number < len(self._starts) else _MISSING
        if start == _MISSING:
            return None
        self._file.seek(start)
        found: dict[str, Any] = json.loads(self._file.readline())["verdict"]
        return found

    def append(self, number: int, verdict: Mapping[str, Any]) -> None:
        """Keep a verdict.

        Args:
            number: of the schedule in the campaign, from 0.
            verdict: as plain data.

        Raises:
            UsageError: it cannot be written any more, since the disk is full.
        """
        start = self._end
        self._write({"number": number, "verdict": verdict})
        self._remember(number, start)

    def close(self) -> None:
        """Let others write the file."""
        with suppress(OSError):  # what could not be written was told then
            self._file.close()

    def _open(self) -> Any:
        try:
            descriptor = os.open(
                self.path, os.O_RDWR | os.O_CREAT | getattr(os, "O_CLOEXEC", 0) | getattr(os, "O_BINARY", 0), 0o666
            )
            return os.fdopen(descriptor, "r+b")
        except OSError as error:
            raise UsageError(f"cannot be written: {error.strerror}", file=self.path, field=OPTION) from None

    def _lock(self) -> None:
        try:
            lock_file(self._file.fileno())
        except OSError:
            text = "is being written by another cfepy process; wait for it, or name another file"
            raise UsageError(text, file=self.path, field=OPTION) from None

    def _read(self, identity: dict[str, Any]) -> None:
        for line, (start, record) in enumerate(whole_lines(self._file, self.path), 1):
            if start == 0:
                _check(record, identity, self.path)
            else:
                self._take_in(record, start, line)
            self._end = self._file.tell()
        self._file.truncate(self._end)
        if self._end == 0:
            self._write({"format": FORMAT, "campaign": identity})

    def _take_in(self, record: dict[str, Any], start: int, line: int) -> None:
        if is_failure(record):
            return
        number, _ = _numbered(record, self.path, line)
        self._remember(number, start)

    def _remember(self, number: int, start: int) -> None:
        if number >= len(self._starts):
            self._starts.extend([_MISSING] * (number + 1 - len(self._starts)))
        self._starts[number] = start

    def _write(self, record: Mapping[str, Any]) -> None:
        data = json.dumps(record, separators=(",", ":")).encode() + b"\n"
        try:
            self._file.seek(self._end)
            self._file.write(data)
            self._file.flush()
        except OSError as error:
            raise UsageError(f"could not be written: {error.strerror}", file=self.path, field=OPTION) from None
        self._end += len(data)


def whole_lines(file: Any, path: Path) -> Iterator[tuple[int, dict[str, Any]]]:
    """The records of a results file, each with where it starts; half a line at the end is left out.

    Args:
        file: open for reading bytes.
        path: its name, for errors.

    Raises:
        UsageError: a line is not a record.
    """
    file.seek(0)
    line, start = 0, 0
    while (data := file.readline()).endswith(b"\n"):
        line += 1
        try:
            record = json.loads(data)
        except (ValueError, RecursionError):
            record = None
        if not isinstance(record, dict):
            raise _damaged(path, line)
        yield start, record
        start = file.tell()
    if start == 0 and data and not b'{"format":"cfepy '.startswith(data[:17]):
        raise _damaged(path, 1)  # half a first line may be cut off; a file of another kind may not


def is_failure(record: Mapping[str, Any]) -> bool:
    """Whether a line is about a distinct failure."""
    return isinstance(record.get("failure"), dict) and "number" not in record


def keep_failure(path: str | Path, group: str, title: str, schedule: Schedule) -> None:
    """Add a distinct failure to a results file that is whole; the last line about a group counts.

    Args:
        path: of the file.
        group: what failures of this cause have in common.
        title: of the failure, for a person.
        schedule: the shortest one that is known to show it.

    Raises:
        UsageError: it cannot be written.
    """
    record = {"failure": {"group": group, "title": title, "schedule": schedule.text()}}
    try:
        with Path(path).open("ab") as file:
            file.write(json.dumps(record, separators=(",", ":")).encode() + b"\n")
    except OSError as error:
        raise UsageError(f"could not be written: {error.strerror}", file=path, field=OPTION) from None


def read_failures(path: str | Path) -> dict[str, tuple[str, Schedule]]:
    """The distinct failures of a results file: by group the title, and a schedule that shows it.

    These are those that the campaign told, with the shortest schedule, or, where it did not come to that, those of its
    verdicts.

    Raises:
        UsageError: it is no results file, or cannot be read.
    """
    path = Path(path)
    told: dict[str, tuple[str, Schedule]] = {}
    seen: dict[str, tuple[str, Schedule]] = {}
    with _opened(path) as file:
        for line, (_, record) in enumerate(whole_lines(file, path), 1):
            if is_failure(record):
                told |= _told_failure(record["failure"], path, line)
            elif line > 1:
                _, plain = _numbered(record, path, line)
                verdict = Verdict.from_dict(plain)
                for failure in verdict.failures[:1]:
                    seen.setdefault(failure.group, (failure.title, verdict.schedule))
    return told or seen


def _told_failure(plain: dict[str, Any], path: Path, line: int) -> dict[str, tuple[str, Schedule]]:
    group, title, text = (plain.get(each) for each in ("group", "title", "schedule"))
    if not (isinstance(group, str) and isinstance(title, str) and isinstance(text, str)):
        raise _damaged(path, line)
    return {group: (title, Schedule.parse(text))}


def read_results(path: str | Path) -> tuple[dict[str, Any], Iterator[tuple[int, dict[str, Any]]]]:
    """Read a results file, also one that is being written.

    Returns:
        What makes the campaign, and (number, verdict) for all verdicts in the order in which they came in.

    Raises:
        UsageError: it is no results file, or cannot be read.
    """
    path = Path(path)
    lines = whole_lines(_opened(path), path)
    head = next(lines, (0, {}))[1]
    if head.get("format") != FORMAT:
        raise _foreign(path)
    if not isinstance(head.get("campaign"), dict):
        raise _damaged(path, 1)
    return head["campaign"], _verdicts(path, lines)


def _verdicts(path: Path, lines: Iterator[tuple[int, dict[str, Any]]]) -> Iterator[tuple[int, dict[str, Any]]]:
    for line, (_, record) in enumerate(lines, 2):
        if not is_failure(record):
            yield _numbered(record, path, line)


def _numbered(record: Mapping[str, Any], path: Path, line: int) -> tuple[int, dict[str, Any]]:
    number, verdict = record.get("number"), record.get("verdict")
    if not isinstance(number, int) or number < 0 or not isinstance(verdict, dict):
        raise _damaged(path, line)
    return number, verdict


def _opened(path: Path) -> BinaryIO:
    try:
        return open_input(path, handed=True)
    except OSError as error:
        raise UsageError(f"cannot be read: {error.strerror}", file=path) from None


def _check(head: dict[str, Any], identity: dict[str, Any], path: Path) -> None:
    if head.get("format") != FORMAT:
        raise _foreign(path)
    before, now = dict(_flat(head.get("campaign"))), dict(_flat(identity))
    parts = [
        f"{name or 'campaign'} was {before.get(name, 'not given')}, is {now.get(name, 'not given')}"
        for name in sorted({*before, *now})
        if before.get(name) != now.get(name)
    ]
    if parts:
        more = [f"and {len(parts) - SHOWN} more"] if len(parts) > SHOWN else []
        told = "; ".join(parts[:SHOWN] + more)
        text = f"contains the results of another campaign ({told}); name another file, or delete this one"
        raise UsageError(text, file=path, line=1, field=OPTION)


def _flat(value: Any, name: str = "") -> Iterator[tuple[str, str]]:
    """Every plain value in nested mappings under its path: plan.seed, 3."""
    if isinstance(value, dict) and value:
        for key, inner in value.items():
            yield from _flat(inner, f"{name}.{key}" if name else key)
    else:
        yield name, json.dumps(value, ensure_ascii=False)


def _foreign(path: Path) -> UsageError:
    text = f"is not a results file of this version ({FORMAT}); name another file"
    return UsageError(text, file=path, line=1, field=OPTION)


def _damaged(path: Path, line: int) -> UsageError:
    text = "is not a valid line of a results file; name another file, or delete this line and all that follow"
    return UsageError(text, file=path, line=line, field=OPTION)

"""The results of a campaign in a file: JSON lines, the first with the campaign's identity, then one for each verdict.

After the verdicts there is a line for each distinct failure, with the shortest schedule that is known to show it. Lines
are only added, each in one write, as verdicts arrive. If the process ends in the middle of a write, half a line is left
at the end. The next run cuts it off and goes on with the missing verdicts.
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
from cfepy.reading.input_files import open_input, unreadable, unwritable
from cfepy.schedules import Schedule
from cfepy.status import UsageError

FORMAT = "cfepy exploration 1"
OPTION = "--results"
SHOWN = 5  # differences between two campaigns
_MISSING = 0  # no verdict starts where the first line is


class ResultsFile:
    """A results file that this process writes. No other process can write it until it is closed.

    Args:
        path: of the file; it is made if it does not exist.
        identity: the campaign's identity, as plain data. A file of another campaign is refused.

    Raises:
        UsageError: the file is not a results file, belongs to another campaign, is in use, or cannot be written.
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
        """Return the number of verdicts."""
        return len(self._starts) - self._starts.count(_MISSING)

    def verdict(self, number: int) -> dict[str, Any] | None:
        """Return the verdict on the schedule of this number, as plain data; None if there is none yet."""
        start = self._starts[number] if number < len(self._starts) else _MISSING
        if start == _MISSING:
            return None
        self._file.seek(start)
        found: dict[str, Any] = json.loads(self._file.readline())["verdict"]
        return found

    def append(self, number: int, verdict: Mapping[str, Any]) -> None:
        """Write a verdict.

        Args:
            number: of the schedule in the campaign, from 0.
            verdict: as plain data.

        Raises:
            UsageError: it cannot be written, for example because the disk is full.
        """
        start = self._end
        self._write({"number": number, "verdict": verdict})
        self._remember(number, start)

    def close(self) -> None:
        """Close the file, so that other processes can write it."""
        with suppress(OSError):  # a failed write has already raised an error
            self._file.close()

    def _open(self) -> Any:
        try:
            descriptor = os.open(
                self.path, os.O_RDWR | os.O_CREAT | getattr(os, "O_CLOEXEC", 0) | getattr(os, "O_BINARY", 0), 0o666
            )
            return os.fdopen(descriptor, "r+b")
        except OSError as error:
            raise unwritable(self.path, error, OPTION) from None

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
    """Yield the records of a results file, each with its position; half a line at the end is left out.

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
    """Return True if a line is about a distinct failure."""
    return isinstance(record.get("failure"), dict) and "number" not in record


def keep_failure(path: str | Path, group: str, title: str, schedule: Schedule) -> None:
    """Add a distinct failure to a complete results file. The last line about a group counts.

    Args:
        path: of the file.
        group: the group that failures of this cause share.
        title: of the failure, for the user.
        schedule: the shortest schedule that is known to show it.

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
    """Return the distinct failures of a results file: by group the title, and a schedule that shows it.

    These are the failures that the campaign reported, with the shortest schedule. If it did not get that far, they are
    the failures of its verdicts.

    Raises:
        UsageError: the file is not a results file, or cannot be read.
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
    """Read a results file, also while it is being written.

    Returns:
        The campaign's identity, and (number, verdict) for all verdicts in the order in which they arrived.

    Raises:
        UsageError: the file is not a results file, or cannot be read.
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
        raise unreadable(path, error) from None


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
    """Yield every plain value in nested mappings under its path: plan.seed, 3."""
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

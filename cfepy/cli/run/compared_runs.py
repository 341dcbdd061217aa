"""Runs in processes of their own: they are compared record by record, and the first difference is shown as text."""

from __future__ import annotations

import contextlib
import dataclasses
import os
import re
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import zip_longest
from typing import IO, Any, TextIO

from cfepy.cli.run.compared_run import ComparedRun
from cfepy.interpreter.child_pipes import number_of, popen_options
from cfepy.pilot.determinism import RecordReader, RunEndedError
from cfepy.pilot.determinism_look import Line, Look, suspects
from cfepy.reading.resources import import_path, python_command
from cfepy.status import UsageError

MOST_SUSPECTS = 8
MOST_CONTACTS = 20
MOST_BYTES = 16
_ADDRESS = re.compile(rb"[\w.<]* [\w. ]*at 0x[0-9a-f]{6,16}>?")
"""The default text of an object, which ends with its address."""


@dataclass(frozen=True, slots=True)
class RunInProcess:
    """A run in its process, the reader of its records, and its other output."""

    process: subprocess.Popen[bytes]
    reader: RecordReader
    said: IO[bytes]


@contextlib.contextmanager
def started(asked: ComparedRun, hash_seed: int | None = None) -> Iterator[RunInProcess]:
    """Start a run that is compared, as a context manager.

    Args:
        asked: the run; its pipe is made here.
        hash_seed: PYTHONHASHSEED of the process; None for the value of this process.
    """
    out, into = os.pipe()
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryFile() as said, open(out, "rb") as pipe:
        there = dataclasses.replace(
            asked, pipe=number_of(into), scratch=folder
        )  # the process is killed in the end, and cannot tidy up
        command = [*python_command(), "-m", "cfepy.cli.run.compared_run", there.to_json()]
        environment = {**os.environ, "PYTHONPATH": import_path()}
        if hash_seed is not None:
            environment["PYTHONHASHSEED"] = str(hash_seed)
        process = subprocess.Popen(command, env=environment, stdout=said, stderr=said, **popen_options(number_of(into)))
        os.close(into)
        try:
            yield RunInProcess(process, RecordReader(pipe), said)
        finally:
            process.kill()
            process.wait()


def facts_of(run: RunInProcess) -> dict[str, Any]:
    """Return the facts of a run that looks at one record.

    Raises:
        UsageError: it was not completed.
    """
    try:
        run.reader.fill()
    except RunEndedError:
        raise failure([run]) from None
    return run.reader.facts or {}


def failure(runs: Sequence[RunInProcess]) -> UsageError:
    """Return the error of a run that was not completed."""
    for run in runs:
        if run.process.poll() is None and run.reader.facts is None:
            with contextlib.suppress(subprocess.TimeoutExpired):
                run.process.wait(1)
        if run.process.poll():
            run.said.seek(0)
            text = run.said.read().decode("utf-8", "replace").strip()
            return UsageError(text or f"a run ended with status {run.process.returncode}")
    return UsageError("a compared run ended before it was complete")


@dataclass(frozen=True, slots=True)
class FirstDifference:
    """Two runs, the number of the first record that differs, and the look at it in each."""

    runs: tuple[str, str]
    index: int
    looks: tuple[Look, Look]


def show(found: FirstDifference, cause: str, stream: TextIO) -> None:
    """Write the first difference and its cause.

    Args:
        found: the difference.
        cause: explains the cause.
        stream: the output.
    """
    print(f"\nnot deterministic: record {found.index} is the first that differs", file=stream)
    show_sides(found, stream)
    if found.looks[0].contacts:
        print(file=stream)
        show_contacts(found.looks[0].contacts, stream)
    print(f"\n{cause}", file=stream)
    _suspects(found, stream)


def show_contacts(contacts: Sequence[str], stream: TextIO) -> None:
    """Write accesses to the computer outside the simulation, which may answer otherwise in another run.

    Args:
        contacts: the accesses, as text.
        stream: the output.
    """
    if contacts:
        print("past the simulated computer, where cfepy cannot answer for it:", file=stream)
    for text in contacts[:MOST_CONTACTS]:
        print(f"  {text}", file=stream)
    if len(contacts) > MOST_CONTACTS:
        print(f"  and {len(contacts) - MOST_CONTACTS} more", file=stream)


def show_sides(found: FirstDifference, stream: TextIO) -> None:
    """Write the records before the difference, and the record of each run."""
    one, other = found.looks
    if one.lines[:-1]:
        print("\nbefore it, in both:", file=stream)
        _indented(one.lines[: len(one.lines) - bool(one.record)], stream)
    for run, look in zip(found.runs, found.looks, strict=True):
        print(f"\n{run}", file=stream)
        _side(look, stream)
    if one.record and other.record:
        _bytes(one.record, other.record, stream)


def _side(look: Look, stream: TextIO) -> None:
    if not look.record:
        _indented(["the run is over"], stream)
        return
    _indented(look.lines[-1:], stream)
    culprit = look.culprit
    if culprit is not None:
        _indented([f"made at {_place(culprit)}", f"    {culprit.source}"], stream)
    elif not look.stack:
        _indented(["made by the kernel or a cFE service, outside any program"], stream)
    if len(look.stack) > 1:
        _indented(["stack, outermost first:", *(f"    {_place(line)}: {line.source}" for line in look.stack)], stream)


def _bytes(one: bytes, other: bytes, stream: TextIO) -> None:
    """Write the first bytes that differ, because records with the same text may have different contents."""
    at = next(place for place, (a, b) in enumerate(zip_longest(one, other)) if a != b)
    parts = " and ".join(record[at : at + MOST_BYTES].hex(" ") or "nothing" for record in (one, other))
    print(f"\nthe two records ({len(one)} and {len(other)} bytes) differ from byte {at} on: {parts}", file=stream)
    address = next((found for found in _ADDRESS.finditer(one) if found.start() < at < found.end()), None)
    if address is not None:
        print(
            f"there is an address in a text, {address[0].decode()}: give the object a __repr__ or __str__ of its own",
            file=stream,
        )


def _suspects(found: FirstDifference, stream: TextIO) -> None:
    files = list(dict.fromkeys(file for look in found.looks for file in (*_files(look), *look.files)))
    lines = [suspect for file in files for suspect in suspects(file)]
    if lines:
        print("\nlines worth a look:", file=stream)
    _indented([f"{each.file}:{each.line}: {each.why}: {each.source}" for each in lines[:MOST_SUSPECTS]], stream)


def _files(look: Look) -> list[str]:
    """Return the files of the mission's own code that was being executed."""
    return [line.file for line in look.stack if line == look.culprit]


def _place(line: Line) -> str:
    return f"{line.file}:{line.number} in {line.function}"


def _indented(lines: tuple[str, ...] | list[str], stream: TextIO) -> None:
    for line in lines:
        print(f"  {line}", file=stream)

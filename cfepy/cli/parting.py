"""What a person reads about the first record in which two runs of a mission differ."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import zip_longest
from typing import TextIO

from cfepy.mission.determinism_hints import suspects
from cfepy.mission.determinism_look import Line, Look

MOST_SUSPECTS = 8
MOST_BYTES = 16


@dataclass(frozen=True, slots=True)
class Finding:
    """Two runs, the number of the first record that differs, and what was seen there in each."""

    runs: tuple[str, str]
    index: int
    looks: tuple[Look, Look]


def show(finding: Finding, cause: str, stream: TextIO) -> None:
    """Write it down.

    Args:
        finding: what was found.
        cause: what it hangs on.
        stream: where to.
    """
    print(f"\nnot deterministic: record {finding.index} is the first that differs", file=stream)
    show_sides(finding, stream)
    print(f"\n{cause}", file=stream)
    _suspects(finding, stream)


def show_sides(finding: Finding, stream: TextIO) -> None:
    """Write down what was before the record, and what each run did then."""
    one, other = finding.looks
    if one.lines[:-1]:
        print("\nbefore it, in both:", file=stream)
        _indented(one.lines[: len(one.lines) - bool(one.record)], stream)
    for run, look in zip(finding.runs, finding.looks, strict=True):
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
    """Records that read alike may differ in what they carry."""
    at = next(place for place, (a, b) in enumerate(zip_longest(one, other)) if a != b)
    parts = " and ".join(record[at : at + MOST_BYTES].hex(" ") or "nothing" for record in (one, other))
    print(f"\nthe two records ({len(one)} and {len(other)} bytes) differ from byte {at} on: {parts}", file=stream)


def _suspects(finding: Finding, stream: TextIO) -> None:
    files = list(dict.fromkeys(file for look in finding.looks for file in (*_files(look), *look.files)))
    found = [suspect for file in files for suspect in suspects(file)]
    if found:
        print("\nlines worth a look:", file=stream)
    _indented([f"{each.file}:{each.line}: {each.why}: {each.source}" for each in found[:MOST_SUSPECTS]], stream)


def _files(look: Look) -> list[str]:
    """Files of the mission's own code that was being executed."""
    return [line.file for line in look.stack if line == look.culprit]


def _place(line: Line) -> str:
    return f"{line.file}:{line.number} in {line.function}"


def _indented(lines: tuple[str, ...] | list[str], stream: TextIO) -> None:
    for line in lines:
        print(f"  {line}", file=stream)

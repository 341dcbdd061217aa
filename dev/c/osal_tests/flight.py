"""Fly one of OSAL's tests and count its results."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from cfepy.mission import Mission
from cfepy.writing.console import Console

STARTUP = "CFE_LIB, osaltest, CFE_OsalTest_Init, OSALTEST, 0, 0, 0x0, 0;\n!\n"
LONGEST_S = 600
"""Virtual seconds that a test may take."""
_LINE = re.compile(r"^\[ *(\w+)\] ?(.*)$")
_FAILED = ("FAIL", "TSF", "TTF", "ABORT")


@dataclass
class Segment:
    """A segment of a test."""

    name: str
    counts: Counter[str] = field(default_factory=Counter)
    failures: list[str] = field(default_factory=list)

    @property
    def has_cases(self) -> bool:
        """Whether the segment tested anything. ut_assert also ignores segments that only prepare or clean up."""
        return any(self.counts[kind] for kind in (*_FAILED, "PASS", "MIR", "N/A"))

    @property
    def passes(self) -> bool:
        """Whether nothing failed."""
        return not self.failures


@dataclass
class Result:
    """Results of a test.

    Attributes:
        name: name of the test.
        segments: its segments.
        is_complete: whether it ran to its end.
        lines: the console output.
    """

    name: str
    segments: list[Segment]
    is_complete: bool
    lines: list[str]

    def count(self, kind: str) -> int:
        """Return how many lines of a kind there are, such as PASS."""
        return sum(segment.counts[kind] for segment in self.segments)


def read(name: str, lines: list[str]) -> Result:
    """Return the result that a console shows."""
    segments: list[Segment] = []
    is_complete = False
    for line in lines:
        found = _LINE.match(line)
        is_complete |= line.startswith("COMPLETE: ")
        if found is None:
            continue
        kind, text = found.groups()
        if kind == "BEGIN":
            segments.append(Segment(text))
        elif segments:
            segments[-1].counts[kind] += 1
            if kind in _FAILED:
                segments[-1].failures.append(text)
    return Result(name, [segment for segment in segments if segment.has_cases], is_complete, lines)


def fly(folder: Path, name: str, tasks: str = "thread") -> Result:
    """Fly the test of a folder, osaltest.so, to its end.

    Args:
        folder: folder of the mission; its startup script is written there.
        name: name of the test.
        tasks: the kind of tasks, "thread" or "greenlet".
    """
    (folder / "startup.scr").write_text(STARTUP, encoding="utf-8")
    mission = Mission(str(folder), console=Console(quiet=True), tasks=tasks)
    try:
        mission.run_for(LONGEST_S)
    finally:
        mission.close()
    return read(name, [line for text in mission.console.lines for line in text.split("\n")])

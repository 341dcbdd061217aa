"""The report of a tree's build: the parts that were built, stood in for, or left out, with the reasons."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, NamedTuple

BUILT, STANDS_IN, LEFT_OUT = "built", "stands in", "left out"
KEPT = "kept"


class ReportLine(NamedTuple):
    """A line of the report.

    Attributes:
        result: one of `BUILT`, `STANDS_IN`, `LEFT_OUT`, `KEPT`.
        name: the application, library or file.
        text: the files that were written, or the reason.
    """

    result: str
    name: str
    text: str


@dataclass(slots=True)
class BuildReport:
    """The results of a tree's build.

    Attributes:
        mission: the mission's name.
        cpu: the processor.
        folder: the mission folder.
        read_by: the reader of the tree's files, such as "CMake 3.25.1".
        entries: a line for each application, library and file.
        warnings: warnings of compilers.
        notes: facts about the tree that the mission does not follow.
        steps: things that the user can do, the most useful first.
        is_complete: whether every application and library that the startup script names was built or has a stand-in.
    """

    mission: str
    cpu: str
    folder: str
    read_by: str
    entries: list[ReportLine] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    steps: list[str] = field(default_factory=list)
    is_complete: bool = True

    def add(self, result: str, name: str, text: str) -> None:
        """Add a line."""
        self.entries.append(ReportLine(result, name, text))

    def named(self, result: str) -> list[ReportLine]:
        """Return the lines with a result."""
        return [each for each in self.entries if each.result == result]

    def lines(self) -> Iterator[str]:
        """Yield the text of the report."""
        yield f"{self.mission}, processor {self.cpu}; files of the tree read by {self.read_by}"
        width = max((len(each.name) for each in self.entries), default=0)
        for result in (BUILT, STANDS_IN, LEFT_OUT, KEPT):
            found = self.named(result)
            if found:
                yield f"{result}: {len(found)}"
                yield from (f"  {each.name:{width}}  {each.text}" for each in found)
        if self.notes:
            yield f"notes: {len(self.notes)}"
            yield from (f"  {each}" for each in self.notes)

    def to_json(self) -> dict[str, Any]:
        """Return the report for programs."""
        return {
            "mission": self.mission,
            "cpu": self.cpu,
            "folder": self.folder,
            "read_by": self.read_by,
            "entries": [each._asdict() for each in self.entries],
            "warnings": self.warnings,
            "notes": self.notes,
            "steps": self.steps,
        }

"""Findings of a command, with their places in source files, and as annotations of GitHub.

`cfepy.writing.junit` and `cfepy.writing.sarif_log` write files for other programs. Source of the annotations: GitHub,
Workflow commands for GitHub Actions.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from cfepy.writing.escapes import visible, visible_line

ERROR, WARNING, NOTE = "error", "warning", "note"
_COMMANDS = {ERROR: "error", WARNING: "warning", NOTE: "notice"}
_IN_TEXT = {"%": "%25", "\r": "%0D", "\n": "%0A"}
_IN_PROPERTY = {**_IN_TEXT, ":": "%3A", ",": "%2C"}


class FindingPlace(NamedTuple):
    """A place in a source file.

    Attributes:
        file: its path.
        line: from 1; 0 for the whole file.
        column: from 1; 0 if it is not known.
    """

    file: Path
    line: int = 0
    column: int = 0

    def shown(self, base: Path) -> str:
        """Return it as `file:line:column`, relative to a folder if the file is below it."""
        return ":".join([str(relative(self.file, base)), *(str(part) for part in self[1:] if part)])


class CiFinding(NamedTuple):
    """A finding.

    Attributes:
        rule: id of its kind, such as "data-race".
        text: its message; the first line is the most important one.
        places: its places, the most important first; may be empty.
        level: ERROR, WARNING or NOTE.
    """

    rule: str
    text: str
    places: tuple[FindingPlace, ...] = ()
    level: str = ERROR


def relative(file: Path, base: Path) -> Path:
    """Return a path relative to a folder if it is below the folder, otherwise the path itself."""
    return file.relative_to(base) if file.is_relative_to(base) else file


def annotation_lines(finding: CiFinding, base: Path) -> Iterator[str]:
    """Yield the lines that GitHub shows beside the source files; further places in the repository have a notice.

    Args:
        finding: the finding.
        base: the top of the repository; a file below it is named relative to it.
    """
    places = finding.places
    yield _annotation(finding, places[0] if places else None, [f"also {each.shown(base)}" for each in places[1:]], base)
    for each in (place for place in places[1:] if place.file.is_relative_to(base)):
        yield _annotation(finding._replace(level=NOTE), each, [f"reported at {places[0].shown(base)}"], base)


def _annotation(finding: CiFinding, place: FindingPlace | None, more: Sequence[str], base: Path) -> str:
    properties = {}
    if place is not None:
        properties["file"] = relative(place.file, base).as_posix()
        properties |= {name: str(value) for name, value in (("line", place.line), ("col", place.column)) if value}
    properties["title"] = f"cfepy: {finding.rule}"
    named = ",".join(f"{name}={_escaped(visible_line(value), _IN_PROPERTY)}" for name, value in properties.items())
    text = "\n".join([finding.text, *more])
    return f"::{_COMMANDS[finding.level]} {named}::{_escaped(visible(text), _IN_TEXT)}"


def _escaped(text: str, marks: dict[str, str]) -> str:
    return "".join(marks.get(mark, mark) for mark in text)

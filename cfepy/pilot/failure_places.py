"""The places of a failure: lines of source, of the mission file or of a script, which reports and servers link to.

Failures name places in their texts, such as `(arm.py:12)`, because they go between processes and computers. Here these
names become paths.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from pathlib import Path

from cfepy.interpreter.cached import CachedProperty
from cfepy.interpreter.own_code import is_shown, is_standard
from cfepy.mission import MissionSpec
from cfepy.pilot.failure import Failure, FailureKind
from cfepy.writing.ci_findings import FindingPlace

MOST_FILES = 20_000  # files of a mission that are looked through
MOST_PLACES = 4
_PLACE = re.compile(r"(?<![\w/])(?P<file>[^\s():'\"]*[\w-]+\.[A-Za-z]\w{0,4}):(?P<line>\d+)\b")
_FRAME = re.compile(r'^\s*File "(?P<file>.+)", line (?P<line>\d+)', re.MULTILINE)
_SOURCES = frozenset(
    (".py", ".c", ".cc", ".cpp", ".cxx", ".h", ".hpp", ".scr", ".yaml", ".yml", ".launch", ".xml", ".test", ".txt")
)
_SECTIONS = {FailureKind.INVARIANT: "invariants", FailureKind.DEADLINE: "deadlines"}


class SourcePlaces:
    """Finds the places of failures.

    Args:
        spec: the mission.
        script: the mission script; None without one.
    """

    def __init__(self, spec: MissionSpec, script: str | None = None) -> None:
        self._spec = spec
        self._script = script

    def of(self, failure: Failure, cause: str = "") -> tuple[FindingPlace, ...]:
        """Return the places of a failure, the most important first.

        Args:
            failure: the failure.
            cause: a sentence about its cause, whose places come after the failure's own.

        Returns:
            Some places. If none is known, the line of the startup script that starts the application, or the startup
            script.
        """
        found = [*self._of_rule(failure), *self.in_text(f"{failure.text}\n{cause}", failure.detail)]
        if not found:
            found = list(self._frames(failure.detail))[-1:]
        return tuple(dict.fromkeys(found))[:MOST_PLACES] or self._of_app(failure.who)

    def in_text(self, text: str, traceback: str = "") -> Iterator[FindingPlace]:
        """Yield the places that a text names, if their files are found.

        Args:
            text: the text.
            traceback: a traceback, which has the paths of some files.
        """
        frames = {place.file.name: place.file for place in self._frames(traceback)}
        for found in _PLACE.finditer(text):
            file = self._file(found["file"], frames)
            if file is not None:
                yield FindingPlace(file, int(found["line"]))

    @staticmethod
    def _frames(traceback: str) -> Iterator[FindingPlace]:
        for found in _FRAME.finditer(traceback):
            file = Path(found["file"])
            if file.is_file() and is_shown(found["file"]) and not is_standard(found["file"]):
                yield FindingPlace(file, int(found["line"]))

    def _file(self, name: str, frames: Mapping[str, Path]) -> Path | None:
        """Return the file of a name, or None if there is none, or several."""
        path = Path(name)
        if len(path.parts) > 1:
            return path.absolute() if path.is_file() else None
        return frames.get(name) or self._by_name.get(name)

    @CachedProperty
    def _by_name(self) -> dict[str, Path]:
        """The sources of the mission by name, without names that several files have."""
        nodes = [node.script.parent for node in self._spec.ros.nodes.values() if node.script is not None]
        folders = dict.fromkeys(each.resolve() for each in (self._spec.folder, *nodes))
        found: dict[str, set[Path]] = {}
        for file in _files_below(list(folders)):
            found.setdefault(file.name, set()).add(file)
        return {name: next(iter(files)) for name, files in found.items() if len(files) == 1}

    def _of_rule(self, failure: Failure) -> Iterator[FindingPlace]:
        """Yield the place of a rule of the mission file, or of a step of the script."""
        if failure.kind == FailureKind.EXPECTATION and self._script is not None:
            line = failure.who.rpartition(":")[2]
            yield FindingPlace(Path(self._script).absolute(), int(line) if line.isdecimal() else 0)
        section = self._spec.demands.get(_SECTIONS.get(failure.kind, ""))
        if section is not None:
            tables = [section] if failure.kind == FailureKind.INVARIANT else list(section.mapping().values())
            for table in tables:
                rule = table.mapping().get(failure.who)
                if rule is not None:
                    yield FindingPlace(rule.file.absolute(), rule.line)

    def _of_app(self, name: str) -> tuple[FindingPlace, ...]:
        if self._spec.startup is not None:  # made of a launch file or a node
            return (FindingPlace(self._spec.script.absolute()),)
        line = next((each.line for each in self._spec.entries if each.name == name), 0)
        return (FindingPlace(self._spec.script.absolute(), line),)


def _files_below(folders: list[Path]) -> Iterator[Path]:
    """Yield the sources in folders, at most a number of files."""
    count = 0
    for folder in folders:
        for place, inner, names in os.walk(folder):
            inner[:] = sorted(name for name in inner if not name.startswith((".", "__pycache__")))
            for name in names:
                count += 1
                if count > MOST_FILES:
                    return
                if os.path.splitext(name)[1] in _SOURCES:
                    yield Path(place, name)

"""Sources of message and service definitions: packages shipped with cfepy, folders on disk, or given texts.

Shipped packages are text files next to this one, `<package>.msgs`, `<package>.srvs` and `<package>.actions`, with one
`# package/Name` section per type, whose title notes if the type's own file has no line feed at its end. A service has
two parts. An action is a goal, a result and a feedback, and an envelope for each, which make the seven messages of
actionlib_msgs' genaction.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Literal, NamedTuple, Protocol

from cfepy.reading.input_files import text_limited
from cfepy.reading.input_limits import DEFINITION_BYTES
from cfepy.reading.mistakes import Mistakes
from cfepy.status import UsageError
from rospy_shim.types.msgs.packages import Packages, folders_of_definitions, has_definitions

_DASHES = "---"
_PARTS = ("Goal", "Result", "Feedback")
_ENVELOPES = {
    "Goal": "actionlib_msgs/GoalID goal_id",
    "Result": "actionlib_msgs/GoalStatus status",
    "Feedback": "actionlib_msgs/GoalStatus status",
}
Kind = Literal["msg", "srv", "action"]
_NO_END = " (no line feed at its end)"  # of a type whose .msg file has none
_SHIPPED = Path(__file__).parent / "definitions"
_SUFFIXES = (".msgs", ".srvs", ".actions")


class Definition(NamedTuple):
    """Text of one type and the place it was read from."""

    text: str
    file: str
    first_line: int = 1


def split_parts(definition: Definition) -> list[Definition]:
    """Return the parts of an action, which lines that begin with three dashes separate."""
    parts, start = [], 0
    lines = definition.text.split("\n")
    for at, line in enumerate([*lines, _DASHES]):
        if line.startswith(_DASHES):
            text = "\n".join(lines[start:at])
            parts.append(Definition(text, definition.file, definition.first_line + start))
            start = at + 1
    return parts


def split_service(definition: Definition) -> tuple[Definition, Definition]:
    """Return request and response of a service, each line with its line feed, the last one with two, as in genmsg.

    Only the first line of dashes separates them; further ones are ignored.
    """
    request, *rest = split_parts(definition)
    text = "\n\n".join(part.text for part in rest)
    first_line = rest[0].first_line if rest else definition.first_line
    return (
        request._replace(text=_ended(request.text)),
        Definition(_ended(text), definition.file, first_line),
    )


def _ended(text: str) -> str:
    return f"{text}\n" if text else ""


def messages_of(actions: Mapping[str, Definition], mistakes: Mistakes | None = None) -> dict[str, Definition]:
    """Return the messages of all actions of a package.

    Args:
        actions: definitions by the action's bare name.
        mistakes: receives an action that does not have exactly three parts; None raises the first error.

    Raises:
        UsageError: the first error.
    """
    found: dict[str, Definition] = {}
    for name, action in actions.items():
        try:
            found |= {name + suffix: made for suffix, made in _messages(name, action)}
        except UsageError as error:
            if mistakes is None:
                raise
            mistakes.add(error)
    return found


def _messages(name: str, action: Definition) -> Iterator[tuple[str, Definition]]:
    parts = split_parts(action)
    if len(parts) != len(_PARTS):
        line = parts[min(len(parts) - 1, len(_PARTS))].first_line
        raise UsageError(
            f"an action must have 3 parts separated by lines {_DASHES}, not {len(parts)}", file=action.file, line=line
        )
    for part, definition in zip(_PARTS, parts, strict=True):
        envelope = f"Header header\n{_ENVELOPES[part]}\n{name}{part} {part.lower()}\n"
        yield part, definition
        yield f"Action{part}", Definition(envelope, action.file, action.first_line)
    whole = "".join(f"{name}Action{part} action_{part.lower()}\n" for part in _PARTS)
    yield "Action", Definition(whole, action.file, action.first_line)


Definitions = Mapping[str, Definition]
"""Definitions of one package by the type's bare name."""


class Source(Protocol):
    """A source of definitions."""

    def packages(self) -> Iterable[str]:
        """Return the names of its packages."""

    def package(self, name: str, kind: Kind) -> Definitions | None:
        """Return messages or services of a package; None if it has none."""


class Shipped:
    """The packages that come with cfepy."""

    def __init__(self, folder: Path = _SHIPPED) -> None:
        self._folder = folder

    def packages(self) -> list[str]:
        """Return the names of the packages, sorted."""
        return sorted({path.stem for path in self._folder.iterdir() if path.suffix in _SUFFIXES})

    def package(self, name: str, kind: Kind) -> Definitions | None:
        """Return messages or services of a package."""
        found = self._read(name, kind)
        if kind == "msg":
            found |= messages_of(self._read(name, "action"))
        return found or None

    def _read(self, name: str, kind: str) -> dict[str, Definition]:
        path = self._folder / f"{name}.{kind}s"
        return dict(_sections(text_limited(path, DEFINITION_BYTES), str(path))) if os.path.isfile(path) else {}


class OnDisk:
    """Packages on disk: `msg/*.msg`, `srv/*.srv` and `action/*.action` in their folders.

    Args:
        packages: the packages.
        mistakes: receives actions that are wrong; None raises the first error.
    """

    def __init__(self, packages: Packages, mistakes: Mistakes | None = None) -> None:
        self._packages = packages
        self._mistakes = mistakes

    def packages(self) -> list[str]:
        """Return the names of the packages that have definitions, sorted."""
        names = self._packages.names()
        return [name for name in names if any(map(_has_some, self._packages.folders(name)))]

    def package(self, name: str, kind: Kind) -> Definitions | None:
        """Return messages or services of a package, from its first folder that has some."""
        found = (_in_folder(folder, kind, self._mistakes) for folder in self._packages.folders(name))
        return next(filter(None, found), None)


class Texts:
    """Given message definitions, by full name; e.g. from a connection header or a bag."""

    def __init__(self, definitions: Definitions) -> None:
        self._definitions = dict(definitions)

    def packages(self) -> list[str]:
        """Return the names of the packages, sorted."""
        return sorted({name.partition("/")[0] for name in self._definitions})

    def package(self, name: str, kind: Kind) -> Definitions | None:
        """Return messages of a package."""
        of_package = (key for key in self._definitions if kind == "msg" and key.startswith(name + "/"))
        return {key.partition("/")[2]: self._definitions[key] for key in of_package} or None


def _has_some(folder: Path) -> bool:
    kinds = ("msg", "srv", "action")
    return has_definitions(folder) or any(folders_of_definitions(folder, kind) for kind in kinds)


def _in_folder(folder: Path, kind: Kind, mistakes: Mistakes | None) -> dict[str, Definition]:
    messages = messages_of(_files(folder, "action"), mistakes) if kind == "msg" else {}
    return messages | _files(folder, kind)


def _files(folder: Path, kind: str) -> dict[str, Definition]:
    places = [folder / kind, *folders_of_definitions(folder, kind)]
    return {path.stem: _read(path) for place in places for path in sorted(place.glob(f"*.{kind}"))}


def _read(path: Path) -> Definition:
    # Only comments can contain characters other than ASCII, and in old files they have various encodings.
    return Definition(text_limited(path, DEFINITION_BYTES, "replace"), str(path))


def _sections(text: str, file: str) -> Iterator[tuple[str, Definition]]:
    line = 1
    for chunk in text.removeprefix("# ").split("\n# "):
        title, _, body = chunk.partition("\n")
        name = title.removesuffix(_NO_END)
        end = "\n" if name == title else ""
        yield name.rpartition("/")[2].strip(), Definition(body.strip("\n") + end, file, line + 1)
        line += chunk.count("\n") + 1

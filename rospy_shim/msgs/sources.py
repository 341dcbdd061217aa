"""Where message and service definitions come from: packages shipped with cfepy, folders on disk, or texts at hand.

Shipped packages are text files beside this one, `<package>.msgs`, `<package>.srvs` and `<package>.actions`, with one
`# package/Name` section per type. An action counts as the messages that it stands for. Imports nothing of cfepy.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Literal, Protocol

from rospy_shim.msgs.packages import Packages, has_definitions
from rospy_shim.msgs.parts import Definition, messages_of

Kind = Literal["msg", "srv"]
_SHIPPED = Path(__file__).parent / "definitions"
_SUFFIXES = (".msgs", ".srvs", ".actions")

Definitions = Mapping[str, Definition]
"""Definitions of one package by the type's bare name."""


class Source(Protocol):
    """Something that has definitions."""

    def packages(self) -> Iterable[str]:
        """Names of the packages it has."""

    def package(self, name: str, kind: Kind) -> Definitions | None:
        """Messages or services of a package; None when it has none there."""


class Shipped:
    """The packages that come with cfepy."""

    def __init__(self, folder: Path = _SHIPPED) -> None:
        self._folder = folder

    def packages(self) -> list[str]:
        """Names of the packages, sorted."""
        return sorted({path.stem for path in self._folder.iterdir() if path.suffix in _SUFFIXES})

    def package(self, name: str, kind: Kind) -> Definitions | None:
        """Messages or services of a package."""
        found = self._read(name, kind)
        if kind == "msg":
            found |= messages_of(self._read(name, "action"))
        return found or None

    def _read(self, name: str, kind: str) -> dict[str, Definition]:
        path = self._folder / f"{name}.{kind}s"
        return dict(_sections(path.read_text(encoding="utf-8"), str(path))) if path.is_file() else {}


class OnDisk:
    """Packages on disk: `msg/*.msg`, `srv/*.srv` and `action/*.action` in their folders."""

    def __init__(self, packages: Packages) -> None:
        self._packages = packages

    def packages(self) -> list[str]:
        """Names of the packages that have definitions, sorted."""
        names = self._packages.names()
        return [name for name in names if any(map(has_definitions, self._packages.folders(name)))]

    def package(self, name: str, kind: Kind) -> Definitions | None:
        """Messages or services of a package, from its first folder that has some."""
        found = (_in_folder(folder, kind) for folder in self._packages.folders(name))
        return next(filter(None, found), None)


class Texts:
    """Message definitions at hand, by full name; e.g. those of a connection header or a bag."""

    def __init__(self, definitions: Definitions) -> None:
        self._definitions = dict(definitions)

    def packages(self) -> list[str]:
        """Names of the packages, sorted."""
        return sorted({name.partition("/")[0] for name in self._definitions})

    def package(self, name: str, kind: Kind) -> Definitions | None:
        """Messages of a package."""
        of_package = (key for key in self._definitions if kind == "msg" and key.startswith(name + "/"))
        return {key.partition("/")[2]: self._definitions[key] for key in of_package} or None


def _in_folder(folder: Path, kind: Kind) -> dict[str, Definition]:
    messages = messages_of(_files(folder, "action")) if kind == "msg" else {}
    return messages | _files(folder, kind)


def _files(folder: Path, kind: str) -> dict[str, Definition]:
    return {path.stem: _read(path) for path in sorted((folder / kind).glob(f"*.{kind}"))}


def _read(path: Path) -> Definition:
    # Only comments can hold anything but ASCII, and an old file's are in some other encoding.
    return Definition(path.read_text(encoding="utf-8", errors="replace"), str(path))


def _sections(text: str, file: str) -> Iterator[tuple[str, Definition]]:
    line = 1
    for chunk in text.removeprefix("# ").split("\n# "):
        title, _, body = chunk.partition("\n")
        yield title.rpartition("/")[2].strip(), Definition(body.strip("\n") + "\n", file, line + 1)
        line += chunk.count("\n") + 1

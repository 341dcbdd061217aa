"""Where message and service definitions come from: packages shipped with cfepy, folders on disk, or texts at hand.

Shipped packages are text files beside this one, `<package>.msgs` and `<package>.srvs`, with one `# package/Name`
section per type. Imports nothing of cfepy.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Literal, NamedTuple, Protocol

Kind = Literal["msg", "srv"]
_SHIPPED = Path(__file__).parent / "definitions"


class Definition(NamedTuple):
    """Text of one type and the place it was read from."""

    text: str
    file: str
    first_line: int = 1


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
        return sorted({path.stem for path in self._folder.iterdir() if path.suffix in (".msgs", ".srvs")})

    def package(self, name: str, kind: Kind) -> Definitions | None:
        """Messages or services of a package."""
        path = self._folder / f"{name}.{kind}s"
        if not path.is_file():
            return None
        return dict(_sections(path.read_text(encoding="utf-8"), str(path)))


class Folders:
    """ROS packages on disk, `<root>/<package>/msg/*.msg` and `srv/*.srv`, for roots as on ROS_PACKAGE_PATH."""

    def __init__(self, roots: Sequence[Path]) -> None:
        self._roots = tuple(roots)

    def packages(self) -> list[str]:
        """Names of the packages, sorted."""
        patterns = ("*/msg/*.msg", "*/srv/*.srv")
        return sorted({path.parts[-3] for root in self._roots for pattern in patterns for path in root.glob(pattern)})

    def package(self, name: str, kind: Kind) -> Definitions | None:
        """Messages or services of a package, from the first root that has some."""
        for root in self._roots:
            files = sorted((root / name / kind).glob(f"*.{kind}"))
            if files:
                return {path.stem: Definition(path.read_text(encoding="utf-8"), str(path)) for path in files}
        return None


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


def split_service(definition: Definition) -> tuple[Definition, Definition]:
    """Request and response of a service, which a line of three dashes parts."""
    lines = definition.text.split("\n")
    cut = next((at for at, line in enumerate(lines) if line.strip() == "---"), len(lines))
    answer = Definition("\n".join(lines[cut + 1 :]), definition.file, definition.first_line + cut + 1)
    return Definition("\n".join(lines[:cut]), definition.file, definition.first_line), answer


def _sections(text: str, file: str) -> Iterator[tuple[str, Definition]]:
    line = 1
    for chunk in text.removeprefix("# ").split("\n# "):
        title, _, body = chunk.partition("\n")
        yield title.rpartition("/")[2].strip(), Definition(body.strip("\n") + "\n", file, line + 1)
        line += chunk.count("\n") + 1

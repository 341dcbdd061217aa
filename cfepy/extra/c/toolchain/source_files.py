"""The folder of a compiled application: the files to compile, and the folders of its headers.

A cFS application keeps its code in `fsw/src`, its headers in `fsw/inc` and beside them, and tables in `fsw/tables`.
Settings of a mission are in `config`: a file `config/default_NAME.h` there is included as `NAME.h`, unless the mission
has one. The folder's CMakeLists.txt takes precedence over these conventions: its name, sources, tables, include folders
and dependencies.

Among the commands of such files, cFS's `add_cfe_app`, `add_cfe_tables` and `add_cfe_app_dependency` are defined here,
and also include folders and definitions; `cmake_script` knows the language itself. A condition holds if its variable
was set to a true value in the file itself: no EDS, no unit tests, no options, as in a plain build of the mission. The
list of the mission's applications, in which a file looks for those whose headers it takes, has the folders next to it.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from cfepy.extra.c.toolchain.cmake_script import FILE, CMakeScript
from cfepy.extra.c.toolchain.cmake_words import CMakeWord
from cfepy.extra.c.toolchain.compiler import SOURCE_SUFFIXES
from cfepy.reading.input_files import text_limited
from cfepy.reading.input_limits import CMAKE_BYTES
from cfepy.status import UsageError

INCLUDES = ("fsw/inc", "fsw/public_inc", "fsw/mission_inc", "fsw/platform_inc", "inc", "include")
CODE = ("fsw/src", "src", ".")
TABLES = ("fsw/tables", "tables")
DEFINITIONS = (".", "inc", "mission_inc", "platform_inc", "fsw/mission_inc", "fsw/platform_inc")
DEFAULT = "default_"
NEIGHBOURS = (".", "apps", "libs")
SCOPES = ("PUBLIC", "PRIVATE", "INTERFACE", "BEFORE", "AFTER", "SYSTEM")
_MISSION_DIR = re.compile(r"\$\{(\w+)_MISSION_DIR\}")
"""The folder of another application, in files that are older than `add_cfe_app_dependency`."""
_APPS = re.compile(r"TGTSYS_\w*APPS")
"""The list of a mission's applications in cFS's build."""
_HEADERS_OF = re.compile(r"\$<TARGET_PROPERTY:(\w+),(?:INTERFACE_)?INCLUDE_DIRECTORIES>")
"""The folders of another application's headers."""
_FILE_LIST = re.compile(r"set\(\w{1,100}_FILE_LIST([^()]*+)\)")
_LEGAL = re.compile(r"\w[\w.+-]*")
_SHOWN = 100  # characters of a name that is wrong
_EDS = re.compile(r"_eds_\w+$")
"""Sources that replace others where messages are described by electronic data sheets."""


@dataclass(slots=True)
class Sources:
    """The sources of an application.

    Attributes:
        name: of the shared object.
        folder: of the application.
        code: files to be compiled and linked.
        tables: files that define tables.
        includes: folders of headers, the first searched first.
        chosen: headers to write for the compiler: a name, and the file that stands for it; None for an empty one.
        definitions: the compiler's -D.
        missing: applications and libraries that its headers come from and that were not found.
    """

    name: str
    folder: Path
    code: list[Path]
    tables: list[Path]
    includes: list[Path] = field(default_factory=list)
    chosen: dict[str, Path | None] = field(default_factory=dict)
    definitions: list[str] = field(default_factory=list)
    missing: list[str] = field(default_factory=list)


def find_sources(folder: Path, definitions: Path | None = None) -> Sources:
    """Find the sources in the folder of an application.

    Args:
        folder: of the application.
        definitions: a folder of a mission's headers, which go before the application's own.

    Raises:
        UsageError: there is no such folder, or nothing in it to compile.
    """
    if not os.path.isdir(folder):
        raise UsageError("folder not found; give the folder that contains the application's fsw/src", file=folder)
    if definitions is not None and not os.path.isdir(definitions):
        raise UsageError("folder of the mission's headers not found", file=definitions)
    said = read_cmake_lists(folder)
    code = _files(folder, said.sources) or _code_in(folder)
    if not code:
        raise UsageError("missing C sources: add them to fsw/src, or name them in CMakeLists.txt", file=folder)
    tables = _files(folder, said.tables) or _all_in(folder, TABLES)
    if said.name and not _LEGAL.fullmatch(said.name):
        text = f"invalid application name {said.name[:_SHOWN]!r} in {FILE}; expected letters, digits, '_', '-' and '.'"
        raise UsageError(text, file=folder / FILE)
    found = Sources(said.name or folder.resolve().name, folder, code, tables, definitions=list(said.definitions))
    headers = [] if definitions is None else _folders(definitions, DEFINITIONS)
    found.includes += headers + _folders(folder, said.includes) + _folders(folder, INCLUDES)
    _choose(found, folder, headers)
    for name in said.dependencies:
        other = _neighbour(folder, name)
        if other is None:
            found.missing.append(name)
        else:
            found.includes += _folders(other, [*read_cmake_lists(other).includes, *INCLUDES])
            _choose(found, other, headers)
    found.includes = list(dict.fromkeys(found.includes))
    return found


def chosen_headers(folders: Iterable[Path], overriding: Sequence[Path] = ()) -> dict[str, Path]:
    """Return the headers `NAME.h` that files `default_NAME.h` stand for.

    Args:
        folders: folders with such files.
        overriding: folders that may have their own `NAME.h`, which is used instead.
    """
    found: dict[str, Path] = {}
    for folder in folders:
        for file in sorted(folder.glob(f"{DEFAULT}*.h")):
            name = file.name.removeprefix(DEFAULT)
            found[name] = next((each / name for each in overriding if os.path.isfile(each / name)), file)
    return found


def _choose(found: Sources, folder: Path, overriding: Sequence[Path]) -> None:
    for name, file in chosen_headers([folder / "config"], overriding).items():
        if not any(os.path.isfile(each / name) for each in found.includes if each.is_relative_to(folder)):
            found.chosen.setdefault(name, file.resolve())
    for name in _declared(folder):
        if name not in found.chosen and not any(os.path.isfile(each / name) for each in (*overriding, *found.includes)):
            found.chosen[name] = None


def _declared(folder: Path) -> Iterator[str]:
    """Yield headers that a mission makes for an application, including those without a default, which are empty."""
    for name in ("mission_build.cmake", "arch_build.cmake"):
        file = folder / name
        if os.path.isfile(file):
            for words in _FILE_LIST.findall(text_limited(file, CMAKE_BYTES, "replace")):
                yield from (word for word in words.split() if word.endswith(".h") and _LEGAL.fullmatch(word))


def _files(folder: Path, names: Iterable[str]) -> list[Path]:
    named = {name: folder / name for name in names if Path(name).suffix in SOURCE_SUFFIXES}
    for name, file in named.items():
        if not os.path.isfile(file):
            raise UsageError(f"{FILE} names a missing file: {name}", file=folder / FILE)
    return list(named.values())


def _code_in(folder: Path) -> list[Path]:
    for name in CODE:
        files = _all_in(folder, (name,))
        if files:
            return files
    return []


def _all_in(folder: Path, names: Iterable[str]) -> list[Path]:
    files = (file for name in names for suffix in SOURCE_SUFFIXES for file in (folder / name).glob(f"*{suffix}"))
    return sorted(file for file in files if not _EDS.search(file.stem))


def _folders(folder: Path, names: Iterable[str]) -> list[Path]:
    return [folder / name for name in names if name[:1] != "/" and os.path.isdir(folder / name)]


def _neighbour(folder: Path, name: str) -> Path | None:
    """Return the folder of another application or library: beside this one, or in `libs` or `apps` one level up."""
    above = folder.resolve().parent
    places = [above / name, *(above.parent / each / name for each in NEIGHBOURS)]
    return next((each for each in places if os.path.isdir(each) and each != folder.resolve()), None)


# -- CMakeLists.txt ----------------------------------------------------------------------------------------------------


@dataclass(slots=True)
class CMakeLists:
    """The contents of a CMakeLists.txt; all paths are relative to its folder.

    Attributes:
        name: of the application, "" when there is none.
        sources: of its code.
        tables: sources of tables.
        includes: folders of headers.
        definitions: the compiler's -D.
        dependencies: names of applications and libraries whose headers it uses.
    """

    name: str = ""
    sources: list[str] = field(default_factory=list)
    tables: list[str] = field(default_factory=list)
    includes: list[str] = field(default_factory=list)
    definitions: list[str] = field(default_factory=list)
    dependencies: list[str] = field(default_factory=list)


def read_cmake_lists(folder: Path) -> CMakeLists:
    """Read the file of a folder.

    Args:
        folder: of the application.

    Returns:
        Its contents; empty if there is no such file.
    """
    file = folder / FILE
    if not os.path.isfile(file):
        return CMakeLists()
    reader = _Reader(folder)
    reader.run(text_limited(file, CMAKE_BYTES, "replace"))
    return reader.found


class _Reader(CMakeScript):
    """Reads the file of an application.

    Args:
        folder: folder of the file.

    Attributes:
        found: its contents.
    """

    def __init__(self, folder: Path) -> None:
        super().__init__(folder, {"CMAKE_CURRENT_SOURCE_DIR": ["."], "CMAKE_CURRENT_LIST_DIR": ["."]})
        self.found = CMakeLists()

    def command(self, name: str, words: list[str]) -> None:
        found = self.found
        match name, words:
            case "add_cfe_app", [app, *sources] if not found.name:
                found.name, found.sources = app, sources
            case "add_cfe_tables", [_, *tables]:
                found.tables += tables
            case "add_cfe_app_dependency", [_, *names]:
                found.dependencies += names
            case "target_include_directories", [_, *folders]:
                self._include(folders)
            case "include_directories", folders:
                self._include(folders)
            case "list", ["FIND", variable, app, index] if _APPS.fullmatch(variable):
                there = _neighbour(self.folder, app) if _LEGAL.fullmatch(app) else None
                is_app = there is not None and os.path.isfile(there / FILE)  # not a submodule that was not fetched
                self.variables[index] = ["0" if is_app else "-1"]
            case "add_definitions" | "add_compile_definitions", definitions:
                found.definitions += [each.removeprefix("-D") for each in definitions]
            case _:
                super().command(name, words)

    def _include(self, folders: Sequence[str]) -> None:
        for each in folders:
            other = _HEADERS_OF.fullmatch(each)
            if other is not None:
                self._depend(other[1])
            elif each not in SCOPES and "$" not in each:
                self.found.includes.append(each)

    def _depend(self, name: str) -> None:
        if name not in self.found.dependencies:
            self.found.dependencies.append(name)

    def expanded(self, words: Sequence[CMakeWord]) -> list[str]:
        """Expand words. A folder of another application also makes it a dependency."""
        for word in words:
            for name in _MISSION_DIR.findall(word.text):
                self._depend(name)
        return super().expanded(words)

"""What a cFS application's CMakeLists.txt says: its name, sources, tables, include folders and what it depends on.

Of the commands that such files are made of, cFS's `add_cfe_app`, `add_cfe_tables` and `add_cfe_app_dependency` have
their meaning here, beside include folders and definitions; `cmake_script` knows the language itself. A condition holds
when its variable was set to something true in the file itself: no EDS, no unit tests, no options, as in a plain build
of the mission.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from cfepy.c.toolchain.cmake_script import FILE, CMakeScript

SCOPES = ("PUBLIC", "PRIVATE", "INTERFACE", "BEFORE", "AFTER", "SYSTEM")
_MISSION_DIR = re.compile(r"\$\{(\w+)_MISSION_DIR\}")
"""The folder of another application, in files that are older than `add_cfe_app_dependency`."""


@dataclass(slots=True)
class CMakeLists:
    """What was read; all paths are seen from the folder of the file.

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
        What it says; nothing when there is no such file.
    """
    file = folder / FILE
    if not file.is_file():
        return CMakeLists()
    reader = _Reader(folder)
    reader.run(file.read_text(encoding="utf-8", errors="replace"))
    return reader.found


class _Reader(CMakeScript):
    """Reads the file of an application.

    Args:
        folder: that it is in.

    Attributes:
        found: what it says.
    """

    follows_loops = False  # they are over the applications of a mission, which are not known here

    def __init__(self, folder: Path) -> None:
        super().__init__(folder, {"CMAKE_CURRENT_SOURCE_DIR": ["."], "CMAKE_CURRENT_LIST_DIR": ["."]})
        self.found = CMakeLists()

    def command(self, name: str, words: list[str]) -> None:
        """See `CMakeScript.command`."""
        found = self.found
        match name, words:
            case "add_cfe_app", [app, *sources] if not found.name:
                found.name, found.sources = app, sources
            case "add_cfe_tables", [_, *tables]:
                found.tables += tables
            case "add_cfe_app_dependency", [_, *names]:
                found.dependencies += names
            case "target_include_directories", [_, *folders]:
                found.includes += [each for each in folders if each not in SCOPES and "$" not in each]
            case "include_directories", folders:
                found.includes += [each for each in folders if each not in SCOPES and "$" not in each]
            case "add_definitions" | "add_compile_definitions", definitions:
                found.definitions += [each.removeprefix("-D") for each in definitions]
            case _:
                super().command(name, words)

    def expanded(self, words: Sequence[str]) -> list[str]:
        """See `CMakeScript.expanded`; a folder of another application makes it one that this one depends on."""
        for word in words:
            for name in _MISSION_DIR.findall(word):
                self.found.dependencies += [name] if name not in self.found.dependencies else []
        return super().expanded(words)

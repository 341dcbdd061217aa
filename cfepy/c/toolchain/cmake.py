"""What a cFS application's CMakeLists.txt says: its name, sources, tables, include folders and what it depends on.

This is no CMake. It knows the commands that such files are made of: `set`, `list(APPEND)`, `if`, `file(GLOB)`,
`aux_source_directory`, `include_directories` and `add_definitions`, and cFS's `add_cfe_app`, `add_cfe_tables` and
`add_cfe_app_dependency`. A condition holds when its variable was set to something true in the file itself: no EDS, no
unit tests, no options, as in a plain build of the mission.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

FILE = "CMakeLists.txt"
FALSE = ("", "0", "OFF", "NO", "FALSE", "N", "IGNORE", "NOTFOUND")
SCOPES = ("PUBLIC", "PRIVATE", "INTERFACE", "BEFORE", "AFTER", "SYSTEM")
_COMMAND = re.compile(r"([A-Za-z_]\w*)\s*\(((?:[^()\"]|\"[^\"]*\"|\([^()]*\))*)\)")
_WORD = re.compile(r'"([^"]*)"|([^\s;]+)')
_VARIABLE = re.compile(r"\$\{(\w+)\}")
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
    return _Reader(folder).read(file.read_text(encoding="utf-8", errors="replace"))


class _Reader:
    """Reads one file.

    Args:
        folder: that it is in.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._variables: dict[str, list[str]] = {"CMAKE_CURRENT_SOURCE_DIR": ["."], "CMAKE_CURRENT_LIST_DIR": ["."]}
        self._found = CMakeLists()

    def read(self, text: str) -> CMakeLists:
        """Carry out the commands of a file that hold."""
        text = re.sub(r"#[^\n]*", "", text)
        branches: list[list[bool]] = []  # of each open `if`: whether this branch holds, and whether one has held
        for command, words in _commands(text):
            if command == "if":
                holds = self._holds(words)
                branches.append([holds, holds])
            elif command == "foreach":
                branches.append([False, False])  # over the applications of a mission, which are not known here
            elif command in ("elseif", "else") and branches:
                holds = not branches[-1][1] and (command == "else" or self._holds(words))
                branches[-1] = [holds, branches[-1][1] or holds]
            elif command in ("endif", "endforeach") and branches:
                branches.pop()
            elif all(holds for holds, _ in branches):
                self._do(command, self._expanded(words))
        return self._found

    def _do(self, command: str, words: list[str]) -> None:
        found = self._found
        match command, words:
            case "set", [name, *values]:
                self._variables[name] = values[: values.index("CACHE")] if "CACHE" in values else values
            case "list", ["APPEND", name, *values]:
                self._variables.setdefault(name, []).extend(values)
            case "aux_source_directory", [folder, name]:
                self._variables.setdefault(name, []).extend(self._glob(f"{folder}/*.c*"))
            case "file", ["GLOB", name, *patterns]:
                self._variables[name] = [file for each in patterns if each != "RELATIVE" for file in self._glob(each)]
            case "add_cfe_app", [name, *sources] if not found.name:
                found.name, found.sources = name, sources
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

    def _glob(self, pattern: str) -> list[str]:
        try:
            return sorted(each.relative_to(self._folder).as_posix() for each in self._folder.glob(pattern))
        except (ValueError, NotImplementedError):  # a pattern that leads out of the folder
            return []

    def _holds(self, words: list[str]) -> bool:
        if words[:1] == ["NOT"]:
            return len(words) == 2 and not self._holds(words[1:])
        if len(words) != 1:
            return False
        values = self._variables.get(words[0], [])
        return bool(values) and values[0].upper() not in FALSE

    def _expanded(self, words: list[str]) -> list[str]:
        found: list[str] = []
        for word in words:
            for name in _MISSION_DIR.findall(word):
                self._found.dependencies += [name] if name not in self._found.dependencies else []
            whole = _VARIABLE.fullmatch(word)
            if whole:
                found += self._variables.get(whole[1], [])
            else:
                found.append(_VARIABLE.sub(lambda match: " ".join(self._variables.get(match[1], [])), word))
        return found


def _commands(text: str) -> Iterator[tuple[str, list[str]]]:
    for match in _COMMAND.finditer(text):
        yield match[1].lower(), [quoted or plain for quoted, plain in _WORD.findall(match[2])]

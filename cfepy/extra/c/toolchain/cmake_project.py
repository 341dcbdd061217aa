"""A CMake project, read without CMake: targets with their settings, over all files of a mission tree.

`Project` is the state that all files share: targets, functions, headers that the build makes, and notes about
everything that a real build would do and this reader does not. `ProjectScript` executes one folder's file. A folder
inherits variables, include folders and definitions from the folder that adds it, as in CMake. cFS's own functions, such
as `add_cfe_app`, are defined here.

Nothing is executed and nothing is written: `execute_process`, `find_package` and custom commands become notes, and
`file(WRITE ...)` stays in memory, where the reader of startup scripts finds it.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from cfepy.extra.c.toolchain.cmake_budget import CMakeBudget
from cfepy.extra.c.toolchain.cmake_script import FILE, CMakeScript
from cfepy.extra.c.toolchain.cmake_targets import (
    DEFINITIONS,
    INCLUDES,
    INTERFACE,
    KINDS,
    LINKS,
    MODULE,
    STATIC,
    CMakeTargets,
    Target,
    absolute,
)
from cfepy.reading.input_files import text_limited, unreadable
from cfepy.reading.input_limits import CMAKE_BYTES

SCOPES = ("PUBLIC", "PRIVATE", "INTERFACE", "BEFORE", "AFTER", "SYSTEM")
_KEYS = ("COMMAND", "DEPENDS", "WORKING_DIRECTORY", "COMMENT", "VERBATIM", "MAIN_DEPENDENCY", "ARGS", "BYPRODUCTS")
_MISSION_DIR = "_MISSION_DIR"
"""End of the variable with another application's folder, in files older than `add_cfe_app_dependency`."""
_NOT_SOURCES = ("EXCLUDE_FROM_ALL", "IMPORTED", "GLOBAL", "ALIAS", "UNKNOWN")
HEADER_FOLDERS = ("fsw/inc", "fsw/public_inc", "fsw/mission_inc", "fsw/platform_inc", "fsw/src", "inc", "include")
_FIND = ("find_package", "find_library", "find_path", "find_file", "find_program", "pkg_check_modules")


class ProjectNote(NamedTuple):
    """A fact about a file of the tree that a build of it should report.

    Attributes:
        kind: "missing folder", "missing file", "error", "command", "package", "expression".
        folder: of the file.
        text: the name or the message.
    """

    kind: str
    folder: str
    text: str


class TableCall(NamedTuple):
    """A call of `add_cfe_tables`: its name, the folder of its file, its sources and the settings of the folder."""

    name: str
    folder: str
    words: list[str]
    settings: Directory


@dataclass(slots=True)
class Directory:
    """Settings of a folder: include folders, definitions and libraries of all its targets."""

    includes: list[str] = field(default_factory=list)
    definitions: list[str] = field(default_factory=list)
    libraries: list[str] = field(default_factory=list)

    def copy(self) -> Directory:
        """Return a copy, for a subfolder."""
        return Directory(list(self.includes), list(self.definitions), list(self.libraries))


class _EndedFile(Exception):
    """A `message(FATAL_ERROR)` ended a file."""


class Project:
    """The state that all files of a tree share.

    Args:
        file: the outermost file, for errors.
        targets_in: folders with the CMakeLists.txt of targets, by the name of a target, for those that no file adds.

    Attributes:
        targets: all targets.
        tables: calls of `add_cfe_tables`.
        headers: headers that the build makes: their name, and the file that stands for each unless the mission has
            one; None for an empty one.
        mission_headers: the entries of `headers` that all processors of the mission share.
        generated: files that a custom command makes, with the command.
        written: texts of `file(WRITE)`, by path.
        installed: files that `install(FILES)` puts into a folder of the target.
        cache: variables that every folder sees.
        notes: facts for the report.
        absent: names of applications and libraries that files refer to and that are not there.
        root: the script of the outermost folder.
    """

    def __init__(self, file: Path, targets_in: Mapping[str, Path] | None = None) -> None:
        self.budget = CMakeBudget(file)
        self.targets = CMakeTargets(self._from_folder, self.budget.spend)
        self.targets_in = dict(targets_in or {})
        self.tables: list[TableCall] = []
        self.headers: dict[str, str | None] = {}
        self.mission_headers: set[str] = set()
        self.generated: dict[str, str] = {}
        self.written: dict[str, str] = {}
        self.installed: list[str] = []
        self.cache: dict[str, list[str]] = {}
        self.notes: list[ProjectNote] = []
        self.absent: list[str] = []
        self.root: ProjectScript | None = None
        self._visited: set[str] = set()
        self._used: set[str] = set()

    def note(self, kind: str, folder: str | Path, text: str) -> None:
        """Add a note, once."""
        one = ProjectNote(kind, str(folder), text)
        if one not in self.notes:
            self.notes.append(one)

    def add_folder(self, folder: Path, parent: ProjectScript) -> None:
        """Read the CMakeLists.txt of a folder as a subfolder of another one, unless it was read before."""
        if str(folder) in self._visited:
            return
        self._visited.add(str(folder))
        self.targets.forget()
        parent.inner(folder).read(folder / FILE)

    def has_used(self, name: str) -> bool:
        """Return True if files refer to a folder of `targets_in`, by its target or by its NAME_MISSION_DIR."""
        return name in self._used

    def use(self, name: str) -> None:
        """Record that a file refers to an application or library by name."""
        self._used.add(name)
        if name not in self.targets_in and name not in self.targets.all and name not in self.absent:
            self.absent.append(name)

    def _from_folder(self, name: str) -> Target | None:
        self._used.add(name)
        folder = self.targets_in.get(name)
        if folder is None or self.root is None:
            return None
        if str(folder) not in self._visited and os.path.isfile(folder / FILE):
            self.add_folder(folder, self.root)
        if name not in self.targets.all:  # a folder without a file, or whose target has another name
            return self._by_convention(name, folder)
        return self.targets.all[name]

    def _by_convention(self, name: str, folder: Path) -> Target | None:
        """Make the target of a neighbour by the usual folders of its headers."""
        made = next((each for each in self.targets.all.values() if each.folder == str(folder)), None)
        if made is None:
            made = Target(name, INTERFACE, str(folder))
            named = [str(folder / each) for each in HEADER_FOLDERS if os.path.isdir(folder / each)]
            made.properties[f"INTERFACE_{INCLUDES}"] = named
        self.targets.all[name] = made
        return made


class ProjectScript(CMakeScript):
    """Executes the files of one folder.

    Args:
        project: the shared state.
        folder: of the file.
        variables: variables that are already set.
        settings: the folder's inherited settings.
        parent: the script of the folder that adds this one.
    """

    def __init__(
        self,
        project: Project,
        folder: Path,
        variables: Mapping[str, Sequence[str]],
        settings: Directory | None = None,
        parent: ProjectScript | None = None,
    ) -> None:
        here = [str(folder)]
        known = {**variables, "CMAKE_CURRENT_SOURCE_DIR": here, "CMAKE_CURRENT_LIST_DIR": here}
        super().__init__(folder, known, project.budget, parent)
        self.project = project
        self.settings = Directory() if settings is None else settings
        self._made: list[Target] = []
        self.follows_subfolders = True

    def inner(self, folder: Path) -> ProjectScript:
        """Return the script of a subfolder."""
        return ProjectScript(self.project, folder, self.variables, self.settings.copy(), self)

    def read(self, file: Path) -> None:
        """Execute a file of this folder, and give its targets the folder's settings."""
        with self._ending(file):
            self.run(_text_of(file))
        self._settle()

    def _settle(self) -> None:
        for target in self._made:
            target.properties[INCLUDES] = [*target.properties.get(INCLUDES, []), *self.settings.includes]
            target.properties[DEFINITIONS] = [*self.settings.definitions, *target.properties.get(DEFINITIONS, [])]
            target.properties[LINKS] = [*self.settings.libraries, *target.properties.get(LINKS, [])]
        self._made.clear()

    def include(self, file: Path) -> None:
        """Execute another file in this folder's scope."""
        before = self.variables.get("CMAKE_CURRENT_LIST_DIR", [])
        self.variables["CMAKE_CURRENT_LIST_DIR"] = [str(file.parent)]
        with self._ending(file):
            self.run(_text_of(file))
        self.variables["CMAKE_CURRENT_LIST_DIR"] = before

    @contextmanager
    def _ending(self, file: Path) -> Iterator[None]:
        variables, parents = self.variables, list(self._parents)
        try:
            yield
        except _EndedFile as error:
            self.variables, self._parents = variables, parents  # it may have been in a function
            self.project.note("error", file.parent, str(error))

    # -- the language --------------------------------------------------------------------------------------------------

    def _value(self, name: str) -> str:
        if name.endswith(_MISSION_DIR):
            self.project.use(name.removesuffix(_MISSION_DIR))
        if name not in self.variables and name in self.project.cache:
            return ";".join(self.project.cache[name])
        return super()._value(name)

    def knows(self, kind: str, name: str) -> bool:
        return name in self.project.targets.all if kind == "TARGET" else super().knows(kind, name)

    def glob(self, pattern: str, deep: bool = False) -> list[str]:
        """Return the absolute paths of files of a pattern, which may be absolute itself."""
        relative = os.path.relpath(pattern, self.folder) if pattern.startswith("/") else pattern
        return [os.path.normpath(self.folder / each) for each in super().glob(relative, deep)]

    def _path(self, word: str) -> Path:
        return Path(os.path.normpath(self.folder / word))

    def command(self, name: str, words: list[str]) -> None:
        match name, words:
            case "project", [project, *_]:
                here = [str(self.folder)]
                self.variables |= {"PROJECT_NAME": [project], "PROJECT_SOURCE_DIR": here}
                self.project.cache |= {f"{project}_SOURCE_DIR": here, f"{project}_BINARY_DIR": here}
            case "message", [kind, *text] if "ERROR" in kind:
                raise _EndedFile(" ".join(text))
            case "include", [file, *rest]:
                self._include(file, rest)
            case "add_subdirectory", [folder, *_] if self.follows_subfolders:
                self._add_subdirectory(self._path(folder))
            case "include_directories", folders:
                found = list(absolute(str(self.folder), [each for each in folders if each not in SCOPES]))
                self.settings.includes += [each for each in found if each not in self.settings.includes]
            case "add_definitions" | "add_compile_definitions" | "add_compile_options", flags:
                self.settings.definitions += _definitions(flags, name == "add_compile_definitions")
            case "link_libraries", names:
                self.settings.libraries += names
            case "install", [kind, *rest]:
                self._install(kind, rest)
            case "file", ["WRITE" | "APPEND" as kind, path, *texts]:
                before = self.project.written.get(path, "") if kind == "APPEND" else ""
                self.project.written[path] = before + "".join(texts)
                self.budget.spend(len(self.project.written[path]))
            case "execute_process", rest:
                self._not_executed(rest)
            case "add_custom_command", rest:
                self._custom_command(rest)
            case _, [found, *_] if name in _FIND:
                self.project.note("package", self.folder, found)
            case _:
                if not self._of_cfs(name, words) and not self._of_target(name, words):
                    super().command(name, words)

    def _include(self, file: str, rest: Sequence[str]) -> None:
        path = self._path(file)
        if os.path.isfile(path):
            with self.budget.inside():
                self.include(path)
        elif "OPTIONAL" not in rest and "/" in file:
            self.project.note("missing file", self.folder, str(path))

    def _add_subdirectory(self, folder: Path) -> None:
        if not os.path.isfile(folder / FILE):
            self.project.note("missing folder", self.folder, str(folder))
            return
        with self.budget.inside():
            self.project.add_folder(folder, self)

    def _install(self, kind: str, rest: list[str]) -> None:
        match kind, rest:
            case "SCRIPT", [file, *_] if os.path.isfile(self._path(file)):
                self.include(self._path(file))
            case "CODE", [text, *_]:
                with self._ending(self.folder / FILE):
                    self.run(text)
            case "FILES", files if "DESTINATION" in files:
                self.project.installed += [str(self._path(each)) for each in files[: files.index("DESTINATION")]]

    def _not_executed(self, words: list[str]) -> None:
        self.project.note("command", self.folder, f"execute_process({' '.join(words)})")
        for at, word in enumerate(words[:-1]):
            if word in ("OUTPUT_VARIABLE", "ERROR_VARIABLE"):
                self.variables[words[at + 1]] = []
            elif word == "RESULT_VARIABLE":
                self.variables[words[at + 1]] = ["0"]

    def _custom_command(self, words: list[str]) -> None:
        if "OUTPUT" not in words:
            return
        start = words.index("OUTPUT") + 1
        outputs = []
        for each in words[start:]:
            if each in _KEYS:
                break
            outputs.append(each)
        command = " ".join(words[words.index("COMMAND") + 1 :]) if "COMMAND" in words else ""
        for each in outputs:
            self.project.generated[str(self._path(each))] = command

    # -- cFS's functions -----------------------------------------------------------------------------------------------

    def _of_cfs(self, name: str, words: list[str]) -> bool:
        match name, words:
            case "add_cfe_app", [app, *sources]:
                if app not in self.project.targets.all:
                    self._add(app, MODULE, sources).is_application = True
                    self._add(f"{app}.table", INTERFACE, [])
            case "add_cfe_tables", [of, *tables]:
                self.project.tables.append(TableCall(of, str(self.folder), tables, self.settings))
            case "add_cfe_app_dependency", [app, *names]:
                target = self.project.targets.all.get(app)
                if target is not None:
                    for each in names:
                        self.project.use(each)
                        target.add(INCLUDES, [f"$<TARGET_PROPERTY:{each},INTERFACE_{INCLUDES}>"])
                        target.add(DEFINITIONS, [f"$<TARGET_PROPERTY:{each},INTERFACE_{DEFINITIONS}>"])
                        target.add(f"INTERFACE_{INCLUDES}", [f"$<TARGET_PROPERTY:{each},INTERFACE_{INCLUDES}>"])
                        target.add("CFE_DEPENDENCIES", [each])
            case "generate_configfile_set", names:
                here = "".join(self.variables.get("CMAKE_CURRENT_LIST_DIR", [])) or str(self.folder)
                for each in names:
                    default = f"{here}/config/default_{each}"
                    self._header(each, default if os.path.isfile(default) else None)
            case "generate_config_includefile", [first, *rest]:
                self._config_header(first, rest)
            case _:
                return False
        return True

    def _config_header(self, first: str, rest: list[str]) -> None:
        words = [first, *rest]
        if "FILE_NAME" in words[:-1]:
            file = words[words.index("FILE_NAME") + 1]
            fallback = words[words.index("FALLBACK_FILE") + 1] if "FALLBACK_FILE" in words[:-1] else None
            path = None if fallback is None else str(self._path(fallback))
            self._header(file, path if path is not None and os.path.isfile(path) else None)

    def _header(self, name: str, default: str | None) -> None:
        if self.project.headers.get(name) is None:
            self.project.headers[name] = default
        if not self.variables.get("IS_CFS_ARCH_BUILD"):
            self.project.mission_headers.add(name)

    # -- targets -------------------------------------------------------------------------------------------------------

    def _of_target(self, name: str, words: list[str]) -> bool:
        match name, words:
            case "add_library" | "add_executable", [target, *rest]:
                self._library(target, rest, name == "add_library")
                return True
            case "set_property", ["TARGET", target, *rest] if "PROPERTY" in rest[:-1]:
                at = rest.index("PROPERTY") + 1
                return self._property_of(target, rest[at], rest[at + 1 :])
            case "get_target_property", [into, target, key]:
                one = self.project.targets.get(target)
                found = [] if one is None else one.properties.get(key, [])
                self.variables[into] = list(found) or [f"{into}-NOTFOUND"]
                return True
            case "get_directory_property", [into, key]:
                settings = {"INCLUDE_DIRECTORIES": self.settings.includes, DEFINITIONS: self.settings.definitions}
                self.variables[into] = list(settings.get(key, []))
                return True
            case _, [target, *rest] if name.startswith(("target_", "set_target_")):
                return self._setting(name, target, rest)
        return False

    def _setting(self, name: str, target_name: str, words: list[str]) -> bool:
        target = self.project.targets.get(target_name)
        if target is None:
            self.project.note("missing target", self.folder, target_name)
            return True
        kinds = {
            "target_include_directories": INCLUDES,
            "target_compile_definitions": DEFINITIONS,
            "target_compile_options": DEFINITIONS,
            "target_link_libraries": LINKS,
        }
        if name == "target_sources":
            target.sources += absolute(str(self.folder), [each for each in words if each not in SCOPES])
        elif name == "set_target_properties" and "PROPERTIES" in words:
            pairs = words[words.index("PROPERTIES") + 1 :]
            for key, value in zip(pairs[::2], pairs[1::2], strict=False):
                self._property_of(target_name, key, [value])
        elif name in kinds:
            scope = "PUBLIC" if target.kind != INTERFACE else "INTERFACE"
            for each in words:
                if each in SCOPES:
                    scope = each if each in ("PUBLIC", "PRIVATE", "INTERFACE") else scope
                else:
                    self._used(target, kinds[name], scope, each, name)
        return True

    def _used(self, target: Target, key: str, scope: str, word: str, command: str) -> None:
        if key == INCLUDES:
            found = list(absolute(str(self.folder), [word]))
        elif key == DEFINITIONS:
            found = _definitions([word], command == "target_compile_definitions")
        else:
            found = [word]
        if scope != "INTERFACE":
            target.add(key, found)
        if scope != "PRIVATE":
            target.add(f"INTERFACE_{key}", found)

    def _property_of(self, name: str, key: str, values: list[str]) -> bool:
        target = self.project.targets.get(name)
        if target is not None:
            target.add(key, values)
        return True

    def _library(self, name: str, words: list[str], is_library: bool) -> None:
        if "ALIAS" in words[:1]:
            other = self.project.targets.get(words[1]) if len(words) > 1 else None
            if other is not None:
                self.project.targets.all[name] = other
            return
        if name in self.project.targets.all or "IMPORTED" in words or not is_library:
            return
        kind = next((each for each in words if each in KINDS), STATIC)
        self._add(name, kind, [each for each in words if each not in (*KINDS, *_NOT_SOURCES)])

    def _add(self, name: str, kind: str, sources: Sequence[str]) -> Target:
        target = Target(name, kind, str(self.folder), list(absolute(str(self.folder), sources)))
        self.project.targets.all[name] = target
        self._made.append(target)
        return target


def _text_of(file: Path) -> str:
    try:
        return text_limited(file, CMAKE_BYTES, "replace")
    except OSError as error:
        raise unreadable(file, error) from None


def _definitions(words: Sequence[str], plain: bool) -> list[str]:
    """Return the definitions among flags. With `plain` all words are definitions, with or without `-D`."""
    if plain:
        return [each.removeprefix("-D") for each in words]
    return [each.removeprefix("-D") for each in words if each.startswith("-D")]

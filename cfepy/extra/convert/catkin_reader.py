"""Reads the CMakeLists.txt of a catkin package, also in the forms of rosbuild and catkin_simple, as CMake reads it.

CMake itself is not started, because it executes the commands of a file. The reader finds no packages: one that a file
requires counts as found, and its libraries have its name.
"""

from __future__ import annotations

import os
from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeVar

from cfepy.extra.c import CMakeBudget, CMakeScript, GeneratorExpressions, split_list, version_of
from cfepy.extra.convert.configured_headers import HEADERS, configured_text
from cfepy.extra.convert.cpp_package import CppPackage, CppTarget
from cfepy.reading.input_files import text_limited
from cfepy.reading.input_limits import CMAKE_BYTES

T = TypeVar("T", bound=Hashable)

FILE = "CMakeLists.txt"
EIGEN = "/usr/include/eigen3"
_SYSTEM = ("/usr/include", "/usr/include/x86_64-linux-gnu", "/usr/include/aarch64-linux-gnu")
TESTING = {
    "CATKIN_ENABLE_TESTING": ["1"],
    "GTEST_FOUND": ["1"],
    "GTEST_LIBRARIES": ["gtest"],
    "GTEST_MAIN_LIBRARIES": ["gtest_main"],
    "GMOCK_LIBRARIES": ["gmock"],
    "GMOCK_MAIN_LIBRARIES": ["gmock_main"],
}
"""Variables of a build with tests."""
_PLACES = ("PUBLIC", "PRIVATE", "INTERFACE", "BEFORE", "AFTER", "SYSTEM")
_LINKS = ("debug", "optimized", "general", "LINK_PUBLIC", "LINK_PRIVATE", "LINK_INTERFACE_LIBRARIES", *_PLACES)
_KINDS = ("STATIC", "SHARED", "MODULE", "OBJECT", "INTERFACE", "UNKNOWN", "EXCLUDE_FROM_ALL", "WIN32", "MACOSX_BUNDLE")
_FOUND_ANYWAY = ("catkin", "Boost", "Eigen3", "Eigen", "Threads")
_NO_LIBRARIES = ("catkin", "Boost", "Eigen3", "Eigen", "Threads", "cmake_modules")
_NO_EXPORT = "NO_AUTO_EXPORT"
_SIMPLE_FLAGS = ("NO_AUTO_LINK", "NO_AUTO_DEP", _NO_EXPORT)
_SUFFIX_VERSION = "3.20"
"""From this version on, CMake wants the suffixes of sources (its policy CMP0115)."""
_EACH = 20  # characters that a folder or a definition of a target counts for
_EXECUTABLES = ("add_executable", "cs_add_executable", "rosbuild_add_executable", "cuda_add_executable")
_LIBRARIES = ("add_library", "cs_add_library", "rosbuild_add_library", "cuda_add_library")
_TESTS = (
    "catkin_add_gtest",
    "catkin_add_gmock",
    "catkin_add_executable_with_gtest",
    "catkin_add_executable_with_gmock",
)
_ROSTESTS = ("add_rostest_gtest", "add_rostest_gmock")
_OF_TARGETS = (
    *("target_link_libraries", "target_include_directories", "target_compile_definitions", "target_compile_options"),
    *("target_sources", "set_target_properties", "rosbuild_link_boost", "rosbuild_add_compile_flags"),
)
_BUILT_IN = (
    *(*_EXECUTABLES[:1], *_LIBRARIES[:1], *_OF_TARGETS[:6], "add_compile_options", "add_compile_definitions"),
    *("include_directories", "link_directories", "list", "string", "set", "find_package", "include", "install"),
)
"""Commands that `if(COMMAND ...)` knows."""


@dataclass(slots=True)
class _Target:
    """A target while the file is read.

    Attributes:
        target: the target, with sources as written.
        includes, definitions: as written, with generator expressions.
        scope: of the folder that has it.
    """

    target: CppTarget
    scope: _Scope
    includes: list[str] = field(default_factory=list)
    definitions: list[str] = field(default_factory=list)


@dataclass(slots=True)
class _Scope:
    """The settings of a folder for all its targets.

    Attributes:
        folder: the folder.
        includes, definitions: as written.
    """

    folder: Path
    includes: list[str] = field(default_factory=list)
    definitions: list[str] = field(default_factory=list)


class CatkinReader(CMakeScript):
    """Reads the CMakeLists.txt of a package and of its subfolders.

    Args:
        package: receives the results.
        folder: of the file.
        variables: variables that are already set.
        budget: the remaining budget of the including file; None for the package's own.
        outer: the reader of the including folder.
    """

    def __init__(
        self,
        package: CppPackage,
        folder: Path,
        variables: Mapping[str, Sequence[str]] | None = None,
        budget: CMakeBudget | None = None,
        outer: CatkinReader | None = None,
    ) -> None:
        root = str(package.folder)
        known = {"PROJECT_NAME": [package.name], "CMAKE_PROJECT_NAME": [package.name], "UNIX": ["1"]}
        known |= {"CMAKE_SYSTEM_NAME": ["Linux"], "CMAKE_COMPILER_IS_GNUCXX": ["1"], "CMAKE_CXX_COMPILER_ID": ["GNU"]}
        known |= {"CMAKE_C_COMPILER_ID": ["GNU"], "CMAKE_VERSION": ["3.25.1"], "CMAKE_SYSTEM_PROCESSOR": ["x86_64"]}
        known |= {"PROJECT_SOURCE_DIR": [root], "CMAKE_SOURCE_DIR": [root], "CMAKE_CXX_COMPILER_VERSION": ["12.2.0"]}
        known |= {"CMAKE_BINARY_DIR": [f"{root}/build"], "PROJECT_BINARY_DIR": [f"{root}/build"]}
        known |= {"CATKIN_DEVEL_PREFIX": [f"{root}/devel"], "CMAKE_SIZEOF_VOID_P": ["8"], "CMAKE_HOST_UNIX": ["1"]}
        known |= {"CATKIN_GLOBAL_INCLUDE_DESTINATION": ["include"]}
        known |= {"CATKIN_PACKAGE_INCLUDE_DESTINATION": [f"include/{package.name}"]}
        known |= {f"CMAKE_CXX_FLAGS_{each}": ["-DNDEBUG"] for each in ("RELEASE", "RELWITHDEBINFO", "MINSIZEREL")}
        known |= {name: list(values) for name, values in (variables or {}).items()}
        place = f"{root}/build" if outer is None else f"{root}/build/{os.path.relpath(folder, package.folder)}"
        known |= {"CMAKE_CURRENT_SOURCE_DIR": [str(folder)], "CMAKE_CURRENT_LIST_DIR": [str(folder)]}
        known |= {"CMAKE_CURRENT_BINARY_DIR": [place]}
        super().__init__(folder, known, budget, outer)
        self._package = package
        self._tests = "CATKIN_ENABLE_TESTING" in known
        self._scope = _Scope(folder)
        self._made: dict[str, _Target] = {} if outer is None else outer._made
        self._aliases: dict[str, str] = {} if outer is None else outer._aliases
        if outer is not None:
            self._grow(self._scope.includes, (os.path.join(outer.folder, each) for each in outer._scope.includes))
            self._grow(self._scope.definitions, outer._scope.definitions)

    def read(self, file: Path) -> None:
        """Execute the file of the package, and give each target the settings of its folder."""
        self.run(text_limited(file, CMAKE_BYTES, "replace"))
        self._end_scope()
        expressions = GeneratorExpressions(
            self._made.__contains__, self._property, "".join(self.variables.get("CMAKE_BUILD_TYPE", []))
        )
        for each in self._made.values():
            self._finish(each, expressions)
        for aliased, name in self._aliases.items():
            if name in self._package.targets:
                self._package.targets[aliased] = self._package.targets[name]

    def _end_scope(self) -> None:
        kinds = ("", *(f"_{each.upper()}" for each in self.variables.get("CMAKE_BUILD_TYPE", [])))
        flags = " ".join(flag for kind in kinds for flag in self.variables.get(f"CMAKE_CXX_FLAGS{kind}", [])).split()
        self._scope.definitions += [each[2:] for each in flags if each.startswith("-D")]

    def _finish(self, made: _Target, expressions: GeneratorExpressions) -> None:
        target, scope = made.target, made.scope
        self.spend(_EACH * (len(scope.includes) + len(scope.definitions)))
        target.sources = expressions.words(target.sources)
        target.links = [*expressions.words(target.links), *_objects(target.sources)]
        includes = expressions.words([*made.includes, *scope.includes])
        self._grow(target.includes, self._existing(target.folder, includes))
        self._grow(target.definitions, expressions.words([*made.definitions, *scope.definitions]))

    def _property(self, name: str, which: str) -> str:
        made = self._made.get(self._aliases.get(name, name))
        if made is None:
            return ""
        values = {"SOURCES": made.target.sources, "LINK_LIBRARIES": made.target.links, "NAME": [made.target.name]}
        for prefix in ("", "INTERFACE_"):
            values[f"{prefix}INCLUDE_DIRECTORIES"] = made.includes
            values[f"{prefix}COMPILE_DEFINITIONS"] = made.definitions
        found = ";".join(each for each in values.get(which, []) if "$<" not in each)
        self.spend(len(found))
        return found

    def _grow(self, found: list[T], more: Iterable[T]) -> None:
        """Add missing items to a list, and charge the budget for the search."""
        self.spend(len(found))
        known = set(found)
        found += [each for each in dict.fromkeys(more) if each not in known]

    # -- commands ------------------------------------------------------------------------------------------------------

    def knows(self, kind: str, name: str) -> bool:
        """Return True if there is such a TARGET or COMMAND. All policies are known."""
        if kind == "TARGET":
            return name in self._made or name in self._aliases
        return kind == "POLICY" or name.lower() in _BUILT_IN or super().knows(kind, name)

    def command(self, name: str, words: list[str]) -> None:
        match name, words:
            case "project", [project, *_]:
                self.variables["PROJECT_NAME"] = [project]
            case "cmake_minimum_required", ["VERSION", version, *_]:
                self.variables["CMAKE_MINIMUM_REQUIRED_VERSION"] = [version.rpartition("...")[2]]
            case "find_package" | "pkg_check_modules" | "pkg_search_module", [found, *rest]:
                self._find(found, rest, is_package=name == "find_package")
            case "find_library" | "find_path" | "find_file" | "find_program", [variable, *_]:
                self.variables.setdefault(variable, [f"{variable}-NOTFOUND"])
            case "check_include_file" | "check_include_file_cxx", [header, variable, *_]:
                self.variables[variable] = (
                    ["1"] if any(os.path.isfile(f"{each}/{header}") for each in _SYSTEM) else [""]
                )
            case "check_function_exists", [_, variable]:
                self.variables[variable] = ["1"]
            case "check_symbol_exists" | "check_cxx_symbol_exists", [_, _, variable]:
                self.variables[variable] = ["1"]
            case "catkin_package" | "cs_export", rest:
                self._export(rest, is_simple=name == "cs_export")
            case "catkin_simple", _:
                self._begin_simple()
            case _, [target, *sources] if name in _EXECUTABLES:
                self._add(target, sources, is_library=False)
            case _, [target, *sources] if name in _LIBRARIES:
                self._add(target, sources, is_library=True)
                if name == "cs_add_library" and _NO_EXPORT not in sources:
                    self.variables.setdefault(self._simple_libraries, []).append(target)
            case _, [target, *sources] if name in _TESTS and self._tests:
                self._add(target, sources, is_library=False)
            case _, [target, _, *sources] if name in _ROSTESTS and self._tests:
                self._add(target, sources, is_library=False)
            case "add_subdirectory", [inner, *_] if os.path.isfile(self.folder / inner / FILE):
                self._enter(self.folder / inner)
            case "include", [file, *_]:
                self._include(file)
            case "configure_file", [template, made, *options]:
                self._configure(template, made, options)
            case "include_directories", folders:
                self._grow(self._scope.includes, (each for each in folders if each not in _PLACES))
            case "add_definitions" | "add_compile_options" | "add_compile_definitions", flags:
                self._scope.definitions += _definitions(flags, plain=name == "add_compile_definitions")
            case "set_property", ["TARGET", *rest] if "PROPERTY" in rest:
                self._set_property(rest[: rest.index("PROPERTY")], rest[rest.index("PROPERTY") + 1 :])
            case "get_target_property", [variable, target, which]:
                self._get_property(variable, target, which)
            case "get_property", [variable, "TARGET", target, "PROPERTY", which, *_]:
                self._get_property(variable, target, which)
            case _, [target, *rest] if name in _OF_TARGETS:
                self._of_target(name, target, rest)
            case _:
                super().command(name, words)

    def glob(self, pattern: str, deep: bool = False) -> list[str]:
        """Return files of a pattern, which may begin with the path of a folder near the package; absolute paths."""
        if pattern.startswith("/"):
            near = os.path.commonpath([os.path.normpath(pattern.partition("*")[0]), self.folder])
            if not self._package.folder.is_relative_to(near) or near == "/":
                return []
            pattern = os.path.relpath(pattern, self.folder)
        found = [str(self.folder / each) for each in super().glob(pattern, deep)]
        self.spend(sum(map(len, found)))
        return [each for each in found if not deep or os.path.isfile(each)]

    def _enter(self, folder: Path) -> None:
        reader = CatkinReader(self._package, folder, self.variables, self.budget, self)
        reader.run(text_limited(folder / FILE, CMAKE_BYTES, "replace"))
        reader._end_scope()

    def _include(self, name: str) -> None:
        """Execute another file, which is named or is a module of the package."""
        places = [Path(each) / f"{name}.cmake" for each in self.variables.get("CMAKE_MODULE_PATH", [])]
        file = next((each for each in (self.folder / name, *places) if os.path.isfile(self.folder / each)), None)
        if file is None or not (self.folder / file).is_relative_to(self._package.folder.parent):
            return
        before = self.variables["CMAKE_CURRENT_LIST_DIR"]
        self.variables["CMAKE_CURRENT_LIST_DIR"] = [str((self.folder / file).parent)]
        self.run(text_limited(self.folder / file, CMAKE_BYTES, "replace"))
        self.variables["CMAKE_CURRENT_LIST_DIR"] = before

    def _configure(self, given: str, output: str, options: Sequence[str]) -> None:
        """Record a header that is made from a template of the package or of one beside it."""
        template = Path(os.path.normpath(self.folder / given))
        made = Path(os.path.normpath(Path(self.variables["CMAKE_CURRENT_BINARY_DIR"][0]) / output))
        made = made / template.name if output.endswith("/") or os.path.isdir(made) else made
        root = self._package.folder
        if made.suffix not in HEADERS or not made.is_relative_to(root) or not template.is_relative_to(root.parent):
            return
        if os.path.isfile(template):
            text = configured_text(text_limited(template, CMAKE_BYTES, "replace"), self.variables, options)
            self.spend(len(text or ""))
            if text is not None:
                self._package.configured[made] = text

    def _of_target(self, name: str, given: str, words: Sequence[str]) -> None:
        made = self._made.get(self._aliases.get(given, given))
        if name == "set_target_properties" and "PROPERTIES" in words:
            at = words.index("PROPERTIES")
            for key, value in zip(words[at + 1 :: 2], words[at + 2 :: 2], strict=False):
                self._set_property([given, *words[:at]], [key, value])
            return
        if made is None:
            return
        rest = [each for each in words if each not in (_LINKS if name == "target_link_libraries" else _PLACES)]
        match name:
            case "target_link_libraries":
                self._grow(made.target.links, rest)
            case "target_include_directories":
                self._grow(made.includes, rest)
            case "target_compile_definitions":
                made.definitions += _definitions(rest, plain=True)
            case "target_compile_options" | "rosbuild_add_compile_flags":
                made.definitions += _definitions(rest)
            case "target_sources":
                made.target.sources += [os.path.join(self.folder, each) if "$<" not in each else each for each in rest]

    def _set_property(self, names: Sequence[str], words: Sequence[str]) -> None:
        for name in names:
            made = self._made.get(self._aliases.get(name, name))
            match words:
                case _ if made is None:
                    continue
                case ["OUTPUT_NAME" | "RUNTIME_OUTPUT_NAME", file]:
                    made.target.file_name = file
                case ["COMPILE_DEFINITIONS", *values]:
                    made.definitions += _definitions(split_list(";".join(values)), plain=True)
                case ["COMPILE_FLAGS" | "COMPILE_OPTIONS", *values]:
                    made.definitions += _definitions(split_list(";".join(values)))
                case ["INCLUDE_DIRECTORIES", *values]:
                    self._grow(made.includes, split_list(";".join(values)))

    def _get_property(self, variable: str, target: str, which: str) -> None:
        found = split_list(self._property(target, which))
        self.variables[variable] = found or [f"{variable}-NOTFOUND"]

    def _add(self, name: str, words: list[str], is_library: bool) -> None:
        if words[:1] == ["ALIAS"] and len(words) > 1:
            self._aliases[name] = words[1]
        if "IMPORTED" in words or words[:1] == ["ALIAS"]:
            return
        version = ".".join(self.variables.get("CMAKE_MINIMUM_REQUIRED_VERSION", []))
        target = CppTarget(
            name, self.folder, is_library, [each for each in words if each not in (*_KINDS, *_SIMPLE_FLAGS)]
        )
        target.needs_suffixes = version_of(version) >= version_of(_SUFFIX_VERSION)
        self._package.targets[name] = target
        self._made[name] = _Target(target, self._scope)

    def _find(self, name: str, rest: list[str], is_package: bool) -> None:
        """Define a package that CMake would find: its libraries have its name, its headers stay in place."""
        if is_package and name == "catkin":
            marks = ("REQUIRED", "COMPONENTS", "OPTIONAL_COMPONENTS", "QUIET", "EXACT")
            self._grow(self._package.depends, (each for each in rest if each not in marks and each[:1].isalpha()))
        if "REQUIRED" not in rest and name not in _FOUND_ANYWAY:
            return
        names = [name] if is_package else [each for each in rest if each not in ("REQUIRED", "QUIET")]
        headers = [EIGEN] if name in ("Eigen3", "Eigen") else []
        for prefix in dict.fromkeys((name, name.upper())):
            self.variables[f"{prefix}_FOUND"] = ["1"]
            self.variables[f"{prefix}_LIBRARIES"] = [] if name in _NO_LIBRARIES else names
            self.variables[f"{prefix}_INCLUDE_DIRS"] = self.variables[f"{prefix}_INCLUDE_DIR"] = headers

    def _begin_simple(self) -> None:
        """Execute catkin_simple's command: the package's own headers are found."""
        if os.path.isdir(self.folder / "include"):
            self._grow(self._scope.includes, ["include"])

    @property
    def _simple_libraries(self) -> str:
        """The variable with the libraries that catkin_simple exports."""
        return f"{self.variables['PROJECT_NAME'][0]}_LIBRARIES"

    def _export(self, words: list[str], is_simple: bool) -> None:
        """Record the exports of `catkin_package` for other packages. catkin_simple exports its libraries."""
        said: dict[str, list[str]] = {}
        section = ""
        for each in words:
            if each in ("INCLUDE_DIRS", "LIBRARIES", "CATKIN_DEPENDS", "DEPENDS", "CFG_EXTRAS", "EXPORTED_TARGETS"):
                section = each
            elif each != "SKIP_CMAKE_CONFIG_GENERATION":
                said.setdefault(section, []).append(each)
        headers = [EIGEN] if {"EIGEN3", "EIGEN", "Eigen3", "Eigen"}.intersection(said.get("DEPENDS", [])) else []
        own = ["include"] if is_simple and os.path.isdir(self.folder / "include") else []
        folders = [*own, *said.get("INCLUDE_DIRS", []), *headers]
        self._grow(self._package.includes, self._existing(self.folder, folders))
        libraries = self.variables.get(self._simple_libraries, []) if is_simple else []
        self._grow(self._package.exported, [*libraries, *said.get("LIBRARIES", [])])
        self._grow(self._package.depends, said.get("CATKIN_DEPENDS", []))

    def _existing(self, folder: Path, words: Iterable[str]) -> list[Path]:
        """Return the folders that exist, or that CMake makes."""
        named = [folder / each for each in words if "$" not in each]
        made = [self._package.folder / each for each in ("build", "devel")]
        return [each for each in named if os.path.isdir(each) or any(map(each.is_relative_to, made))]


def _objects(sources: list[str]) -> list[str]:
    """Return the object libraries among sources, and take them out."""
    marks = [each for each in sources if each.startswith("$<TARGET_OBJECTS:")]
    sources[:] = [each for each in sources if "$<" not in each]
    return [each.partition(":")[2].rstrip(">") for each in marks]


def _definitions(flags: Iterable[str], plain: bool = False) -> list[str]:
    """Return the definitions among flags; with `plain` a word without -D is one too."""
    words = [word for flag in flags for word in ([flag] if plain or "$<" in flag else flag.split())]
    return [
        each.replace("-D", "") if "$<" in each else each.removeprefix("-D")
        for each in words
        if plain or each.startswith("-D") or ("$<" in each and "-D" in each)
    ]

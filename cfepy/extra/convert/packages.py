"""A catkin package's C++ side: its executables and libraries, and the sources of each.

It is read from package.xml and CMakeLists.txt, also in the forms of rosbuild and catkin_simple; nothing is built. A
linked library belongs to the package, to a nearby package, or comes from outside; outside libraries are listed by name.
"""

from __future__ import annotations

import os
import re
from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from cfepy.extra.c import CMakeBudget, CMakeScript
from cfepy.reading.input_files import read_limited, text_limited
from cfepy.reading.input_limits import CMAKE_BYTES, CPP_FILES, XML_BYTES
from cfepy.reading.plain_xml import XmlError, plain_xml
from cfepy.reading.suggestions import expected
from cfepy.status import UsageError
from rospy_shim.types.msgs import Packages, check_package_name

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

T = TypeVar("T", bound=Hashable)

FILE = "CMakeLists.txt"
MANIFEST = "package.xml"
SUFFIXES = (".cpp", ".cc", ".cxx", ".c++", ".C", ".c")
NODELET = "nodelet::Nodelet"
EIGEN = "/usr/include/eigen3"
_KEYWORDS = ("PUBLIC", "PRIVATE", "INTERFACE", "BEFORE", "AFTER", "SYSTEM", "debug", "optimized", "general")
_KINDS = ("STATIC", "SHARED", "MODULE", "OBJECT", "INTERFACE", "EXCLUDE_FROM_ALL", "WIN32", "MACOSX_BUNDLE")
_FOUND_ANYWAY = ("catkin", "Boost", "Eigen3", "Eigen", "Threads")
_NO_LIBRARIES = ("catkin", "Boost", "Eigen3", "Eigen", "Threads", "cmake_modules")
_SYSTEM_LIBRARIES = ("m", "pthread", "rt", "dl", "stdc++", "boost_system", "boost_thread", "boost_date_time")
"""Libraries that a node links on Linux, and that its application does not need."""


@dataclass(slots=True)
class CppTarget:
    """An executable or a library of a package.

    Attributes:
        name: its name in the package's CMakeLists.txt.
        folder: of that file; relative sources start there.
        is_library: whether it is a library.
        sources: as written.
        includes: folders of headers, absolute.
        definitions: the compiler's -D, without -D.
        links: linked libraries, as written.
        file_name: of the program, if it differs from the target's name.
    """

    name: str
    folder: Path
    is_library: bool
    sources: list[str] = field(default_factory=list)
    includes: list[Path] = field(default_factory=list)
    definitions: list[str] = field(default_factory=list)
    links: list[str] = field(default_factory=list)
    file_name: str = ""


@dataclass(frozen=True, slots=True)
class PluginClass:
    """A class that a package offers through pluginlib, such as a nodelet.

    Attributes:
        name: the name under which it is loaded, such as "demo/Filter".
        type: of C++, such as "demo::Filter".
        base: the class that it is derived from.
        library: the target that has it.
    """

    name: str
    type: str
    base: str
    library: str


@dataclass(slots=True)
class CppPackage:
    """The C++ contents of a package.

    Attributes:
        name: of the package.
        folder: folder of its package.xml.
        targets: by name.
        includes: folders of headers that others see.
        exported: its libraries that others link with.
        depends: packages that it depends on.
        plugins: classes of pluginlib, by name.
    """

    name: str
    folder: Path
    targets: dict[str, CppTarget] = field(default_factory=dict)
    includes: list[Path] = field(default_factory=list)
    exported: list[str] = field(default_factory=list)
    depends: list[str] = field(default_factory=list)
    plugins: dict[str, PluginClass] = field(default_factory=dict)

    def executables(self) -> list[str]:
        """Return the types of its nodes, sorted."""
        return sorted(each.file_name or each.name for each in self.targets.values() if not each.is_library)

    def nodelets(self) -> dict[str, PluginClass]:
        """Return its nodelets, by the name that pluginlib knows."""
        return {name: each for name, each in self.plugins.items() if each.base.lstrip(":") == NODELET}

    def executable(self, node_type: str) -> CppTarget | None:
        """Return the target for a node's type."""
        found = (each for each in self.targets.values() if (each.file_name or each.name) == node_type)
        return next((each for each in found if not each.is_library), None)


@dataclass(slots=True)
class Program:
    """The sources and build settings of a node.

    Attributes:
        package: its package.
        type: of the node.
        sources: source files, including the source files of libraries in nearby packages.
        includes: folders of headers, the first searched first.
        definitions: the compiler's -D, without -D.
        outside: linked libraries without sources here, as written.
        nodelet: its C++ class, such as "demo::Filter"; empty for a program.
        support: sources of a library that is compiled with it, which are independent of the program.
    """

    package: CppPackage
    type: str
    sources: list[Path] = field(default_factory=list)
    includes: list[Path] = field(default_factory=list)
    definitions: list[str] = field(default_factory=list)
    outside: list[str] = field(default_factory=list)
    nodelet: str = ""
    support: list[Path] = field(default_factory=list)


def read_package(folder: Path, name: str, testing: bool = False) -> CppPackage:
    """Read a package.

    Args:
        folder: folder of its package.xml.
        name: of the package.
        testing: whether its tests are among its targets, as with catkin's CATKIN_ENABLE_TESTING.

    Returns:
        Its contents; no C++ when it has no CMakeLists.txt.

    Raises:
        UsageError: its manifest has an invalid package name, or its CMakeLists.txt exceeds the limits.
    """
    check_package_name(folder)
    package = CppPackage(name, folder)
    manifest = _manifest(folder)
    package.depends = _depends(manifest)
    file = folder / FILE
    if os.path.isfile(file):
        _CatkinReader(package, folder, _TESTING if testing else None).read(file)
    for plugin in _plugins(manifest, folder):
        package.plugins[plugin.name] = plugin
    return package


def program_of(package: CppPackage, node_type: str, packages: Packages, ours: Iterable[str] = ()) -> Program:
    """Return the sources and build settings of a node.

    Args:
        package: of the node.
        node_type: of the node: an executable, or a nodelet as pluginlib knows it, such as "demo/Filter".
        packages: finds other packages.
        ours: packages that our own headers and libraries replace.

    Raises:
        UsageError: the package has no such target, or one of its sources does not exist.
    """
    plugin = package.nodelets().get(node_type)
    target = package.executable(node_type) if plugin is None else package.targets.get(plugin.library)
    if target is None:
        hint = expected(node_type, [*package.executables(), *package.nodelets()], subject="it has", last="and")
        raise UsageError(f"package {package.name!r} has no C++ node {node_type!r}; {hint}", file=package.folder)
    program = Program(package, node_type, nodelet="" if plugin is None else plugin.type.lstrip(":"))
    program.definitions.append(f'ROS_PACKAGE_NAME="{package.name}"')  # as roscpp's part of catkin does
    _Collector(program, packages, set(ours)).take(package, target)
    return program


class _Collector:
    """Collects the needs of a target, through its linked libraries.

    Args:
        program: receives them.
        packages: finds other packages.
        ours: packages that are skipped.
    """

    def __init__(self, program: Program, packages: Packages, ours: set[str]) -> None:
        self._program = program
        self._packages = packages
        self._ours = ours
        self._read: dict[str, CppPackage] = {program.package.name: program.package}
        self._taken: set[tuple[str, str]] = set()
        self._outside = dict.fromkeys(program.outside)

    def take(self, package: CppPackage, target: CppTarget) -> None:
        """Add a target and all its linked libraries.

        Raises:
            UsageError: one of its sources does not exist, or they are too many.
        """
        open_at = [self._taking(package, target)]
        while open_at:
            inner = next(open_at[-1], None)
            if inner is None:
                open_at.pop()
            else:
                open_at.append(self._taking(*inner))
        self._program.outside = list(self._outside)

    def _taking(self, package: CppPackage, target: CppTarget) -> Iterator[tuple[CppPackage, CppTarget]]:
        """Add a target. Yields the inner targets, each of which must be added before the iteration goes on."""
        if (package.name, target.name) in self._taken:
            return
        self._taken.add((package.name, target.name))
        program = self._program
        _add(program.sources, _files(target))
        if max(len(self._taken), len(program.sources)) > CPP_FILES:
            raise UsageError(f"{program.type} is made of more than {CPP_FILES:,} files; split it", file=package.folder)
        _add(program.includes, [*target.includes, *package.includes])
        _add(program.definitions, target.definitions)
        for name in target.links:
            inner = package.targets.get(name)
            if inner is not None:
                yield package, inner
            elif name not in _SYSTEM_LIBRARIES and not name.startswith(("-", "/")):
                self._outside[name] = None
        for name in package.depends:
            yield from self._dependency(name)

    def _dependency(self, name: str) -> Iterator[tuple[CppPackage, CppTarget]]:
        """Add the headers of a nearby package that this one depends on. Yields its exported libraries."""
        if name in self._ours or name in self._read:
            return
        folder = next((each for each in self._packages.folders(name) if os.path.isfile(each / FILE)), None)
        other = CppPackage(name, Path()) if folder is None else read_package(folder, name)
        self._read[name] = other
        _add(self._program.includes, other.includes)
        for library in other.exported:
            if library in other.targets:
                yield other, other.targets[library]


def _add(found: list[T], more: Iterable[T]) -> None:
    known = set(found)
    found += [each for each in dict.fromkeys(more) if each not in known]


def _files(target: CppTarget) -> list[Path]:
    found = []
    for name in target.sources:
        file = target.folder / name
        if file.suffix not in SUFFIXES:
            continue
        if not os.path.isfile(file):
            raise UsageError(f"{target.name} has a missing source: {name}", file=target.folder / FILE)
        found.append(Path(*file.parts))
    return found


# -- package.xml -------------------------------------------------------------------------------------------------------


def _manifest(folder: Path) -> Element | None:
    """Return the manifest of a package; None if there is no readable one."""
    try:
        return plain_xml(read_limited(folder / MANIFEST, XML_BYTES))
    except (OSError, ValueError):
        return None


def _depends(manifest: Element | None) -> list[str]:
    tags = ("depend", "build_depend", "build_export_depend", "run_depend", "exec_depend")
    found = () if manifest is None else (each for each in manifest if each.tag in tags)
    return list(dict.fromkeys((each.text or "").strip() for each in found))


def _plugins(manifest: Element | None, folder: Path) -> Iterator[PluginClass]:
    exported = () if manifest is None else manifest.iterfind("export/*")
    for each in exported:
        name = each.get("plugin", "").replace("${prefix}/", "")
        try:
            root = _plugin_file(read_limited(folder / name, XML_BYTES)) if name else None
        except (OSError, ValueError):
            continue
        for library in () if root is None else root.iter("library"):
            target = Path(library.get("path", "")).name.removeprefix("lib").removesuffix(".so")
            for one in library.iter("class"):
                type_name = one.get("type", "")
                yield PluginClass(one.get("name") or type_name, type_name, one.get("base_class_type", ""), target)


def _plugin_file(text: bytes) -> Element:
    """Return the contents of a plugin file. pluginlib accepts several libraries in sequence, which is not valid XML."""
    try:
        return plain_xml(text)
    except XmlError:
        return plain_xml(b"<class_libraries>%b</class_libraries>" % _DECLARATION.sub(b"", text, count=1))


_DECLARATION = re.compile(rb"^\s*<\?xml.*?\?>", re.DOTALL)

# -- CMakeLists.txt ----------------------------------------------------------------------------------------------------


_TESTING = {
    "CATKIN_ENABLE_TESTING": ["1"],
    "GTEST_FOUND": ["1"],
    "GTEST_LIBRARIES": ["gtest"],
    "GTEST_MAIN_LIBRARIES": ["gtest_main"],
    "GMOCK_LIBRARIES": ["gmock"],
    "GMOCK_MAIN_LIBRARIES": ["gmock_main"],
}
_EACH = 20  # characters that a folder or a definition of a target counts for
_TESTS = (
    "catkin_add_gtest",
    "catkin_add_gmock",
    "catkin_add_executable_with_gtest",
    "catkin_add_executable_with_gmock",
)
_ROSTESTS = ("add_rostest_gtest", "add_rostest_gmock")


class _CatkinReader(CMakeScript):
    """Reads the CMakeLists.txt of a package and of its subfolders.

    Args:
        package: receives the results.
        folder: of the file.
        variables: variables that are already set.
        budget: the remaining budget of the including file; None for the package's own.
    """

    def __init__(
        self,
        package: CppPackage,
        folder: Path,
        variables: Mapping[str, Sequence[str]] | None = None,
        budget: CMakeBudget | None = None,
    ) -> None:
        here, root = [str(folder)], [str(package.folder)]
        known = {"PROJECT_NAME": [package.name], "CMAKE_PROJECT_NAME": [package.name], "UNIX": ["1"]}
        known |= {"CMAKE_SYSTEM_NAME": ["Linux"], "CMAKE_COMPILER_IS_GNUCXX": ["1"], "CMAKE_CXX_COMPILER_ID": ["GNU"]}
        known |= {"PROJECT_SOURCE_DIR": root, "CMAKE_SOURCE_DIR": root, "CMAKE_VERSION": ["3.25.1"]}
        known |= {name: list(values) for name, values in (variables or {}).items()}
        known |= {"CMAKE_CURRENT_SOURCE_DIR": here, "CMAKE_CURRENT_LIST_DIR": here}
        super().__init__(folder, known, budget)
        self._package = package
        self._tests = "CATKIN_ENABLE_TESTING" in known
        self._includes: list[Path] = []
        self._definitions: list[str] = []
        self._made: list[CppTarget] = []

    def read(self, file: Path) -> None:
        """Execute the file, and give its targets the settings of the whole folder."""
        self.run(text_limited(file, CMAKE_BYTES, "replace"))
        flags = " ".join(self.variables.get("CMAKE_CXX_FLAGS", [])).split()
        self._definitions += [each[2:] for each in flags if each.startswith("-D")]
        for target in self._made:
            self.budget.spend(_EACH * (len(self._includes) + len(self._definitions)))
            self._grow(target.includes, self._includes)
            self._grow(target.definitions, self._definitions)

    def _grow(self, found: list[T], more: Iterable[T]) -> None:
        """Add missing items to a list, and charge the budget for the search."""
        self.budget.spend(len(found))
        _add(found, more)

    def command(self, name: str, words: list[str]) -> None:
        match name, words:
            case "project", [project, *_]:
                self.variables["PROJECT_NAME"] = [project]
            case "find_package" | "pkg_check_modules" | "pkg_search_module", [found, *rest]:
                self._find(found, rest, is_package=name == "find_package")
            case "catkin_package", rest:
                self._export(rest)
            case "add_executable" | "cs_add_executable" | "rosbuild_add_executable", [target, *sources]:
                self._add(target, sources, is_library=False)
            case "add_library" | "cs_add_library" | "rosbuild_add_library", [target, *sources]:
                self._add(target, sources, is_library=True)
            case _, [target, *sources] if name in _TESTS and self._tests:
                self._add(target, sources, is_library=False)
            case _, [target, _, *sources] if name in _ROSTESTS and self._tests:
                self._add(target, sources, is_library=False)
            case "add_subdirectory", [inner, *_] if os.path.isfile(self.folder / inner / FILE):
                reader = _CatkinReader(self._package, self.folder / inner, self.variables, self.budget)
                reader.read(self.folder / inner / FILE)
            case "include_directories", folders:
                self._grow(self._includes, self._folders(folders))
            case "add_definitions" | "add_compile_options" | "add_compile_definitions", flags:
                self._definitions += _definitions(flags, plain=name == "add_compile_definitions")
            case _:
                if not self._of_target(name, words):
                    super().command(name, words)

    def glob(self, pattern: str, deep: bool = False) -> list[str]:
        """Return files of a pattern, which may begin with this folder's path."""
        return super().glob(pattern.removeprefix(f"{self.folder}/"), deep)

    def _of_target(self, name: str, words: list[str]) -> bool:
        """Execute a command for one target. Returns False for other commands."""
        target = self._package.targets.get(words[0]) if words else None
        if target is None or not name.startswith(("target_", "set_target_", "rosbuild_link", "rosbuild_add_compile")):
            return False
        rest = [each for each in words[1:] if each not in _KEYWORDS]
        match name, rest:
            case "target_link_libraries", libraries:
                self._grow(target.links, libraries)
            case "target_include_directories", folders:
                self._grow(target.includes, self._folders(folders))
            case "target_compile_definitions", flags:
                target.definitions += _definitions(flags, plain=True)
            case "target_compile_options" | "rosbuild_add_compile_flags", flags:
                target.definitions += _definitions(flags)
            case "target_sources", sources:
                target.sources += sources
            case "set_target_properties", rest if "OUTPUT_NAME" in rest[:-1]:
                target.file_name = rest[rest.index("OUTPUT_NAME") + 1]
        return True

    def _add(self, name: str, words: list[str], is_library: bool) -> None:
        if words[:1] in (["ALIAS"], ["IMPORTED"]):
            return
        target = CppTarget(name, self.folder, is_library, [each for each in words if each not in _KINDS])
        self._package.targets[name] = target
        self._made.append(target)

    def _folders(self, words: Sequence[str]) -> list[Path]:
        named = [self.folder / each for each in words if each not in _KEYWORDS and "$" not in each]
        return [each for each in named if os.path.isdir(each)]

    def _find(self, name: str, rest: list[str], is_package: bool) -> None:
        """Define a package that CMake would find: its libraries have its name, its headers stay in place."""
        if is_package and name == "catkin":
            marks = ("REQUIRED", "COMPONENTS", "QUIET", "EXACT")
            self._grow(self._package.depends, (each for each in rest if each not in marks and each[:1].isalpha()))
        if "REQUIRED" not in rest and name not in _FOUND_ANYWAY:
            return
        names = [name] if is_package else [each for each in rest if each not in ("REQUIRED", "QUIET")]
        headers = [EIGEN] if name in ("Eigen3", "Eigen") else []
        for prefix in dict.fromkeys((name, name.upper())):
            self.variables[f"{prefix}_FOUND"] = ["1"]
            self.variables[f"{prefix}_LIBRARIES"] = [] if name in _NO_LIBRARIES else names
            self.variables[f"{prefix}_INCLUDE_DIRS"] = self.variables[f"{prefix}_INCLUDE_DIR"] = headers

    def _export(self, words: list[str]) -> None:
        """Record the exports of `catkin_package` for other packages."""
        said: dict[str, list[str]] = {}
        section = ""
        for each in words:
            if each in ("INCLUDE_DIRS", "LIBRARIES", "CATKIN_DEPENDS", "DEPENDS", "CFG_EXTRAS", "EXPORTED_TARGETS"):
                section = each
            else:
                said.setdefault(section, []).append(each)
        headers = [EIGEN] if {"EIGEN3", "EIGEN", "Eigen3", "Eigen"}.intersection(said.get("DEPENDS", [])) else []
        self._grow(self._package.includes, self._folders([*said.get("INCLUDE_DIRS", []), *headers]))
        self._grow(self._package.exported, said.get("LIBRARIES", []))
        self._grow(self._package.depends, said.get("CATKIN_DEPENDS", []))


def _definitions(flags: Iterable[str], plain: bool = False) -> list[str]:
    """Return the definitions among flags; with `plain` a word without -D is one too."""
    words = [word for flag in flags if "$<" not in flag for word in flag.split()]
    return [word.removeprefix("-D") for word in words if word.startswith("-D") or plain]

"""A catkin package's C++ side: its executables and libraries, and the sources of each.

It is read from package.xml and CMakeLists.txt, also in the forms of rosbuild and catkin_simple; nothing is built. A
linked library belongs to the package, to a nearby package, or comes from outside; outside libraries are listed by name.
A library of a nearby package is left out if no file of the node includes a header of that package: catkin links all of
them, and a node needs nothing of this one.
"""

from __future__ import annotations

import os
import re
from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from cfepy.extra.convert.catkin_reader import FILE, CatkinReader
from cfepy.extra.convert.configured_headers import include_folders
from cfepy.extra.convert.cpp_package import CppPackage, CppTarget, PluginClass, Program
from cfepy.extra.convert.cpp_sources import collect
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import CPP_FILES, XML_BYTES
from cfepy.reading.plain_xml import XmlError, plain_xml
from cfepy.reading.suggestions import expected
from cfepy.status import UsageError
from rospy_shim.types.msgs import Packages, check_package_name

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

T = TypeVar("T", bound=Hashable)

MANIFEST = "package.xml"
SUFFIXES = (".cpp", ".cc", ".cxx", ".c++", ".C", ".c")
_TRIED = (".c", ".C", ".c++", ".cc", ".cpp", ".cxx")
"""Suffixes of a source that is written without one, in the order in which CMake tries them."""
_SYSTEM = "/usr"
_SYSTEM_LIBRARIES = ("m", "pthread", "rt", "dl", "stdc++", "boost_system", "boost_thread", "boost_date_time")
"""Libraries that a node links on Linux, and that its application does not need."""


def read_package(folder: Path, name: str, variables: Mapping[str, Sequence[str]] | None = None) -> CppPackage:
    """Read a package.

    Args:
        folder: folder of its package.xml.
        name: of the package.
        variables: set variables of CMake, such as a build with tests has.

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
        CatkinReader(package, folder, variables).read(file)
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
        self._offering: dict[str, CppPackage] = {}  # nearby packages with libraries, none of which is taken yet
        self._outside = dict.fromkeys(program.outside)

    def take(self, package: CppPackage, target: CppTarget) -> None:
        """Add a target and all its linked libraries.

        Raises:
            UsageError: one of its sources does not exist, or they are too many.
        """
        self._take(package, target)
        while used := self._used():
            for name in used:
                other = self._offering.pop(name)
                for library in other.exported:
                    if library in other.targets:
                        self._take(other, other.targets[library])
        self._program.outside = list(self._outside)

    def _take(self, package: CppPackage, target: CppTarget) -> None:
        open_at = [self._taking(package, target)]
        while open_at:
            inner = next(open_at[-1], None)
            if inner is None:
                open_at.pop()
            else:
                open_at.append(self._taking(*inner))

    def _taking(self, package: CppPackage, target: CppTarget) -> Iterator[tuple[CppPackage, CppTarget]]:
        """Add a target. Yields the inner targets, each of which must be added before the iteration goes on."""
        if (package.name, target.name) in self._taken:
            return
        self._taken.add((package.name, target.name))
        program = self._program
        _add(program.sources, source_files(target))
        if max(len(self._taken), len(program.sources)) > CPP_FILES:
            raise UsageError(f"{program.type} is made of more than {CPP_FILES:,} files; split it", file=package.folder)
        _add(program.includes, include_folders(package, [*target.includes, *package.includes]))
        _add(program.definitions, target.definitions)
        for name in target.links:
            inner = package.targets.get(name)
            if inner is not None:
                yield package, inner
            elif name not in _SYSTEM_LIBRARIES and not name.startswith(("-", "/")):
                self._outside[name] = None
        self._see_dependencies(package)

    def _see_dependencies(self, package: CppPackage) -> None:
        """Add the headers of the nearby packages that one depends on, also through others."""
        waiting = list(package.depends)
        for name in waiting:
            if name in self._ours or name in self._read:
                continue
            folder = next((each for each in self._packages.folders(name) if os.path.isfile(each / FILE)), None)
            other = CppPackage(name, Path()) if folder is None else read_package(folder, name)
            self._read[name] = other
            _add(self._program.includes, include_folders(other, other.includes))
            waiting += other.depends
            if any(library in other.targets for library in other.exported):
                self._offering[name] = other

    def _used(self) -> list[str]:
        """Return the names of the offering packages that a file of the program includes a header of.

        All are used if the files cannot be read: the check reports such a file.
        """
        if not self._offering:
            return []
        try:
            files = collect(self._program.sources, self._program.includes).contents
        except (OSError, UsageError):
            return list(self._offering)
        folders = {parent for file in files for parent in Path(os.path.normpath(file)).parents}
        return [name for name, each in self._offering.items() if not folders.isdisjoint(_folders_of(each))]


def _folders_of(package: CppPackage) -> Iterator[Path]:
    """Yield the folder of a package, and the folders of its headers, unless they are the computer's."""
    for each in (package.folder, *include_folders(package, package.includes)):
        if not each.is_relative_to(_SYSTEM):
            yield Path(os.path.normpath(each))


def _add(found: list[T], more: Iterable[T]) -> None:
    known = set(found)
    found += [each for each in dict.fromkeys(more) if each not in known]


def source_files(target: CppTarget) -> list[Path]:
    """Return the sources to compile.

    Raises:
        UsageError: one does not exist.
    """
    found = []
    for name in target.sources:
        file = target.folder / name
        if not target.needs_suffixes and not os.path.isfile(file):
            file = next((each for each in _with_suffixes(file) if os.path.isfile(each)), file)
        if not os.path.isfile(file) and (file.suffix in SUFFIXES or not file.suffix):
            made = f"{target.folder}/build/"
            why = "it is generated when CMake builds the package" if str(file).startswith(made) else ""
            text = f"{target.name} has a missing source: {name.removeprefix(made)}{why and f': {why}'}"
            raise UsageError(text, file=target.folder / FILE)
        if file.suffix in SUFFIXES:
            found.append(Path(os.path.normpath(file)))
    return list(dict.fromkeys(found))


def _with_suffixes(file: Path) -> Iterator[Path]:
    for suffix in _TRIED if file.name else ():
        yield file.with_name(file.name + suffix)


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

"""The contents of a catkin package in C++: targets, exported things, plugins, and the program of a node."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

NODELET = "nodelet::Nodelet"


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
        needs_suffixes: whether CMake wants the suffixes of its sources.
    """

    name: str
    folder: Path
    is_library: bool
    sources: list[str] = field(default_factory=list)
    includes: list[Path] = field(default_factory=list)
    definitions: list[str] = field(default_factory=list)
    links: list[str] = field(default_factory=list)
    file_name: str = ""
    needs_suffixes: bool = False


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
        configured: texts of headers that CMake makes from templates, by absolute path.
    """

    name: str
    folder: Path
    targets: dict[str, CppTarget] = field(default_factory=dict)
    includes: list[Path] = field(default_factory=list)
    exported: list[str] = field(default_factory=list)
    depends: list[str] = field(default_factory=list)
    plugins: dict[str, PluginClass] = field(default_factory=dict)
    configured: dict[Path, str] = field(default_factory=dict)

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

"""The libraries that nodes import besides rospy (tf, tf2_ros, ...), and parts of them that depend on the node.

A library is a folder in `ros_libraries`, ordinary code of nodes that does not know this package. It is on the import
path of every node, after the node's own folders, so a node that brings a library's original source gets that one.
Packages of other projects that such a source imports and rarely uses have stand-ins, which are used if the real ones
are not installed. This module makes the modules with a library's data about package folders, definitions and installed
distributions. It also makes `<package>.cfg.<Name>Config`, which ROS generates from cfg/<Name>.cfg at build time and
`ros_libraries/dynamic_reconfigure` makes inside the node.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache, partial
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from rospy_shim.types.angles import degrees, radians
from rospy_shim.types.msgs.packages import Packages, crawl, name_of

if TYPE_CHECKING:
    from cfepy.nodes import Factory, Universe
    from rospy_shim.client.node import Node

FOLDER = Path(__file__).parents[1] / "ros_libraries"
STAND_INS = Path(__file__).parent / "stand_ins"
_LIBRARY = "dynamic_reconfigure"
_GENERATORS = ("parameter_generator", "parameter_generator_catkin")


@cache
def library_names() -> frozenset[str]:
    """Return the names of the libraries."""
    return frozenset(path.parent.name for path in FOLDER.glob("*/__init__.py"))


def shown_names(module: str) -> Mapping[str, str] | None:
    """Return the public names of a module in ROS's library of that name; None if it is not one of them.

    Returns:
        For each name the module that ROS's module has it from, or "module:name"; "" for its own names.
    """
    return _table().get(module)


@cache
def _table() -> dict[str, dict[str, str]]:
    lines = Path(__file__).with_name("public_names.txt").read_text(encoding="utf-8").splitlines()[1:]
    rows = (line.partition(": ") for line in lines)
    return {module: {name: home for name, _, home in map(_parts, names.split())} for module, _, names in rows}


def _parts(name: str) -> tuple[str, str, str]:
    return name.partition("=")


def library_parts(node: Node) -> dict[str, Factory]:
    """Return the factories of such modules, by full name.

    Args:
        node: the node whose packages and messages they describe.
    """
    library = node.library
    places = {"folders": partial(_folders, node)}
    definitions = {
        "names": lambda package, kind: library.names(package, kind) or [],
        "packages": library.packages,
        "text": library.text,
    }
    return {
        "importlib.metadata": _metadata,
        "pkg_resources": _pkg_resources,
        "roslib._definitions": _factory({"packages": library.packages}),
        "rosmsg._definitions": _factory(definitions),
        "rosparam._angles": _factory({"degrees": degrees, "radians": radians}),
        "rospkg._places": _factory(places),
    }


def _metadata(universe: Universe) -> ModuleType:
    from rospy_shim.distributions import metadata_module  # slow to import, and few nodes need it

    return metadata_module()


def _pkg_resources(universe: Universe) -> ModuleType:
    from rospy_shim.distributions import pkg_resources_module

    return pkg_resources_module()


def _factory(contents: Mapping[str, Any]) -> Factory:
    def make(universe: Universe) -> ModuleType:
        module = ModuleType("part")
        vars(module).update(contents)
        return module

    return make


def _folders(node: Node, paths: Sequence[str] | None) -> dict[str, str]:
    """Return folders of packages by name: in some folders, or all that the node sees with its present environment."""
    universe = node.universe
    if paths is None:
        packages = Packages(node.place, universe.environ, universe.resolve)
        return {name: str(packages.path(name)) for name in packages.names()}
    found: dict[str, str] = {}
    for path in paths:
        for folder in crawl(Path(universe.resolve(path))):
            found.setdefault(name_of(folder), str(folder))
    return found


class ConfigModules:
    """Finds the configurations of the packages that a node can see.

    Args:
        packages: the packages.
    """

    def __init__(self, packages: Packages) -> None:
        self._packages = packages

    def find(self, name: str) -> Factory | None:
        """Return the factory of a module by its full name, or None if it is not a configuration."""
        package, *rest = name.split(".")
        if package == _LIBRARY and len(rest) == 1 and rest[0] in _GENERATORS:
            return lambda universe: _own_generator(universe, name, rest[0])
        if rest[:1] not in ([], ["cfg"]) or len(rest) > 2:
            return None
        if len(rest) < 2:
            return (lambda universe: _package(name)) if self._file(package, "*") is not None else None
        file = self._file(package, rest[1].removesuffix("Config")) if rest[1].endswith("Config") else None
        return None if file is None else lambda universe: _config(universe, name, file)

    def _file(self, package: str, name: str) -> Path | None:
        found = (file for folder in self._packages.folders(package) for file in sorted(folder.glob(f"cfg/{name}.cfg")))
        return next(found, None)


def _package(name: str) -> ModuleType:
    module = ModuleType(name)
    module.__path__ = []
    return module


def _own_generator(universe: Universe, name: str, part: str) -> ModuleType:
    """Load cfepy's generator always: the original writes source files, which need a build."""
    module: ModuleType = universe.importer.load_file(name, str(FOLDER / _LIBRARY / f"{part}.py"))
    return module


def _config(universe: Universe, name: str, file: Path) -> ModuleType:
    script = universe.importer.load(f"{_LIBRARY}._cfg_script")
    module = ModuleType(name)
    module.__file__ = str(file)
    vars(module).update(script.contents_of(str(file), file.stem))
    return module

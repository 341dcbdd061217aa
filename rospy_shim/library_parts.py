"""Parts of libraries that only a node's owner can make: where packages lie, which message definitions there are, what
is installed.

A library such as rospkg is code of nodes and knows nothing of this package; what it needs to be told is a module in it
that is made here. Whoever brings the library's original source never asks for it. Imports nothing of cfepy.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from rospy_shim.msgs.packages import Packages, crawl, name_of

if TYPE_CHECKING:
    from rospy_shim.node import Node

Factory = Callable[[Any], ModuleType]


def library_parts(node: Node) -> dict[str, Factory]:
    """The factories of such modules, by full name.

    Args:
        node: whose packages and messages they tell of.
    """
    library = node.library
    places = {"folders": partial(_folders, node)}
    definitions = {
        "names": lambda package, kind: library.names(package, kind) or [],
        "packages": library.packages,
        "text": library.text,
    }
    return {
        "importlib.metadata": partial(_installed, "metadata_module"),
        "pkg_resources": partial(_installed, "pkg_resources_module"),
        "rosmsg._definitions": _factory(definitions),
        "rospkg._places": _factory(places),
    }


def _installed(maker: str, universe: Any) -> ModuleType:
    """A module that tells which distributions are installed; few nodes ask, and it takes much to import."""
    distributions = importlib.import_module("rospy_shim.distributions")
    module: ModuleType = getattr(distributions, maker)()
    return module


def _factory(contents: Mapping[str, Any]) -> Factory:
    def make(universe: Any) -> ModuleType:
        module = ModuleType("part")
        vars(module).update(contents)
        return module

    return make


def _folders(node: Node, paths: Sequence[str] | None) -> dict[str, str]:
    """Folders of packages by name: those in some folders, or all that the node sees with its environment as it is."""
    universe = node.universe
    if paths is None:
        packages = Packages(node.place, universe.environ, universe.resolve)
        return {name: str(packages.path(name)) for name in packages.names()}
    found: dict[str, str] = {}
    for path in paths:
        for folder in crawl(Path(universe.resolve(path))):
            found.setdefault(name_of(folder), str(folder))
    return found

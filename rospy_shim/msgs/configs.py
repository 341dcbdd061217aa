"""The modules `<package>.cfg.<Name>Config`, which ROS generates from a package's cfg/<Name>.cfg at build time.

Here such a module is made when a node imports it, by dynamic_reconfigure's own code inside the node
(`rospy_shim/libraries/dynamic_reconfigure`). Imports nothing of cfepy.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

from rospy_shim.library_path import FOLDER
from rospy_shim.msgs.packages import Packages

Factory = Callable[[Any], ModuleType]
"""Makes a module for the universe that it is given."""

_LIBRARY = "dynamic_reconfigure"
_GENERATORS = ("parameter_generator", "parameter_generator_catkin")


class ConfigModules:
    """Finds the configurations of the packages that a node can see.

    Args:
        packages: the packages.
    """

    def __init__(self, packages: Packages) -> None:
        self._packages = packages

    def find(self, name: str) -> Factory | None:
        """What makes a module, by its full name; None: it is not a configuration."""
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


def _own_generator(universe: Any, name: str, part: str) -> ModuleType:
    """The generator is always cfepy's: the original writes source files, for which there is no build here."""
    module: ModuleType = universe.importer.load_file(name, str(FOLDER / _LIBRARY / f"{part}.py"))
    return module


def _config(universe: Any, name: str, file: Path) -> ModuleType:
    script = universe.importer.load(f"{_LIBRARY}.cfg_script")
    module = ModuleType(name)
    module.__file__ = str(file)
    vars(module).update(script.contents_of(str(file), file.stem))
    return module

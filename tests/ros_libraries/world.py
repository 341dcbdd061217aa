"""A universe for libraries alone: their code as a node imports it, with rospy's values but without a mission."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType
from typing import Any

from cfepy.nodes import Universe
from cfepy.rtos import Kernel
from rospy_shim.client import rostime
from rospy_shim.library_parts import FOLDER, library_names, shown_names
from rospy_shim.types.msgs import make_module


def universe() -> Universe:
    """Return a fresh universe. `universe().importer.load(name)` is an import in it."""
    return Universe(Kernel(), name="node", library_paths=[FOLDER], find_module=_find, shown_names=shown_names)


def _find(name: str) -> Callable[[Any], ModuleType] | None:
    if name in library_names():
        return None
    module = _values_of_rospy() if name == "rospy" else make_module(name)
    return None if module is None else lambda universe: module


def _values_of_rospy() -> ModuleType:
    module = ModuleType("rospy")
    vars(module).update(Time=rostime.Time, Duration=rostime.Duration)
    return module

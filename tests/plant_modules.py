"""The modules of cfepy_plant without ROS, for tests; nodes import them by their bare names."""

from __future__ import annotations

import importlib.util
from types import ModuleType

from cfepy.reading.resources import shipped

NODES = shipped("ros_packages") / "cfepy_plant" / "nodes"


def plant_module(name: str) -> ModuleType:
    """Return a module beside the nodes, freshly executed.

    Args:
        name: such as "floor_map".
    """
    spec = importlib.util.spec_from_file_location(name, NODES / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module

"""`importlib` of a node: the functions that import, on the node's module table."""

from __future__ import annotations

import importlib
import importlib.util
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import TYPE_CHECKING

from cfepy.nodes.synth import proxy

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe


def importlib_module(universe: Universe) -> ModuleType:
    """The module `importlib` of a universe."""
    importer = universe.importer
    module = proxy(
        importlib,
        __import__=importer.import_name,
        import_module=importer.import_module,
        invalidate_caches=importlib.invalidate_caches,
        reload=importer.reload,
    )
    importer.modules["importlib"] = module
    vars(module)["util"] = importer.load("importlib.util")
    return module


def importlib_util_module(universe: Universe) -> ModuleType:
    """`importlib.util`: modules made from a spec get the node's builtins before they are executed."""

    def module_from_spec(spec: ModuleSpec) -> ModuleType:
        module = importlib.util.module_from_spec(spec)
        vars(module)["__builtins__"] = vars(universe.builtins)
        return module

    return proxy(importlib.util, find_spec=universe.importer.find_spec, module_from_spec=module_from_spec)

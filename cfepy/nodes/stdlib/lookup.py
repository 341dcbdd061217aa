"""Standard modules that look a class up by its module name, changed to use the node's module table.

`dataclasses` (string annotations), `typing.get_type_hints` and `inspect` read `sys.modules`. Their functions get the
node's `sys`. Their classes remain the host's, so dataclasses of a host library and of a node can be mixed. `pickle` and
`unittest` are executed for each node and need no change here.
"""

from __future__ import annotations

import functools
from types import ModuleType
from typing import TYPE_CHECKING, Any

from cfepy.interpreter.cached import CachedProperty
from cfepy.nodes.made_modules import proxy, rebind

if TYPE_CHECKING:
    from collections.abc import Callable

    from cfepy.nodes.universe import Universe


def dataclasses_module(universe: Universe) -> ModuleType:
    """Return `dataclasses` that resolves string annotations in the node's modules."""
    import dataclasses

    load = universe.importer.load
    return rebind(dataclasses, sys=load("sys"), inspect=load("inspect"), _thread=load("_thread"))


def inspect_module(universe: Universe) -> ModuleType:
    """Return `inspect` that finds the source of the node's classes."""
    import inspect

    return rebind(inspect, sys=universe.importer.load("sys"), os=universe.importer.load("os"), modulesbyfile={})


def typing_module(universe: Universe) -> ModuleType:
    """Return `typing` that resolves forward references in the node's modules."""
    import typing

    modules = universe.importer.modules
    module = rebind(typing, only=("get_type_hints", "_eval_type"), sys=universe.importer.load("sys"))
    evaluate: Callable[..., Any] = vars(module)["_eval_type"]

    def eval_type(value: Any, names: Any, *rest: Any, **options: Any) -> Any:
        """A TypedDict's references contain a module name, which only the node's table can resolve."""
        if isinstance(value, typing.ForwardRef) and value.__forward_module__ in modules:
            names = vars(modules[value.__forward_module__])
            value = typing.ForwardRef(value.__forward_arg__, is_class=value.__forward_is_class__)
        return evaluate(value, names, *rest, **options)

    vars(module)["_eval_type"] = eval_type
    return module


def functools_module(universe: Universe) -> ModuleType:
    """Return `functools` without the real lock that Python 3.11's `cached_property` holds during the computation.

    A task that waits while it holds a real lock would stop the whole simulated computer.
    """
    return proxy(functools, cached_property=CachedProperty)

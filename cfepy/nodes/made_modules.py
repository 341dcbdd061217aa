"""Making modules that are not files: a copy of a host module with some names replaced, optionally with its functions
rebound.

Both leave the host's module unchanged. They share its classes and constants, so objects can be passed between a node
and the host's libraries.
"""

from __future__ import annotations

from collections.abc import Collection
from types import FunctionType, ModuleType
from typing import Any

_OWN = ("__builtins__", "__loader__", "__spec__")


def made(name: str, **names: Any) -> ModuleType:
    """Return a new module with these names in it."""
    module = ModuleType(name)
    vars(module).update(names)
    return module


def proxy(real: ModuleType, **names: Any) -> ModuleType:
    """Return a copy of `real` with some names replaced."""
    module = ModuleType(real.__name__, real.__doc__)
    copied = vars(real).copy()
    for name in _OWN:
        copied.pop(name, None)
    vars(module).update(copied)
    vars(module).update(names)
    return module


def rebind(real: ModuleType, only: Collection[str] = (), **names: Any) -> ModuleType:
    """Return a copy of `real` in which its own functions also use the replaced names as globals.

    Args:
        real: the host's module.
        only: functions to rebind; all if empty. The others stay the host's.
        names: replaced names.
    """
    module = proxy(real, **names)
    theirs, ours = vars(real), vars(module)
    ours["__builtins__"] = theirs["__builtins__"]
    for name in only or theirs:
        value = theirs[name]
        if type(value) is FunctionType and value.__globals__ is theirs and name not in names:
            ours[name] = _with_globals(value, ours)
    return module


def _with_globals(function: FunctionType, names: dict[str, Any]) -> FunctionType:
    copy = FunctionType(function.__code__, names, function.__name__, function.__defaults__, function.__closure__)
    copy.__kwdefaults__ = function.__kwdefaults__
    copy.__annotations__ = function.__annotations__
    copy.__qualname__ = function.__qualname__
    copy.__module__ = function.__module__
    copy.__doc__ = function.__doc__
    copy.__dict__.update(function.__dict__)
    return copy

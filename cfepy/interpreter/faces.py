"""Lazy names of packages: they are loaded at their first use (PEP 562).

    if TYPE_CHECKING:
        from cfepy.ground.bag import BagReader, is_bag
    else:
        __getattr__, __dir__ = face(__name__, {".bag": ("BagReader", "is_bag")})

A package lists the names that it offers in `__all__`, and imports them under `TYPE_CHECKING` for type checkers. A type
checker must not see the functions, because it would accept any name then.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any


def face(package: str, modules: Mapping[str, tuple[str, ...]]) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """Return the functions `__getattr__` and `__dir__` of a package.

    Args:
        package: its name.
        modules: the lazy names of each module; `.bag` is a module of the package itself.
    """
    places = {name: module for module, names in modules.items() for name in names}

    def load(name: str) -> Any:
        if name not in places:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        value = getattr(import_module(places[name], package), name)
        setattr(sys.modules[package], name, value)
        return value

    def names() -> list[str]:
        return sorted({*vars(sys.modules[package]), *places})

    return load, names

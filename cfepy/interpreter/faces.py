"""Faces of packages: names that a package offers and that are loaded when they are first used (PEP 562).

    if TYPE_CHECKING:
        from cfepy.ground.bag import BagReader, is_bag
    else:
        __getattr__, __dir__ = face(__name__, {".bag": ("BagReader", "is_bag")})

A package says in its `__all__` what it offers, and under `TYPE_CHECKING` where a type checker finds it. The functions
stay out of a type checker's sight: it would take any name for one that is there.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any


def face(package: str, modules: Mapping[str, tuple[str, ...]]) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """The functions `__getattr__` and `__dir__` of a package.

    Args:
        package: its name.
        modules: the names to be loaded later, by the module that has them: `.bag` is one of the package itself.
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

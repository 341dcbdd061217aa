"""Whose code a source file is: the mission's own, a library's, the standard library's, or the simulator's.

What is told of a run (tracebacks, timelines, the places of moves) is told by lines and functions of the mission.
"""

from __future__ import annotations

import functools
import linecache
import os
from collections.abc import Callable
from pathlib import Path
from types import FunctionType
from typing import Any, TypeVar, cast

F = TypeVar("F", bound=Callable[..., Any])
FILES = 4096  # of which it is remembered whose they are
PACKAGE = str(Path(__file__).resolve().parents[1])
_CFEPY = os.path.join(PACKAGE, "")
_COMPILED = "cfepy/"
_ROSPY = os.path.join(os.path.dirname(PACKAGE), "rospy_shim", "")
_LIBRARIES = os.path.join(os.path.dirname(PACKAGE), "ros_libraries", "")
_STANDARD_LIBRARY = os.path.join(os.path.dirname(linecache.__file__), "")
_INSTALLED = ("site-packages", "dist-packages")


def source_file(file: str) -> str:
    """The whole name of a source file as a frame of a traceback has it.

    A module that mypyc has compiled names its source from the folder that has cfepy in it.
    """
    return _CFEPY + file.removeprefix(_COMPILED) if file.startswith(_COMPILED) else file


@functools.lru_cache(maxsize=FILES)
def is_shown(file: str) -> bool:
    """Whether code is the mission's or a library's, not the simulator's."""
    return not source_file(file).startswith((_CFEPY, _ROSPY, "<"))


@functools.lru_cache(maxsize=FILES)
def is_library(file: str) -> bool:
    """Whether a source file is the standard library's or that of an installed package."""
    parts = Path(file).parts
    return file.startswith((_STANDARD_LIBRARY, _LIBRARIES)) or any(name in parts for name in _INSTALLED)


@functools.lru_cache(maxsize=FILES)
def is_standard(file: str) -> bool:
    """Whether a source file is the standard library's."""
    return file.startswith(_STANDARD_LIBRARY) and not any(name in Path(file).parts for name in _INSTALLED)


def called_as(function: F, name: str) -> F:
    """A function that stands for another one, as profiles, tracebacks and the places of moves are to show it.

    Args:
        function: which gets a name of its own; made for this.
        name: that of the other one.
    """
    made = cast("FunctionType", function)
    made.__code__ = made.__code__.replace(co_name=name, co_qualname=name)
    return function


def is_own_code(file: str) -> bool:
    """Whether a source file is the mission's own, neither the simulator's nor a library's."""
    return is_shown(file) and not is_library(file)

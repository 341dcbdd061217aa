"""Whether a source file belongs to the mission, to a library, to the standard library, or to the simulator.

Reports about a run (tracebacks, timelines, the places of deviations) name lines and functions of the mission.
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
FILES = 4096  # number of files whose owner is cached
PACKAGE = str(Path(__file__).resolve().parents[1])
_CFEPY = os.path.join(PACKAGE, "")
_COMPILED = "cfepy/"
BESIDE = ("rospy_shim", "rclpy_shim", "ros_libraries")
"""Folders with cfepy's own code beside the package: what stands for ROS 1 and ROS 2, and ROS's libraries."""
_ROSPY, _ROS2, _ROS1_LIBRARIES = (os.path.join(os.path.dirname(PACKAGE), each, "") for each in BESIDE)
_ROS2_LIBRARIES = os.path.join(_ROS2, "libraries", "")
_RCLPY = os.path.join(_ROS2_LIBRARIES, "rclpy", "")
_STANDARD_LIBRARY = os.path.join(os.path.dirname(linecache.__file__), "")
_INSTALLED = ("site-packages", "dist-packages")


def source_file(file: str) -> str:
    """Return the full path of a source file from the file name in a traceback's frame.

    A module compiled by mypyc names its source relative to the folder that contains cfepy.
    """
    return _CFEPY + file.removeprefix(_COMPILED) if file.startswith(_COMPILED) else file


@functools.lru_cache(maxsize=FILES)
def is_shown(file: str) -> bool:
    """Return whether code is from the mission or a library, not from the simulator."""
    path = source_file(file)
    if path.startswith(_ROS2_LIBRARIES):
        return not path.startswith(_RCLPY)
    return not path.startswith((_CFEPY, _ROSPY, _ROS2, "<"))


@functools.lru_cache(maxsize=FILES)
def is_library(file: str) -> bool:
    """Return whether a source file belongs to the standard library or to an installed package."""
    parts = Path(file).parts
    own = (_STANDARD_LIBRARY, _ROS1_LIBRARIES, _ROS2_LIBRARIES)
    return (file.startswith(own) and not file.startswith(_RCLPY)) or any(name in parts for name in _INSTALLED)


@functools.lru_cache(maxsize=FILES)
def is_standard(file: str) -> bool:
    """Return whether a source file belongs to the standard library."""
    return file.startswith(_STANDARD_LIBRARY) and not any(name in Path(file).parts for name in _INSTALLED)


def called_as(function: F, name: str) -> F:
    """Rename a function, so that profiles, tracebacks and the places of deviations show it as another one.

    Args:
        function: the function to rename, made for this purpose.
        name: the name to show.

    Returns:
        The same function.
    """
    made = cast("FunctionType", function)
    made.__code__ = made.__code__.replace(co_name=name, co_qualname=name)
    return function


def is_own_code(file: str) -> bool:
    """Return whether a source file is the mission's own code, not the simulator's or a library's."""
    return is_shown(file) and not is_library(file)

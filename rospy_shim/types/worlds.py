"""Which ROS a node's program is written for: ROS 1 (rospy) or ROS 2 (rclpy).

Message packages have the same names in both, so this must be known before the program's first import. The mission file
decides first (`ros:` of the node), then the package.xml of the program's package, then the program's imports.
"""

from __future__ import annotations

import os
import re
from collections.abc import Collection
from pathlib import Path

from cfepy.reading.input_files import text_limited
from cfepy.reading.input_limits import PYTHON_BYTES, XML_BYTES
from cfepy.status import UsageError

_DEPENDS = re.compile(r"<(?:depend|exec_depend|run_depend|build_depend)[^>]*>\s*(rospy|rclpy)\s*<")
_BUILD = re.compile(r"<(?:build_type|buildtool_depend)[^>]*>\s*(catkin|ament_\w+)\s*<")
_IMPORTS = re.compile(r"^[ \t]*(?:import|from)[ \t]+([A-Za-z_]\w*)", re.MULTILINE)
_MOST_FILES = 50  # of the program's package


def is_of_ros2(script: Path, said: int | None = None) -> bool:
    """Return True if a program is written for ROS 2.

    Args:
        script: the program's file.
        said: version of ROS in the mission file, 1 or 2; None if it has none.
    """
    if said is not None:
        return said == 2
    worlds = _of_package(script)
    if len(worlds) == 1:
        return worlds == {2}
    return _of_imports(script) == {2}


def _of_package(script: Path) -> set[int]:
    """Return the versions of ROS that the package of a program names."""
    manifest = next(
        (found for folder in script.absolute().parents if os.path.isfile(found := folder / "package.xml")), None
    )
    text = "" if manifest is None else _text(manifest, XML_BYTES)
    worlds = {2 if name == "rclpy" else 1 for name in _DEPENDS.findall(text)}
    return worlds or {1 if name == "catkin" else 2 for name in _BUILD.findall(text)}


def _of_imports(script: Path) -> set[int]:
    """Return the versions of ROS that a program imports, or else the modules beside it that it imports."""
    names = set(_IMPORTS.findall(_text(script, PYTHON_BYTES)))
    if worlds := _named(names):
        return worlds
    files = [file for name in sorted(names) for file in _files(script.parent / name)][:_MOST_FILES]
    return set().union(*(_named(_IMPORTS.findall(_text(file, PYTHON_BYTES))) for file in files))


def _named(names: Collection[str]) -> set[int]:
    return {version for name, version in (("rospy", 1), ("rclpy", 2)) if name in names}


def _files(place: Path) -> list[Path]:
    beside = place.with_suffix(".py")
    return [beside] if os.path.isfile(beside) else sorted(place.glob("*.py"))


def _text(file: Path, most: int) -> str:
    try:
        return text_limited(file, most, "replace")
    except (OSError, UsageError):
        return ""

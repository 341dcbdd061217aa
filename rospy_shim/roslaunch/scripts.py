"""The program that a node of a launch file is: a Python script in its package (roslib.packages.find_node).

A few C++ nodes are so common in launch files that `rospy_shim/roslaunch/tools` has the same in Python; a package's own
script of that name comes first. Imports nothing of cfepy.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from rospy_shim.msgs import Packages

_TOOLS = Path(__file__).parent / "tools"


class ScriptError(Exception):
    """A node that cannot run here; its text says why."""


def find_script(packages: Packages, package: str, node_type: str) -> Path:
    """The Python script of a node.

    Args:
        packages: where to look.
        package: the node's package.
        node_type: the file's name.

    Raises:
        ScriptError: there is none.
    """
    found = sorted(_candidates(packages.folders(package), node_type), key=_rank)
    script = next(filter(is_python, found), None) or _tool(package, node_type)
    if script is not None:
        return script
    if found:
        raise ScriptError(f"{found[0]} is no Python script; cfepy runs nodes that are written in Python")
    if not packages.folders(package):
        raise ScriptError(f"there is no package {package!r} near by or on ROS_PACKAGE_PATH")
    raise ScriptError(f"package {package!r} has no file {node_type!r}: a C++ node, or one that is not here")


def find_file(packages: Packages, package: str, name: str) -> Path | None:
    """A file of a package, such as a launch file, by its name alone; None when there is none."""
    return min(_candidates(packages.folders(package), name), key=lambda file: len(file.parts), default=None)


def is_python(file: Path) -> bool:
    """Whether a file is a Python script: by its name, or by its first line."""
    if file.suffix == ".py":
        return True
    with file.open("rb") as stream:
        first = stream.readline(200)
    return first.startswith(b"#!") and b"python" in first


def _tool(package: str, node_type: str) -> Path | None:
    """Ours; the name has both, for a script that has a library's name would be imported in its place."""
    tool = _TOOLS / f"{package}__{node_type}.py"
    return tool if tool.is_file() else None


def _candidates(folders: list[Path], name: str) -> Iterator[Path]:
    """Files of a name in a package's folders, at any depth, and where an installed package has its programs."""
    for folder in folders:
        installed = folder.parent.parent / "lib" / folder.name / name
        if folder.parent.name == "share" and installed.is_file():
            yield installed
        for place, inner, files in os.walk(folder):
            inner[:] = sorted(each for each in inner if not each.startswith("."))
            if name in files:
                yield Path(place) / name


def _rank(file: Path) -> tuple[bool, int]:
    """Executable files first, as only they count for ROS; then those nearer to the top."""
    return not os.access(file, os.X_OK), len(file.parts)

"""ROS parameters of a mission for tools: at its start, after some seconds, or in table files.

ROS's rules and tables are in `rospy_shim.parameters`.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from cfepy.mission import Mission, MissionSpec, is_mission_folder, read_mission
from cfepy.mission.parameter_files import read_tree
from cfepy.psp import load_profile
from cfepy.reading.input_files import read_limited, unreadable
from cfepy.reading.input_limits import TABLE_BYTES
from cfepy.reading.marked_yaml import load
from cfepy.status import UsageError
from rospy_shim.parameters import table_files as files
from rospy_shim.parameters.table import extent
from rospy_shim.parameters.tree import ParameterTree

TABLE_SUFFIX = ".tbl"


class Parameters:
    """A tree of parameters with ROS's way of naming.

    Args:
        tree: namespaces are dictionaries.
    """

    def __init__(self, tree: Mapping[str, Any]) -> None:
        self._tree = ParameterTree(tree)

    def find(self, name: str) -> Any:
        """Return a value, or the tree below a namespace; None if there is no such name."""
        value = self._tree.find(name)
        return None if value is ParameterTree.MISSING else value

    def set(self, name: str, value: Any) -> None:
        """Set the value of a name."""
        self._tree.set(name, value)

    def names(self, namespace: str = "/") -> list[str]:
        """Return the full names of the parameters in a namespace, sorted."""
        prefix, known = namespace.rstrip("/"), self._tree.names()
        return sorted(name for name in known if not prefix or name == prefix or name.startswith(f"{prefix}/"))


def at_start(spec: MissionSpec, unknown: list[str]) -> Parameters:
    """Return the parameters in a mission file: global ones, and those of its nodes.

    Args:
        spec: the mission.
        unknown: receives the applications of nodes with parameters whose names only their scripts know.
    """
    found = Parameters(spec.ros.params)
    for app, node in spec.ros.nodes.items():
        if node.params and node.name is None:
            unknown.append(app)
        for name, value in node.params.items() if node.name is not None else ():
            found.set(f"{node.namespace}/{node.name}/{name}", value)
    return found


def present(mission: Mission) -> Parameters:
    """Return the current parameters of a mission."""
    return Parameters({} if mission.ros is None else mission.ros.graph.params.find("/"))


def of_files(path: Path, problems: list[str]) -> Parameters:
    """Return the parameters in a table file, or in all of a folder.

    Args:
        path: a table file, or a folder with some.
        problems: receives a line for each parameter that cannot be read.

    Raises:
        UsageError: if there is no parameter table.
    """
    return Parameters(files.read(_contents(path), problems))


def is_source_of_files(source: str) -> bool:
    """Return whether a word refers to table files, and not to a mission."""
    path = Path(source)
    return path.suffix == TABLE_SUFFIX or (os.path.isdir(path) and not is_mission_folder(path))


def changed(path: Path, name: str, value: Any) -> dict[Path, bytes]:
    """Return table files with another value of a parameter; None removes it.

    Args:
        path: a table file, or a folder with some.
        name: name of the parameter.
        value: a value that XML-RPC supports.

    Returns:
        The files that changed.

    Raises:
        UsageError: if there is no parameter table, no room, or no such parameter.
    """
    return {Path(file): data for file, data in files.change(_contents(path), name, value).items()}


def table_files(source: Path, mission: str | None) -> dict[str, bytes]:
    """Return table files with the parameters of a YAML file, by name.

    Args:
        source: the YAML file.
        mission: mission of the tables; None for a mission with cFE's limits.

    Raises:
        UsageError: if the file has an error, or its parameters do not fit.
    """
    tree = read_tree(load(source, handed=True))
    spec = None if mission is None else read_mission(mission)
    board = load_profile("linux" if spec is None else spec.board)
    config = spec.limits.config(board, True, spec.cfe_version) if spec is not None else board.config()
    _, rows = extent(config)
    return {f"{name.lower()}{TABLE_SUFFIX}": data for name, data in files.make(tree, rows).items()}


def _contents(path: Path) -> dict[str, bytes]:
    """Return the parameter tables at a path, by file name."""
    try:
        if not os.path.isdir(path):
            return {str(path): read_limited(path, TABLE_BYTES, handed=True)}
        contents = {str(each): read_limited(each, TABLE_BYTES) for each in sorted(path.rglob(f"*{TABLE_SUFFIX}"))}
    except OSError as error:
        raise unreadable(path, error) from None
    found = {name: data for name, data in contents.items() if files.is_parameters(data)}
    if not found:
        raise UsageError("contains no file of a parameter table", file=path)
    return found

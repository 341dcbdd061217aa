"""The ROS parameters of a mission for tools: those at its start, those after some seconds, those in table files.

ROS's rules and tables are those of `rospy_shim.parameters`.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from cfepy.mission import STARTUP_SCRIPT, Mission, MissionSpec, read_mission
from cfepy.mission.parameter_files import read_tree
from cfepy.psp import load_profile
from cfepy.reading.input_files import read_limited
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
        """A value, or the tree below a namespace; None when there is none of the name."""
        value = self._tree.find(name)
        return None if value is ParameterTree.MISSING else value

    def set(self, name: str, value: Any) -> None:
        """Give a name a value."""
        self._tree.set(name, value)

    def names(self, namespace: str = "/") -> list[str]:
        """Full names of the parameters in a namespace, sorted."""
        prefix, known = namespace.rstrip("/"), self._tree.names()
        return sorted(name for name in known if not prefix or name == prefix or name.startswith(f"{prefix}/"))


def at_start(spec: MissionSpec, unknown: list[str]) -> Parameters:
    """What a mission file says: global parameters, and those of its nodes.

    Args:
        spec: the mission.
        unknown: gets the applications of nodes with parameters whose names only their scripts know.
    """
    found = Parameters(spec.ros.params)
    for app, node in spec.ros.nodes.items():
        if node.params and node.name is None:
            unknown.append(app)
        for name, value in node.params.items() if node.name is not None else ():
            found.set(f"{node.namespace}/{node.name}/{name}", value)
    return found


def present(mission: Mission) -> Parameters:
    """What a mission has now."""
    return Parameters({} if mission.ros is None else mission.ros.graph.params.find("/"))


def of_files(path: Path, problems: list[str]) -> Parameters:
    """What a parameter table holds, or all those in a folder.

    Args:
        path: a table file, or a folder with some.
        problems: gets a line for each parameter that cannot be read.

    Raises:
        UsageError: there is no parameter table.
    """
    return Parameters(files.read(_contents(path), problems))


def is_source_of_files(source: str) -> bool:
    """Whether a word means table files, and not a mission."""
    path = Path(source)
    return path.suffix == TABLE_SUFFIX or (os.path.isdir(path) and not os.path.isfile(path / STARTUP_SCRIPT))


def changed(path: Path, name: str, value: Any) -> dict[Path, bytes]:
    """Table files with another value of a parameter; None takes it away.

    Args:
        path: a table file, or a folder with some.
        name: of the parameter.
        value: as XML-RPC carries it.

    Returns:
        The files that changed.

    Raises:
        UsageError: there is no parameter table, no room, or no such parameter.
    """
    return {Path(file): data for file, data in files.change(_contents(path), name, value).items()}


def table_files(source: Path, mission: str | None) -> dict[str, bytes]:
    """Table files that hold the parameters of a YAML file, by name.

    Args:
        source: the YAML file.
        mission: whose tables they shall fit; None for a mission with cFE's limits.

    Raises:
        UsageError: the file is wrong, or its parameters do not fit.
    """
    tree = read_tree(load(source, handed=True))
    spec = None if mission is None else read_mission(mission)
    board = load_profile("linux" if spec is None else spec.board)
    config = spec.limits.config(board, True) if spec is not None else board.config()
    _, rows = extent(config)
    return {f"{name.lower()}{TABLE_SUFFIX}": data for name, data in files.make(tree, rows).items()}


def _contents(path: Path) -> dict[str, bytes]:
    """The parameter tables that a path means, by file name."""
    try:
        if not os.path.isdir(path):
            return {str(path): read_limited(path, TABLE_BYTES, handed=True)}
        contents = {str(each): read_limited(each, TABLE_BYTES) for each in sorted(path.rglob(f"*{TABLE_SUFFIX}"))}
    except OSError as error:
        raise UsageError(f"cannot be read: {error.strerror}", file=path) from None
    found = {name: data for name, data in contents.items() if files.is_parameters(data)}
    if not found:
        raise UsageError("contains no file of a parameter table", file=path)
    return found

"""The ROS parameters of a mission for tools: what it starts with, what is there after a while, what table files hold.

rospy_shim, which knows ROS's rules and tables, is loaded by name.
"""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from cfepy.console import Console
from cfepy.mission.mission import Mission
from cfepy.mission.parameter_files import read_tree
from cfepy.mission.spec import STARTUP_SCRIPT, MissionSpec, read_mission
from cfepy.psp.marked_yaml import load
from cfepy.psp.profile import load_profile
from cfepy.status import UsageError

TABLE_SUFFIX = ".tbl"


class Parameters:
    """A tree of parameters with ROS's way of naming.

    Args:
        tree: namespaces are dictionaries.
    """

    def __init__(self, tree: Mapping[str, Any]) -> None:
        module = importlib.import_module("rospy_shim.parameter_tree")
        self._tree = module.ParameterTree(tree)
        self._missing = module.ParameterTree.MISSING

    def find(self, name: str) -> Any:
        """A value, or the tree below a namespace; None when there is none of the name."""
        value = self._tree.find(name)
        return None if value is self._missing else value

    def set(self, name: str, value: Any) -> None:
        """Give a name a value."""
        self._tree.set(name, value)

    def names(self, namespace: str = "/") -> list[str]:
        """Full names of the parameters in a namespace, sorted."""
        prefix = namespace.rstrip("/")
        names: list[str] = self._tree.names()
        return sorted(name for name in names if not prefix or name == prefix or name.startswith(f"{prefix}/"))


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


def after(spec: MissionSpec, seconds: float, board: str | None = None) -> Parameters:
    """What a mission has after so many virtual seconds.

    Raises:
        CfeError: it cannot boot.
    """
    with Mission(spec, board=board, console=Console(quiet=True)) as mission:
        mission.run(seconds)
        return Parameters({} if mission.ros is None else mission.ros.graph.params.find("/"))


def of_files(path: Path, problems: list[str]) -> Parameters:
    """What a parameter table holds, or all those in a folder.

    Args:
        path: a table file, or a folder with some.
        problems: gets a line for each parameter that cannot be read.

    Raises:
        UsageError: there is no parameter table.
    """
    return Parameters(_files_module().read(_contents(path), problems))


def is_source_of_files(source: str) -> bool:
    """Whether a word means table files, and not a mission."""
    path = Path(source)
    return path.suffix == TABLE_SUFFIX or (path.is_dir() and not (path / STARTUP_SCRIPT).is_file())


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
    files: dict[str, bytes] = _files_module().change(_contents(path), name, value)
    return {Path(file): data for file, data in files.items()}


def table_files(source: Path, mission: str | None) -> dict[str, bytes]:
    """Table files that hold the parameters of a YAML file, by name.

    Args:
        source: the YAML file.
        mission: whose tables they shall fit; None for a mission with cFE's limits.

    Raises:
        UsageError: the file is wrong, or its parameters do not fit.
    """
    tree = read_tree(load(source))
    spec = None if mission is None else read_mission(mission)
    board = load_profile("linux" if spec is None else spec.board)
    config = spec.limits.config(board, True) if spec is not None else board.config()
    _, rows = importlib.import_module("rospy_shim.parameter_table").extent(config)
    found: dict[str, bytes] = _files_module().make(tree, rows)
    return {f"{name.lower()}{TABLE_SUFFIX}": data for name, data in found.items()}


def _contents(path: Path) -> dict[str, bytes]:
    """The parameter tables that a path means, by file name."""
    try:
        if not path.is_dir():
            return {str(path): path.read_bytes()}
        files = {str(each): each.read_bytes() for each in sorted(path.rglob(f"*{TABLE_SUFFIX}"))}
    except OSError as error:
        raise UsageError(f"cannot be read: {error.strerror}", file=path) from None
    is_parameters = _files_module().is_parameters
    found = {name: data for name, data in files.items() if is_parameters(data)}
    if not found:
        raise UsageError("there is no file of a parameter table in it", file=path)
    return found


def _files_module() -> Any:
    return importlib.import_module("rospy_shim.parameter_files")

"""What apps declare for the tools on the ground, at the top level of their modules: `TABLES` and the like.

An app's module is executed for that, but not started; one that declares nothing is not executed, and a ROS node never.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from cfepy.es.startup_script import entries
from cfepy.mission import sources
from cfepy.mission.loader import NODE_SYMBOL, execute, find_code
from cfepy.mission.module_names import ModuleNames
from cfepy.mission.spec import MissionSpec, read_mission
from cfepy.mission.tracebacks import described
from cfepy.resources import shipped
from cfepy.tbl import TableType

ROS_PACKETS = "rospy_shim.parameter_table"
"""What the application ROS declares, which is there when there are nodes."""


def declared(spec: MissionSpec | None, attributes: Sequence[str], problems: list[str]) -> list[Any]:
    """Everything that the apps and libraries of a mission declare.

    Args:
        spec: the mission; None stands for all apps that cfepy brings along.
        attributes: names of the tuples, such as "TABLES".
        problems: gets a line for each app that could not be executed.
    """
    found: list[Any] = []
    names = ModuleNames()
    try:
        for file, code in _codes(spec):
            found += _of_app(file, code, attributes, names, problems)
    finally:
        names.forget()
    return found


def table_types(mission: str | None, problems: list[str]) -> dict[str, TableType]:
    """The tables that are known, by full name: those of a mission before those of the apps that cfepy brings along.

    Args:
        mission: as `read_mission` takes it, or None.
        problems: gets a line for each app that could not be executed.

    Raises:
        UsageError: there is no such mission.
    """
    own = declared(read_mission(mission), ("TABLES",), problems) if mission is not None else []
    return {kind.name: kind for kind in [*declared(None, ("TABLES",), problems), *own]}


def _codes(spec: MissionSpec | None) -> Iterator[tuple[str, Path | str]]:
    """(name, code) of apps and libraries, each once."""
    if spec is None:
        for package in sorted(shipped("apps").glob("*/__init__.py")):
            yield package.parent.name, package
        yield ROS_PACKETS, ROS_PACKETS
        return
    files = dict.fromkeys(entry.path for entry in entries(spec.startup_script) if entry.symbol != NODE_SYMBOL)
    for file in files:
        code = find_code(file, spec.folder)
        if code is not None:
            yield file, code
    if spec.has_nodes:
        yield ROS_PACKETS, ROS_PACKETS


def _of_app(
    file: str, code: Path | str, attributes: Sequence[str], names: ModuleNames, problems: list[str]
) -> list[Any]:
    source = sources.source_of(code)
    if source is None or not any(sources.defines(source, name) for name in attributes):
        return []
    try:
        module = execute(code, names.new(file))
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # also sys.exit(): the code is the mission's, and may do anything
        problems.append(f"{source} could not be read: {described(error)}")
        return []
    return [item for name in attributes for item in getattr(module, name, ())]

"""Names of MsgIds from the core services, the apps of a mission and its ROS part.

An app's names are read from its source, from lines such as `SEND_HK_MID = local_cmd_topic_id_to_msg_id(0x83)` or
`HK_TLM_MID = 0x0883` at module level; the source is not executed. Topics and services get their MsgIds while a mission
runs: `LiveNames` asks for them on first use.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

from cfepy.es import NODE_SYMBOL
from cfepy.es import packets as es
from cfepy.evs import packets as evs
from cfepy.interpreter.syntax_trees import parsed_input
from cfepy.mission import Mission, MissionSpec, find_compiled, find_declarations
from cfepy.msg import Command, Layout, Telemetry, is_valid_msg_id, topics
from cfepy.plugins import Hook
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import PYTHON_BYTES
from cfepy.sb import packets as sb
from cfepy.tbl import TableType
from cfepy.tbl import packets as tbl
from cfepy.time import packets as time

SUFFIX = "_MID"
CORE_PACKETS: dict[str, ModuleType] = {"ES": es, "EVS": evs, "SB": sb, "TBL": tbl, "TIME": time}
"""Modules that declare the packets of the five services."""
_ASSIGNMENT = re.compile(rb"_MID[\s\\)]*=")
ROS = "ROS"
COMMAND_BIT = 0x1000  # bit of commands: a ROS service's requests have the MsgId of its answers with this bit


class ForeignDeclarations(NamedTuple):
    """The declarations of a mission in files that are not Python.

    Attributes:
        packets: commands and telemetry.
        tables: types of tables.
        names: names of MsgIds.
        problems: a line for each declaration that could not be read.
        layout: returns a struct by its name in C, such as "HS_AMTEntry_t", or None.
    """

    packets: Sequence[Command | Telemetry] = ()
    tables: Sequence[TableType] = ()
    names: Mapping[int, str] = {}
    problems: Sequence[str] = ()
    layout: Callable[[str], Layout | None] = lambda name: None


FOREIGN_DECLARATIONS: Hook[Callable[[MissionSpec], ForeignDeclarations]] = Hook("declarations")
"""Reads the packets and tables of a mission that files other than Python declare."""
DICTIONARY = "dictionary"
"""The folder of a mission with files that declare packets and tables."""


def foreign_declarations(spec: MissionSpec) -> Iterator[ForeignDeclarations]:
    """Yield the declarations that each add-on reads of a mission.

    A mission that has neither a dictionary nor a compiled application declares nothing outside Python, and loads no
    add-on.
    """
    if (
        spec.dictionary
        or (spec.folder / DICTIONARY).is_dir()
        or any(entry.symbol != NODE_SYMBOL and find_compiled(entry.path, spec.folder) for entry in spec.entries)
    ):
        yield from (read(spec) for read in FOREIGN_DECLARATIONS.all())


def names_of(spec: MissionSpec) -> dict[int, str]:
    """Return names by MsgId, as far as known without running the mission; core services first, topics last."""
    names = core_names()
    for entry in spec.entries:
        if entry.symbol != NODE_SYMBOL:
            for name, msg_id in constants_in(find_declarations(entry.path, spec.folder)):
                names.setdefault(msg_id, _with_prefix(name, entry.name))
    for foreign in foreign_declarations(spec):
        for msg_id, name in foreign.names.items():
            names.setdefault(msg_id, name)
    if spec.has_nodes:
        from rospy_shim.parameters import table

        names |= _constants(table, ROS)
    for topic in spec.ros.topics.values():
        names.setdefault(topic.msg_id, topic.name)
    return names


def kind_of(msg_id: int) -> str:
    """Return the type of packets with a MsgId: "command" or "telemetry"."""
    return "command" if msg_id & COMMAND_BIT else "telemetry"


def names_in(mission: Mission) -> dict[int, str]:
    """Return names by MsgId of a mission that runs or has run, including its ROS services."""
    names = names_of(mission.spec)
    if mission.ros is not None:
        _add_services(names, mission.ros.graph.ids.services())
    return names


def _add_services(names: dict[int, str], services: Mapping[int, str]) -> None:
    """Add the names of ROS services, which ROS knows by the MsgIds of their answers."""
    for msg_id, name in services.items():
        names.setdefault(msg_id, f"{name} answer")
        names.setdefault(msg_id | COMMAND_BIT, f"{name} request")


def core_names() -> dict[int, str]:
    """Return NASA's names by MsgId, for the messages of the five services: 0x0808 is CFE_EVS_LONG_EVENT_MSG."""
    names: dict[int, str] = {}
    for service, packets in CORE_PACKETS.items():
        names = _constants(packets, f"CFE_{service}") | names
    return names


def _constants(module: ModuleType, owner: str) -> dict[int, str]:
    """Return names by MsgId of everything called *_MID in a module of cfepy."""
    found: dict[int, str] = {}
    for name, value in vars(module).items():
        if name.endswith(SUFFIX) and isinstance(value, int):
            found.setdefault(value, _with_prefix(name, owner))
    return found


def constants_in(code: Path | str | None) -> Iterator[tuple[str, int]]:
    """Yield (constant, MsgId) of everything called *_MID in an app's sources.

    Args:
        code: result of `find_declarations`: a module's file or a package's `__init__.py`; others declare nothing.
    """
    if not isinstance(code, Path):
        return
    for file in sorted(code.parent.glob("*.py")) if code.name == "__init__.py" else [code]:
        try:
            source = read_limited(file, PYTHON_BYTES)
            if _ASSIGNMENT.search(source) is None:
                continue  # fast check: parsing all of an app takes as long as loading it
            tree = parsed_input(source)
        except (SyntaxError, ValueError, OSError):
            continue  # `cfepy check` reports the error
        yield from _assigned(tree)


def _assigned(tree: ast.Module) -> Iterator[tuple[str, int]]:
    for statement in tree.body:
        if isinstance(statement, ast.Assign) and isinstance(statement.targets[0], ast.Name):
            name, value = statement.targets[0].id, _msg_id(statement.value)
            if name.endswith(SUFFIX) and value is not None:
                yield name, value


def _msg_id(node: ast.expr) -> int | None:
    """Return the value of `0x1883` or of `local_cmd_topic_id_to_msg_id(0x83)`."""
    value: Any = node.value if isinstance(node, ast.Constant) else None
    if isinstance(node, ast.Call) and len(node.args) == 1 and isinstance(node.args[0], ast.Constant):
        function = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
        topic = node.args[0].value
        if function.endswith("_topic_id_to_msg_id") and hasattr(topics, function) and isinstance(topic, int):
            value = getattr(topics, function)(topic)
    return value if isinstance(value, int) and is_valid_msg_id(value) else None


def _with_prefix(name: str, owner: str) -> str:
    short = name.removesuffix(SUFFIX)
    return short if short.startswith(owner) else f"{owner}_{short}"


class LiveNames:
    """Names by MsgId; a message without name is called by its number, "0x0883".

    Args:
        mission: mission of the messages.
    """

    def __init__(self, mission: Mission) -> None:
        self._mission = mission
        self._declared = names_of(mission.spec)
        self._found: dict[int, str] = dict(self._declared)
        self._seen: tuple[Any, int, int] = (None, 0, 0)

    def __getitem__(self, msg_id: int) -> str:
        """Return the name of a MsgId."""
        name = self._found.get(msg_id)
        if name is None:
            self._look()
            name = self._found.get(msg_id, f"0x{msg_id:04X}")
        return name

    def _look(self) -> None:
        """Add the names that ROS has given since the last call."""
        ros = self._mission.ros
        if ros is None:
            return
        graph = ros.graph
        services = graph.ids.services()
        seen = (graph, len(graph.topics), len(services))
        if seen == self._seen:
            return
        self._seen = seen
        _add_services(self._found, services)
        self._found.update((topic.msg_id, topic.name) for topic in graph.topics.values())

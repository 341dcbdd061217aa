"""Names of MsgIds: what the core services, the apps of a mission and its ROS side call them.

An app's names are read from its source, where it says `SEND_HK_MID = local_cmd_topic_id_to_msg_id(0x83)` or
`HK_TLM_MID = 0x0883` at module level; nothing of it is executed. Topics and services get their MsgIds while a mission
runs: `LiveNames` asks for them when they are first needed.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

from cfepy.es import packets as es
from cfepy.evs import packets as evs
from cfepy.interpreter.syntax_trees import parsed_input
from cfepy.mission import NODE_SYMBOL, Mission, MissionSpec
from cfepy.mission.python_code import find_declarations
from cfepy.msg import is_valid_msg_id, topics
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import PYTHON_BYTES
from cfepy.sb import packets as sb
from cfepy.tbl import packets as tbl
from cfepy.time import packets as time

SUFFIX = "_MID"
CORE_PACKETS: dict[str, ModuleType] = {"ES": es, "EVS": evs, "SB": sb, "TBL": tbl, "TIME": time}
"""What declares the packets of each of the five services."""
_ASSIGNMENT = re.compile(rb"_MID[\s\\)]*=")
ROS = "ROS"
COMMAND_BIT = 0x1000  # of commands: a ROS service's requests have the MsgId of its answers with this bit


def names_of(spec: MissionSpec) -> dict[int, str]:
    """MsgId to name, as far as it can be told without running the mission; core services come first, topics last."""
    names = core_names()
    for entry in spec.entries:
        if entry.symbol != NODE_SYMBOL:
            for name, msg_id in constants_in(find_declarations(entry.path, spec.folder)):
                names.setdefault(msg_id, _with_prefix(name, entry.name))
    if spec.has_nodes:
        from rospy_shim.parameters import table

        names |= _constants(table, ROS)
    for topic in spec.ros.topics.values():
        names.setdefault(topic.msg_id, topic.name)
    return names


def kind_of(msg_id: int) -> str:
    """What a MsgId says of its packets: "command" or "telemetry"."""
    return "command" if msg_id & COMMAND_BIT else "telemetry"


def names_in(mission: Mission) -> dict[int, str]:
    """MsgId to name, in a mission that runs or has run: those of its ROS services as well."""
    names = names_of(mission.spec)
    if mission.ros is not None:
        _add_services(names, mission.ros.graph.ids.services())
    return names


def _add_services(names: dict[int, str], services: Mapping[int, str]) -> None:
    """Name the messages of ROS services, whose answers have the MsgIds by which ROS knows them."""
    for msg_id, name in services.items():
        names.setdefault(msg_id, f"{name} answer")
        names.setdefault(msg_id | COMMAND_BIT, f"{name} request")


def core_names() -> dict[int, str]:
    """MsgId to NASA's name, for the messages of the five services: 0x0808 is CFE_EVS_LONG_EVENT_MSG."""
    names: dict[int, str] = {}
    for service, packets in CORE_PACKETS.items():
        names = _constants(packets, f"CFE_{service}") | names
    return names


def _constants(module: ModuleType, owner: str) -> dict[int, str]:
    """MsgId to name of everything called *_MID in a module of cfepy's own."""
    found: dict[int, str] = {}
    for name, value in vars(module).items():
        if name.endswith(SUFFIX) and isinstance(value, int):
            found.setdefault(value, _with_prefix(name, owner))
    return found


def constants_in(code: Path | str | None) -> Iterator[tuple[str, int]]:
    """(constant, MsgId) of everything called *_MID in an app's sources.

    Args:
        code: what `find_declarations` found: a module's file or a package's `__init__.py`; others declare nothing.
    """
    if not isinstance(code, Path):
        return
    for file in sorted(code.parent.glob("*.py")) if code.name == "__init__.py" else [code]:
        try:
            source = read_limited(file, PYTHON_BYTES)
            if _ASSIGNMENT.search(source) is None:
                continue  # quickly known: to parse all of an app takes as long as to load it
            tree = parsed_input(source)
        except (SyntaxError, ValueError, OSError):
            continue  # `cfepy check` has more to say about it
        yield from _assigned(tree)


def _assigned(tree: ast.Module) -> Iterator[tuple[str, int]]:
    for statement in tree.body:
        if isinstance(statement, ast.Assign) and isinstance(statement.targets[0], ast.Name):
            name, value = statement.targets[0].id, _msg_id(statement.value)
            if name.endswith(SUFFIX) and value is not None:
                yield name, value


def _msg_id(node: ast.expr) -> int | None:
    """The value of `0x1883` or of `local_cmd_topic_id_to_msg_id(0x83)`."""
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
    """MsgId to name; what has no name is called by its number, "0x0883".

    Args:
        mission: whose messages they are.
    """

    def __init__(self, mission: Mission) -> None:
        self._mission = mission
        self._declared = names_of(mission.spec)
        self._found: dict[int, str] = dict(self._declared)
        self._seen: tuple[Any, int, int] = (None, 0, 0)

    def __getitem__(self, msg_id: int) -> str:
        """The name of a MsgId."""
        name = self._found.get(msg_id)
        if name is None:
            self._look()
            name = self._found.get(msg_id, f"0x{msg_id:04X}")
        return name

    def _look(self) -> None:
        """Take over the names that ROS has given since the last time."""
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

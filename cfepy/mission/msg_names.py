"""Names of MsgIds: what the core services, the apps of a mission and its ROS side call them.

An app's names are read from its source, where it says `SEND_HK_MID = local_cmd_topic_id_to_msg_id(0x83)` or
`HK_TLM_MID = 0x0883` at module level; nothing of it is executed.
"""

from __future__ import annotations

import ast
import importlib
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cfepy.es.startup_script import entries
from cfepy.mission.loader import NODE_SYMBOL, find_code
from cfepy.mission.spec import MissionSpec
from cfepy.msg import is_valid_msg_id, topics

if TYPE_CHECKING:
    from cfepy.mission.mission import Mission

SUFFIX = "_MID"
CORE_SERVICES = ("ES", "EVS", "SB", "TBL", "TIME")
ROS, ROS_PACKETS = "ROS", "rospy_shim.parameter_table"
COMMAND_BIT = 0x1000  # a ROS service's requests have the MsgId of its answers with this bit


def names_of(spec: MissionSpec) -> dict[int, str]:
    """MsgId to name, as far as it can be told without running the mission; core services come first, topics last."""
    names = core_names()
    for entry in entries(spec.startup_script):
        if entry.symbol != NODE_SYMBOL:
            for name, msg_id in declared(find_code(entry.path, spec.folder)):
                names.setdefault(msg_id, _with_prefix(name, entry.name))
    if spec.has_nodes:
        names |= _constants(ROS_PACKETS, ROS)
    for topic in spec.ros.topics.values():
        names.setdefault(topic.msg_id, topic.name)
    return names


def names_in(mission: Mission) -> dict[int, str]:
    """MsgId to name, in a mission that runs or has run: those of its ROS services as well."""
    names = names_of(mission.spec)
    services = {} if mission.ros is None else mission.ros.graph.ids.services()
    for msg_id, name in services.items():
        names.setdefault(msg_id, f"{name} answer")
        names.setdefault(msg_id | COMMAND_BIT, f"{name} request")
    return names


def core_names() -> dict[int, str]:
    """MsgId to NASA's name, for the messages of the five services: 0x0808 is CFE_EVS_LONG_EVENT_MSG."""
    names: dict[int, str] = {}
    for service in CORE_SERVICES:
        names = _constants(f"cfepy.{service.lower()}.packets", f"CFE_{service}") | names
    return names


def _constants(module: str, owner: str) -> dict[int, str]:
    """MsgId to name of everything called *_MID in a module of cfepy's own."""
    found: dict[int, str] = {}
    for name, value in vars(importlib.import_module(module)).items():
        if name.endswith(SUFFIX) and isinstance(value, int):
            found.setdefault(value, _with_prefix(name, owner))
    return found


def declared(code: Path | str | None) -> Iterator[tuple[str, int]]:
    """(constant, MsgId) of everything called *_MID in an app's sources.

    Args:
        code: what `find_code` found: a module's file or a package's `__init__.py`; others declare nothing.
    """
    if not isinstance(code, Path):
        return
    for file in sorted(code.parent.glob("*.py")) if code.name == "__init__.py" else [code]:
        try:
            tree = ast.parse(file.read_bytes())
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

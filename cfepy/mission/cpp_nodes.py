"""The section `cpp_nodes:` of a mission file: how ROS nodes in C++ are built, and the capacities of their messages.

Types and fields are checked against their definitions when a node is built or checked
(`cfepy.extra.convert.capacities`), because the definitions are known by then.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from cfepy.reading.marked_yaml import Marked
from cfepy.reading.mistakes import Mistakes
from cfepy.reading.suggestions import expected
from cfepy.status import UsageError

PROFILES = ("host", "pool", "strict")
ARENA_BYTES = 262_144
"""The default heap size of a node in the profiles pool and strict."""
SMALLEST_ARENA, LARGEST_ARENA = 4096, 1 << 30
TEXT, ARRAY = 64, 16
"""The default capacities in the profile strict: characters of a text and items of an array."""
MOST_ITEMS = (1 << 24) - 1
FIELDS = ("profile", "arena_bytes", "capacities", "ground")
GROUND_FIELDS = ("msg_id", "performance_id")
GROUND_SERVICE = "/ground"
"""Ends the name under which a node's housekeeping and commands have their MsgId, as a service has one."""
LOWEST_GROUND_ID, HIGHEST_GROUND_ID = 0x0801, 0x0FFF
"""MsgIds of telemetry; the commands have the command bit added."""
MOST_PERFORMANCE_ID = 127
DEFAULTS = ("text", "array")
"""Capacities of fields that are not named."""


class CppNodesError(UsageError):
    """Exception for an error in the section that prevents the build of any node and ends the run."""


@dataclass(frozen=True, slots=True)
class NodeGround:
    """The numbers of a node for the ground.

    Attributes:
        msg_id: MsgId of its housekeeping packet; its commands have the command bit added.
        performance_id: marks its work in the performance log; None without marks.
    """

    msg_id: int
    performance_id: int | None = None


@dataclass(frozen=True, slots=True)
class CppNodesConfig:
    """The content of the section.

    Attributes:
        profile: the profile of the nodes: "host", "pool" or "strict".
        arena_bytes: size of a node's heap in the profiles pool and strict.
        capacities: items, or characters of a text, by "package/Type.field"; those of the texts in an array:
            "...field[]".
        text: characters of any other text.
        array: items of any other array of numbers or texts.
        ground: nodes with housekeeping and commands, by full name.
        places: the position in the file of each capacity and of "arena_bytes", for errors.
    """

    profile: str = "host"
    arena_bytes: int = ARENA_BYTES
    capacities: Mapping[str, int] = field(default_factory=dict)
    text: int = TEXT
    array: int = ARRAY
    ground: Mapping[str, NodeGround] = field(default_factory=dict)
    places: Mapping[str, Marked] = field(default_factory=dict)


def read_cpp_nodes(section: Marked, mistakes: Mistakes) -> CppNodesConfig:
    """Return the section `cpp_nodes:`.

    Args:
        section: its value.
        mistakes: collects unknown keys, unknown profiles and invalid sizes.
    """
    said: dict[str, Any] = {}
    places: dict[str, Marked] = {}
    for name, entry in mistakes.fields(section, FIELDS):
        if name == "profile":
            said[name] = mistakes.attempt(partial(_profile, entry))
        elif name == "arena_bytes":
            said[name] = mistakes.attempt(partial(entry.integer, SMALLEST_ARENA, LARGEST_ARENA))
            places[name] = entry
        elif name == "ground":
            said[name] = _read_ground(entry, mistakes)
        else:
            said |= _read_capacities(entry, places, mistakes)
    return CppNodesConfig(**{name: value for name, value in said.items() if value is not None}, places=places)


def _profile(entry: Marked) -> str:
    if entry.value not in PROFILES:
        raise entry.fail(f"unknown profile {entry.shown()}; {expected(str(entry.value), PROFILES)}")
    return str(entry.value)


def _read_ground(section: Marked, mistakes: Mistakes) -> dict[str, NodeGround]:
    """Return the numbers of each node for the ground, without invalid entries."""
    found: dict[str, NodeGround] = {}
    holders: dict[int, str] = {}
    for node, entry in mistakes.mapping(section).items():
        ground = mistakes.whole(partial(_ground_of, node, entry))
        if ground is None:
            continue
        holder = holders.setdefault(ground.msg_id, node)
        if holder != node:
            mistakes.add(entry.fail(f"the MsgId 0x{ground.msg_id:04X} is already used by {holder}; change one of them"))
        found[node] = ground
    return found


def _ground_of(node: str, entry: Marked, mistakes: Mistakes) -> NodeGround:
    if not node.startswith("/"):
        mistakes.add(entry.fail(f'invalid node name {node!r}; write its full name, which begins with "/"'))
    fields = dict(mistakes.fields(entry, GROUND_FIELDS))
    if "msg_id" not in fields:
        raise entry.fail("missing msg_id; add it, such as `msg_id: 0x0A10`")
    msg_id = mistakes.attempt(partial(_ground_id, fields["msg_id"]))
    marks = fields.get("performance_id")
    number = None if marks is None else mistakes.attempt(partial(marks.integer, 0, MOST_PERFORMANCE_ID))
    return NodeGround(msg_id or LOWEST_GROUND_ID, number)


def _ground_id(entry: Marked) -> int:
    if not isinstance(entry.value, int) or not LOWEST_GROUND_ID <= entry.value <= HIGHEST_GROUND_ID:
        least, most = f"0x{LOWEST_GROUND_ID:04X}", f"0x{HIGHEST_GROUND_ID:04X}"
        shown = f"0x{entry.value:04X}" if isinstance(entry.value, int) else entry.shown()
        raise entry.fail(f"must be a MsgId of telemetry, from {least} to {most}, not {shown}")
    return entry.value


def _read_capacities(section: Marked, places: dict[str, Marked], mistakes: Mistakes) -> dict[str, Any]:
    """Return the capacities by type and field, with the two defaults."""
    said: dict[str, Any] = {}
    capacities: dict[str, int] = {}
    for name, entry in mistakes.mapping(section).items():
        if name in DEFAULTS:
            said[name] = mistakes.attempt(partial(entry.integer, 1, MOST_ITEMS))
        elif name.count("/") != 1 or name.startswith("/") or name.endswith("/"):
            text = "is not a message type; write it with its package, such as `sensor_msgs/JointState: {position: 7}`"
            mistakes.add(entry.fail(f"{text}, or `text: {TEXT}` or `array: {ARRAY}` for all fields that are not named"))
        else:
            for key, number in mistakes.mapping(entry).items():
                found = mistakes.attempt(partial(number.integer, 1, MOST_ITEMS))
                if found is not None:
                    capacities[f"{name}.{key}"] = found
                    places[f"{name}.{key}"] = number
    return {**said, "capacities": capacities}

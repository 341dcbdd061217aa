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
FIELDS = ("profile", "arena_bytes", "capacities")
DEFAULTS = ("text", "array")
"""Capacities of fields that are not named."""


class CppNodesError(UsageError):
    """Exception for an error in the section that prevents the build of any node and ends the run."""


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
        places: the position in the file of each capacity and of "arena_bytes", for errors.
    """

    profile: str = "host"
    arena_bytes: int = ARENA_BYTES
    capacities: Mapping[str, int] = field(default_factory=dict)
    text: int = TEXT
    array: int = ARRAY
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
        else:
            said |= _read_capacities(entry, places, mistakes)
    return CppNodesConfig(**{name: value for name, value in said.items() if value is not None}, places=places)


def _profile(entry: Marked) -> str:
    if entry.value not in PROFILES:
        raise entry.fail(f"unknown profile {entry.shown()}; {expected(str(entry.value), PROFILES)}")
    return str(entry.value)


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

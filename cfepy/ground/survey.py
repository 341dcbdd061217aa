"""Results of a short flight of a mission: its MsgIds with senders and subscribers, its topics, and fixed ids.

A mission runs for some virtual seconds with a Software Bus that records the sender of each message. A sender without
messages in that time is not found, except ROS publishers, which register. `lock` gives every topic and service its own
MsgId: the file `topics.lock` in the mission's folder, created by `cfepy graph --lock`, should be under version control.
An id in it never changes; the mission file's `topics:` have precedence.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from cfepy.es import NODE_SYMBOL
from cfepy.ground.mission_names import kind_of, names_in
from cfepy.ground.topics import Topic, topics_of
from cfepy.mission import LOCK_FILE, Mission, MissionSpec, PacketWatch, Seen
from cfepy.nodes import RosConfig
from cfepy.writing.console import Console

LOOK_S = 10.0
_HEAD = "# MsgIds of ROS topics and services, written by `cfepy graph --lock`. Keep this file: ids in it never move.\n"


@dataclass(frozen=True, slots=True)
class MidRow:
    """One MsgId; `type` is "command", "telemetry", or the type of a ROS topic's messages."""

    msg_id: int
    name: str
    type: str
    senders: list[str]
    subscribers: list[str]

    def to_dict(self) -> dict[str, Any]:
        """Return plain numbers and text."""
        return asdict(self)


class Survey(PacketWatch):
    """Records the senders of all messages in the mission that it is attached to.

    Attributes:
        senders: names of applications by MsgId.
    """

    def __init__(self) -> None:
        super().__init__(self._note)
        self.senders: dict[int, set[str]] = {}
        self._mission: Mission

    def begin(self, mission: Mission) -> None:
        self._mission = mission

    def rows(self) -> list[MidRow]:
        """Return the current MsgIds, in order."""
        return rows_of(self._mission, self.senders)

    def _note(self, seen: Seen) -> None:
        self.senders.setdefault(seen.msg_id, set()).add(seen.sender)


def rows_of(mission: Mission, senders_of: Mapping[int, set[str]]) -> list[MidRow]:
    """Return the MsgIds of a mission, in order.

    Args:
        mission: the mission.
        senders_of: names of the applications that sent each.
    """
    bus = mission.cfe.sb
    names = names_in(mission)
    ros = {row.msg_id: row for row in mission.ros.topics()} if mission.ros is not None else {}
    nodes = {entry.name for entry in mission.spec.entries if entry.symbol == NODE_SYMBOL}
    found = []
    for msg_id in sorted({*bus.routes, *senders_of, *ros}):
        row, route = ros.get(msg_id), bus.routes.get(msg_id)
        senders = set(senders_of.get(msg_id, ()))
        subscribers = {each.pipe.app_name for each in route.destinations} if route is not None else set()
        name, kind = names.get(msg_id, f"0x{msg_id:04X}"), kind_of(msg_id)
        if row is not None:  # ROS knows the nodes by their own names
            name, kind = row.name, row.type
            senders = senders - nodes | set(row.publishers)
            subscribers = subscribers - nodes | set(row.subscribers)
        found.append(MidRow(msg_id, name, kind, sorted(senders), sorted(subscribers)))
    return found


def surveyed_topics(spec: MissionSpec) -> list[Topic]:
    """Return the topics of a mission with their types; a mission with nodes runs for 10 virtual seconds to find them.

    Raises:
        CfeError: if it cannot boot.
    """
    if all(entry.symbol != NODE_SYMBOL for entry in spec.entries):
        return []
    with Mission(spec, console=Console(quiet=True)) as mission:
        mission.run_for(LOOK_S)
        return topics_of(mission)


def spread_out(spec: MissionSpec) -> MissionSpec:
    """Return a mission whose topics take the next free MsgId if two have the same one."""
    return replace(spec, ros=replace(spec.ros, spread=True))


def locked(spec: MissionSpec, mission: Mission) -> RosConfig:
    """Give every topic and service of a mission its own MsgId.

    Args:
        spec: the mission.
        mission: the mission of `spread_out(spec)`, after a flight long enough for its topics and services to appear.

    Returns:
        The configuration of `spec` with `locked_topics` and `locked_services`.

    Raises:
        UsageError: if there are more names than MsgIds.
    """
    from rospy_shim.graph import msg_ids

    topics, services = ([], []) if mission.ros is None else mission.ros.graph.ids.claimed()
    of_topics, of_services = msg_ids.locked(spec.ros, topics, services)
    return replace(spec.ros, locked_topics=of_topics, locked_services=of_services)


def lock_text(config: RosConfig) -> str:
    """Return the contents of the lock file."""
    return _HEAD + _section("topics", config.locked_topics) + _section("services", config.locked_services)


def lock_path(spec: MissionSpec) -> Path:
    """Return the path of a mission's lock file."""
    return spec.folder / LOCK_FILE


def _section(title: str, ids: Mapping[str, int]) -> str:
    if not ids:
        return f"{title}: {{}}\n"
    return f"{title}:\n" + "".join(f"  {_quoted(name)}: 0x{ids[name]:04X}\n" for name in sorted(ids))


def _quoted(name: str) -> str:
    """Return a name for YAML: a resolved name needs no quotes, but one that breaks ROS's rules may."""
    plain = all(letter.isalnum() or letter in "/_" for letter in name)
    return name if plain else '"' + name.replace("\\", "\\\\").replace('"', '\\"') + '"'

"""The MsgIds of a mission: what they are called, who sends, who subscribes.

Found by running the mission for a while with a Software Bus that looks who transmits what. A sender that stays silent
for that time is not seen; a ROS publisher is, since it registers.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from cfepy.console import Console
from cfepy.es.startup_script import entries
from cfepy.mission.loader import NODE_SYMBOL
from cfepy.mission.mission import Mission
from cfepy.mission.msg_names import names_in
from cfepy.mission.results import kind_of
from cfepy.mission.spec import MissionSpec
from cfepy.mission.watch import PacketWatch, Seen

LOOK_S = 10.0


@dataclass(frozen=True, slots=True)
class MidRow:
    """One MsgId; `type` is "command", "telemetry", or the type of a ROS topic's messages."""

    msg_id: int
    name: str
    type: str
    senders: list[str]
    subscribers: list[str]

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers and text."""
        return asdict(self)


def survey(spec: MissionSpec, board: str | None = None) -> list[MidRow]:
    """The MsgIds of a mission, in order.

    Args:
        spec: the mission; it runs for 10 virtual seconds.
        board: name or file of a board; None takes the mission's own.

    Raises:
        CfeError: it cannot boot.
        UsageError: no such board.
    """
    senders: dict[int, set[str]] = {}

    def note(seen: Seen) -> None:
        senders.setdefault(seen.msg_id, set()).add(seen.sender)

    with Mission(spec, board=board, console=Console(quiet=True), attachments=[PacketWatch(note)]) as mission:
        mission.run(LOOK_S)
        return _rows(mission, senders)


def _rows(mission: Mission, senders_of: dict[int, set[str]]) -> list[MidRow]:
    bus = mission.cfe.sb
    names = names_in(mission)
    ros = {row.msg_id: row for row in mission.ros.topics()} if mission.ros is not None else {}
    nodes = {entry.name for entry in entries(mission.spec.startup_script) if entry.symbol == NODE_SYMBOL}
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

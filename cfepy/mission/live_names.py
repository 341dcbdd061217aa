"""Names of MsgIds while a mission runs: topics and services get theirs when they are first used."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from cfepy.mission.msg_names import COMMAND_BIT, names_of

if TYPE_CHECKING:
    from cfepy.mission.mission import Mission


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
        for msg_id, name in services.items():
            self._found.setdefault(msg_id, f"{name} answer")
            self._found.setdefault(msg_id | COMMAND_BIT, f"{name} request")
        self._found.update((topic.msg_id, topic.name) for topic in graph.topics.values())

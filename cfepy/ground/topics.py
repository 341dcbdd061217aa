"""ROS topics as telemetry: their packets by name, and what is in them as far as their message type is known.

rospy_shim is not loaded before a topic's message is read.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from cfepy.mission import Mission, MissionSpec
from cfepy.msg import TLM_HEADER_SIZE, SegmentationFlag, get_segmentation_flag
from cfepy.status import UsageError

if TYPE_CHECKING:
    from rospy_shim.types.msgs import Library


@dataclass(frozen=True, slots=True)
class Topic:
    """A topic; the packet's payload is the message as ROS serialises it.

    Args:
        name: resolved, with its "/".
        msg_id: its MsgId.
        type: of its messages, such as "std_msgs/String"; empty when it is not known.
        raw: the message's data are the whole packet's bytes, so they have no layout of their own.
        definition: the full text of its type, as its users have it.
    """

    name: str
    msg_id: int
    type: str = ""
    raw: bool = False
    definition: str = ""

    @property
    def text(self) -> str:
        """What it tells, for tools."""
        return f"ROS topic, {self.type or 'of a type that is known when the mission runs'}"

    def read(self, packet: bytes) -> dict[str, Any]:
        """The message's fields.

        Raises:
            UsageError: the type is not known, or the packet is no whole message.
        """
        if self.raw:
            return {"data": bytes(packet)}
        if not self.type:
            raise UsageError("the message type is unknown")
        if get_segmentation_flag(packet) != SegmentationFlag.UNSEGMENTED:
            raise UsageError("this is one segment of a longer message")
        try:
            message = library_of(self).message_class(self.type)()
            fields: dict[str, Any] = plain(message.deserialize(packet[TLM_HEADER_SIZE:]))
        except Exception as error:  # whatever the generated code raises for bytes that are no such message
            raise UsageError(f"invalid {self.type}: {error}") from None
        return fields


def library_of(topic: Topic) -> Library:
    """The message library that knows the type of a topic."""
    from rospy_shim.types import msgs

    return msgs.library_of(topic.type, topic.definition)


def plain(message: Any) -> Any:
    """A message as nested dicts, lists, numbers and texts."""
    names = getattr(message, "__slots__", None)
    if names is not None and not isinstance(message, str | bytes):
        return {name: plain(getattr(message, name)) for name in names}
    return [plain(item) for item in message] if isinstance(message, list | tuple) else message


def topics_of(mission: Mission) -> list[Topic]:
    """The topics that there are in a running mission, by name."""
    rows = [] if mission.ros is None else mission.ros.topics()
    raw = {topic.name for topic in mission.spec.ros.topics.values() if topic.raw}
    return [Topic(row.name, row.msg_id, row.type or "", row.name in raw, row.definition) for row in rows]


def topic_id(spec: MissionSpec, name: str) -> int:
    """The MsgId that a topic has or would have in a mission."""
    from rospy_shim.graph.msg_ids import MsgIds

    return MsgIds(spec.ros).of_topic(name)

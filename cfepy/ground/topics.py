"""ROS topics as telemetry: their packets by name, and their contents if the message type is known.

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
    """A topic; the packet's payload is the serialised ROS message.

    Args:
        name: resolved name, with its "/".
        msg_id: its MsgId.
        type: type of its messages, such as "std_msgs/String"; empty if it is not known.
        raw: whether the message's data are the whole packet's bytes, without a layout of their own.
        definition: full text of its type, from its users.
    """

    name: str
    msg_id: int
    type: str = ""
    raw: bool = False
    definition: str = ""

    @property
    def text(self) -> str:
        """Return its description, for tools."""
        return f"ROS topic, {self.type or 'of a type that is known when the mission runs'}"

    def read(self, packet: bytes) -> dict[str, Any]:
        """Return the message's fields.

        Raises:
            UsageError: if the type is not known, or the packet is not a complete message.
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
        except Exception as error:  # any exception of the generated code for bytes that are not such a message
            raise UsageError(f"invalid {self.type}: {error}") from None
        return fields


def library_of(topic: Topic) -> Library:
    """Return the message library that knows the type of a topic."""
    from rospy_shim.types import msgs

    return msgs.library_of(topic.type, topic.definition)


def plain(message: Any) -> Any:
    """Return a message as nested dicts, lists, numbers and texts."""
    names = getattr(message, "__slots__", None)
    if names is not None and not isinstance(message, str | bytes):
        return {name: plain(getattr(message, name)) for name in names}
    return [plain(item) for item in message] if isinstance(message, list | tuple) else message


def topics_of(mission: Mission) -> list[Topic]:
    """Return the topics of a running mission, by name."""
    rows = [] if mission.ros is None else mission.ros.topics()
    raw = {topic.name for topic in mission.spec.ros.topics.values() if topic.raw}
    return [Topic(row.name, row.msg_id, row.type or "", row.name in raw, row.definition) for row in rows]


def topic_id(spec: MissionSpec, name: str) -> int:
    """Return the MsgId that a topic has or would have in a mission."""
    from rospy_shim.graph.msg_ids import MsgIds

    return MsgIds(spec.ros).of_topic(name)

"""An observer of a mission's ROS topics that sees every message with its sender and time.

It observes the Software Bus, so it changes nothing: the trace is the same as without it. It also sees packets that cFE
applications send to a topic's MsgId, and messages without a subscriber.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING

from cfepy.mission.packet_watch import PacketWatch, Seen, hearing
from cfepy.msg import TLM_HEADER_SIZE, SegmentationFlag, get_segmentation_flag
from cfepy.sb import SoftwareBus
from cfepy.units import NS_PER_S

if TYPE_CHECKING:
    from cfepy.mission.mission import Mission
    from rospy_shim.client.link import Link
    from rospy_shim.graph.graph import Graph, TopicEntry

RAW_TYPE = "std_msgs/UInt8MultiArray"
CLOCK_BYTES = 8
ADDRESSEE = slice(12, 16)
"""The bytes of a topic's packet that are 0 if the packet is for all subscribers."""


class TopicMessage:
    """A message on a topic.

    Attributes:
        topic: resolved name.
        header: the connection header of its publisher.
        data: the message in ROS serialization.
        at_ns: virtual time at which it was sent.
        stamp_ns: ROS time at which it was sent: the spacecraft's clock, or /clock if nodes use simulated time; None
            before /clock has started.
    """

    __slots__ = ("at_ns", "data", "header", "stamp_ns", "topic")

    def __init__(self, topic: str, header: dict[str, str], data: bytes, at_ns: int, stamp_ns: int | None) -> None:
        self.topic, self.header, self.data = topic, header, data
        self.at_ns, self.stamp_ns = at_ns, stamp_ns


class TopicWatch(PacketWatch):
    """Observes the topics of a mission.

    Args:
        take: called with each message when it is sent, inside the simulation, so it must not wait.
        patterns: names of topics, such as "/odom" or "/arm/*"; empty for all.
    """

    def __init__(self, take: Callable[[TopicMessage], object], patterns: Sequence[str] = ()) -> None:
        super().__init__(self.take_packet, self._is_wanted)
        self._take_message = take
        self._patterns = tuple(patterns)
        self._topics: dict[int, TopicEntry] = {}
        self._known: tuple[Graph | None, int] = (None, 0)
        self._parts: dict[tuple[int, str], list[bytes]] = {}
        self._clock_ns: int | None = None
        self._mission: Mission | None = None

    def bus(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
        return self.hearing(super().bus(base))

    def hearing(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
        """Return a bus class that reports messages whose topic has no subscriber, but no packets."""
        return hearing(base, self._take_unsent)

    def begin(self, mission: Mission) -> None:
        self._mission = mission

    # -- observed packets ----------------------------------------------------------------------------------------------

    def _graph(self) -> Graph | None:
        ros = None if self._mission is None else self._mission.ros
        return None if ros is None else ros.graph

    def _topic(self, msg_id: int) -> TopicEntry | None:
        """Return the topic of a MsgId, or None if it belongs to no topic."""
        graph = self._graph()
        if graph is None:
            return None
        if self._known != (graph, len(graph.topics)):
            self._known = (graph, len(graph.topics))
            self._topics = {topic.msg_id: topic for topic in graph.topics.values()}
        return self._topics.get(msg_id)

    def _is_wanted(self, msg_id: int) -> bool:
        topic = self._topic(msg_id)
        return topic is not None and (topic.name == "/clock" or matches(topic.name, self._patterns))

    def take_packet(self, seen: Seen) -> None:
        """Handle a sent packet, for a caller that observes all packets itself."""
        topic = self._topic(seen.msg_id)
        if topic is None or (not topic.raw and any(seen.packet[ADDRESSEE])):
            return  # a repetition for one subscriber, which is not a new message
        data = seen.packet if topic.raw else self._whole(seen)
        if data is not None:
            links = [link for link in topic.links if link.node.config.app == seen.sender]
            header = links[0].header if len(links) == 1 else topic.sender_of(seen.packet) if links else None
            header = header or _header_of(topic, seen.sender)
            shown = _as_bytes_message(header, data) if topic.raw else (header, data)
            self._show(topic, *shown, seen.at_ns)

    def _whole(self, seen: Seen) -> bytes | None:
        """Return the message in a packet, or the one that it completes; None if more segments follow."""
        flag, key = get_segmentation_flag(seen.packet), (seen.msg_id, seen.sender)
        payload = seen.packet[TLM_HEADER_SIZE:]
        if flag == SegmentationFlag.UNSEGMENTED:
            return payload
        parts = self._parts.setdefault(key, [])
        if flag == SegmentationFlag.FIRST:
            parts.clear()
        parts.append(payload)
        return b"".join(self._parts.pop(key)) if flag == SegmentationFlag.LAST else None

    def _take_unsent(self, link: Link, data: bytes) -> None:
        if link.topic is not None and self._is_wanted(link.msg_id):
            header = _header_of_bytes(link.header) if link.topic.raw else link.header
            self._show(link.topic, header, data, link.node.kernel.now)

    def _show(self, topic: TopicEntry, header: dict[str, str], data: bytes, at_ns: int) -> None:
        if topic.name == "/clock" and len(data) == CLOCK_BYTES:
            self._clock_ns = int.from_bytes(data[:4], "little") * NS_PER_S + int.from_bytes(data[4:], "little")
        if matches(topic.name, self._patterns) and "md5sum" in header:
            self._take_message(TopicMessage(topic.name, dict(header), data, at_ns, self._stamp(at_ns)))

    def _stamp(self, at_ns: int) -> int | None:
        assert self._mission is not None
        if self._mission.spec.ros.params.get("use_sim_time") is True:
            return self._clock_ns
        return self._mission.processor.machine.epoch_ns + at_ns


def matches(topic: str, patterns: Sequence[str]) -> bool:
    """Return whether a topic matches the patterns; see `TopicWatch`."""
    return not patterns or any(fnmatchcase(topic, pattern) for pattern in patterns)


def _header_of(topic: TopicEntry, sender: str) -> dict[str, str]:
    """Return a connection header for an application that sends to a topic and is not a Python node.

    It is empty while the type of the topic is unknown.
    """
    compiled = next((node for node in topic.compiled_publishers if node.config.app == sender), None)
    if compiled is not None:
        return topic.compiled_header(compiled)
    if not topic.md5sum:
        return {}
    about = {"md5sum": topic.md5sum, "message_definition": topic.definition, "topic": topic.name, "type": topic.type}
    return {"callerid": f"/{sender}", "latching": "0", **about}


def _header_of_bytes(header: dict[str, str]) -> dict[str, str]:
    """Return the connection header of a raw topic, whose messages contain a whole packet."""
    from rospy_shim.types.msgs import message_class

    kind = message_class(RAW_TYPE)
    return {**header, "type": RAW_TYPE, "md5sum": kind._md5sum, "message_definition": kind._full_text}


def _as_bytes_message(header: dict[str, str], packet: bytes) -> tuple[dict[str, str], bytes]:
    """Return header and data of a raw topic's message; like nodes, a bag gets the whole packet as its data."""
    from rospy_shim.types.msgs import message_class

    return _header_of_bytes(header), message_class(RAW_TYPE)(data=packet).__pack__()

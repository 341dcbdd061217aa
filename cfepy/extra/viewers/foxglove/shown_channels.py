"""The channels of viewers: one for each topic of ROS, one for each packet of cFE, and one for the events.

Topics are in ROS's own encoding with their definitions, so nothing is converted. Packets and events are JSON, as in an
MCAP file (`cfepy.ground.json_packets`). A message without subscribers costs only a look-up in a set.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import count
from typing import Any

from cfepy.extra.viewers.foxglove.protocol import JSON, JSON_SCHEMA, ROS1, ROS1_SCHEMA
from cfepy.extra.viewers.foxglove.viewer import PEER, Viewer
from cfepy.extra.viewers.foxglove.viewer_server import ViewerServer
from cfepy.ground import (
    EVENT_IDS,
    EVENTS,
    PACKETS,
    DecodedEvent,
    Dictionary,
    event_json,
    log_schema,
    packet_json,
    packet_schema,
)
from cfepy.io import OUT_OF, PeerCounts
from cfepy.mission import Seen, TopicMessage
from cfepy.msg import Command, Telemetry
from cfepy.status import CfeError, UsageError


class ShownChannel:
    """One channel.

    Args:
        number: unique number of the channel.
        topic: its name.
        encoding: encoding of its messages.
        schema: name, encoding and text of the schema.
        counts: counts for the run's report.

    Attributes:
        viewers: the subscribed viewers, with the numbers of their subscriptions.
        latched: the last message and its time of each publisher that latches.
    """

    def __init__(
        self, number: int, topic: str, encoding: str, schema: tuple[str, str, str], counts: PeerCounts
    ) -> None:
        self.number = number
        self.topic = topic
        self.viewers: dict[Viewer, int] = {}
        self.latched: dict[str, tuple[bytes, int]] = {}
        self._encoding = encoding
        self._schema = schema
        self._counts = counts

    @property
    def description(self) -> dict[str, Any]:
        """The channel as it is advertised."""
        name, encoding, text = self._schema
        about = {"schemaName": name, "schemaEncoding": encoding, "schema": text}
        return {"id": self.number, "topic": self.topic, "encoding": self._encoding, **about}

    @property
    def is_heard(self) -> bool:
        """True if there is a subscriber."""
        return bool(self.viewers)

    def show(self, data: bytes, time_ns: int) -> None:
        """Send a message to all subscribers."""
        for viewer in self.viewers:
            self._show_to(viewer, data, time_ns)

    def greet(self, viewer: Viewer) -> None:
        """Send a new subscriber the latched messages, as ROS does."""
        for data, time_ns in self.latched.values():
            self._show_to(viewer, data, time_ns)

    def _show_to(self, viewer: Viewer, data: bytes, time_ns: int) -> None:
        viewer.show(self, self.viewers[viewer], data, time_ns, self._counts.of(self.topic, PEER, OUT_OF))


class ShownChannels:
    """All channels.

    Args:
        server: advertises them to viewers.
        dictionary: the dictionary of the mission.
        counts: counts for the run's report.
    """

    def __init__(self, server: ViewerServer, dictionary: Dictionary, counts: PeerCounts) -> None:
        self._server = server
        self._dictionary = dictionary
        self._counts = counts
        self._numbers = count(1)
        self._topics: dict[str, tuple[str, ShownChannel]] = {}  # with the md5sum
        self._packets: dict[str, ShownChannel] = {}
        for declared in dictionary.telemetry.values():
            if isinstance(declared, Telemetry):
                self._packet(f"{PACKETS}{declared.name}", declared)
        self._events = self._json(EVENTS, "foxglove.Log", log_schema())

    # -- topics ------------------------------------------------------------------------------------------------------

    def announce(self, topic: str, header: Mapping[str, str]) -> ShownChannel:
        """Advertise a topic of ROS with its type. If the type has changed, its former channel ends.

        Args:
            topic: its name.
            header: the connection header of a publisher, with type, md5sum and message_definition.

        Returns:
            The channel.
        """
        known = self._topics.get(topic)
        if known is not None and known[0] == header["md5sum"]:
            return known[1]
        if known is not None:
            self._server.unadvertise(known[1])
        made = self._new(topic, ROS1, (header["type"], ROS1_SCHEMA, header["message_definition"]))
        self._topics[topic] = (header["md5sum"], made)
        return made

    def show_message(self, message: TopicMessage) -> None:
        """Show a message that was published."""
        header = message.header
        if header["md5sum"] == "*" or "message_definition" not in header:
            return  # of a type that is not known yet
        channel = self.announce(message.topic, header)
        time_ns = message.stamp_ns or 0  # /clock has not begun
        if header.get("latching") == "1":
            channel.latched[header.get("callerid", "")] = (message.data, time_ns)
        channel.show(message.data, time_ns)

    # -- packets and events ------------------------------------------------------------------------------------------

    def show_packet(self, seen: Seen, declared: Command | Telemetry | None, time_ns: int) -> None:
        """Show a packet that is not a message of ROS."""
        name = f"{PACKETS}{f'0x{seen.msg_id:04X}' if declared is None else declared.name}"
        channel = self._packets.get(name) or self._packet(name, declared)
        if channel.is_heard:
            channel.show(packet_json(seen, self._dictionary.decode(seen.packet)), time_ns)
        if seen.msg_id in EVENT_IDS and self._events.is_heard:
            self._show_event(seen, time_ns)

    def _show_event(self, seen: Seen, time_ns: int) -> None:
        try:
            event = DecodedEvent.of(seen)
        except (CfeError, UsageError):
            return  # an application has sent other data on this MsgId, which the packet's own channel shows
        self._events.show(event_json(event, time_ns), time_ns)

    def _packet(self, name: str, declared: Command | Telemetry | None) -> ShownChannel:
        made = self._packets[name] = self._json(name, name[1:].replace("/", "."), packet_schema(name, declared))
        return made

    def _json(self, name: str, title: str, schema: bytes) -> ShownChannel:
        return self._new(name, JSON, (title, JSON_SCHEMA, schema.decode()))

    def _new(self, topic: str, encoding: str, schema: tuple[str, str, str]) -> ShownChannel:
        made = ShownChannel(next(self._numbers), topic, encoding, schema, self._counts)
        self._server.advertise(made)
        return made

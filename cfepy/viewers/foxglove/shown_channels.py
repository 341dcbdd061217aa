"""What viewers see: a channel for each topic of ROS, for each packet of cFE, and for the events.

Topics are in ROS's own encoding with their definitions, so nothing is converted. Packets and events are JSON, as in an
MCAP file (`cfepy.ground.json_packets`). What nobody has subscribed to costs a look into a set.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

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
from cfepy.viewers.foxglove.client_topics import PEER

MakeChannel = Callable[[str, str, tuple[str, str, bytes], Mapping[str, str]], Any]
"""Takes topic, encoding, schema (name, encoding, text) and metadata."""
NO_LISTENERS: frozenset[int] = frozenset()


class ShownChannel:
    """One channel.

    Args:
        topic: its name.
        channel: the library's.
        listeners: who has subscribed to which channel, by its id.
        counts: of the run's report.

    Attributes:
        latched: the last message and its time of each publisher that latches.
    """

    def __init__(self, topic: str, channel: Any, listeners: Mapping[int, set[int]], counts: PeerCounts) -> None:
        self.topic = topic
        self.id: int = channel.id()
        self.latched: dict[str, tuple[bytes, int]] = {}
        self._channel = channel
        self._listeners = listeners
        self._counts = counts

    @property
    def is_heard(self) -> bool:
        """Whether anybody has subscribed."""
        return bool(self._listeners.get(self.id))

    def show(self, data: bytes, time_ns: int, client: int | None = None) -> int:
        """Send a message to all that have subscribed, or to one of them alone; returns to how many."""
        count = len(self._listeners.get(self.id, NO_LISTENERS)) if client is None else 1
        if count:
            self._channel.log(data, log_time=time_ns, sink_id=client)
            row = self._counts.of(self.topic, PEER, OUT_OF)
            row.messages += count
            row.size += count * len(data)
        return count

    def close(self) -> None:
        """There is no such topic any more."""
        self._channel.close()


class ShownChannels:
    """All channels.

    Args:
        make: makes one of the library's.
        dictionary: of the mission.
        listeners: as of `ShownChannel`.
        counts: of the run's report.

    Attributes:
        sent: messages so far, each counted once for each viewer that it was for.
    """

    def __init__(
        self, make: MakeChannel, dictionary: Dictionary, listeners: Mapping[int, set[int]], counts: PeerCounts
    ) -> None:
        self.sent = 0
        self._make = make
        self._dictionary = dictionary
        self._listeners = listeners
        self._counts = counts
        self._by_id: dict[int, ShownChannel] = {}
        self._topics: dict[str, tuple[str, ShownChannel]] = {}  # with the md5sum
        self._packets: dict[str, ShownChannel] = {}
        for declared in dictionary.telemetry.values():
            if isinstance(declared, Telemetry):
                self._packet(f"{PACKETS}{declared.name}", declared, declared.msg_id)
        self._events = self._json(EVENTS, "foxglove.Log", log_schema(), {})

    # -- topics ------------------------------------------------------------------------------------------------------

    def announce(self, topic: str, header: Mapping[str, str]) -> ShownChannel:
        """A topic of ROS with its type; of another type than before, its former channel ends.

        Args:
            topic: its name.
            header: the connection header of a publisher, with type, md5sum and message_definition.
        """
        known = self._topics.get(topic)
        if known is not None and known[0] == header["md5sum"]:
            return known[1]
        if known is not None:
            del self._by_id[known[1].id]
            known[1].close()
        schema = (header["type"], "ros1msg", header["message_definition"].encode())
        made = self._keep(topic, self._make(topic, "ros1", schema, {"md5sum": header["md5sum"]}))
        self._topics[topic] = (header["md5sum"], made)
        return made

    def show_message(self, message: TopicMessage) -> None:
        """A message was published."""
        header = message.header
        if header["md5sum"] == "*" or "message_definition" not in header:
            return  # of a type that nobody has told yet
        channel = self.announce(message.topic, header)
        time_ns = message.stamp_ns or 0  # /clock has not begun
        if header.get("latching") == "1":
            channel.latched[header.get("callerid", "")] = (message.data, time_ns)
        self.sent += channel.show(message.data, time_ns)

    def greet(self, channel: int, client: int) -> None:
        """A viewer has subscribed to a channel: it gets the latched messages, as a new subscriber in ROS does."""
        found = self._by_id.get(channel)
        if found is not None:
            for data, time_ns in found.latched.values():
                self.sent += found.show(data, time_ns, client)

    # -- packets and events ------------------------------------------------------------------------------------------

    def show_packet(self, seen: Seen, declared: Command | Telemetry | None, time_ns: int) -> None:
        """A packet was sent that is no message of ROS."""
        name = f"{PACKETS}{f'0x{seen.msg_id:04X}' if declared is None else declared.name}"
        channel = self._packets.get(name) or self._packet(name, declared, seen.msg_id)
        if channel.is_heard:
            self.sent += channel.show(packet_json(seen, self._dictionary.decode(seen.packet)), time_ns)
        if seen.msg_id in EVENT_IDS and self._events.is_heard:
            self._show_event(seen, time_ns)

    def _show_event(self, seen: Seen, time_ns: int) -> None:
        try:
            event = DecodedEvent.of(seen)
        except (CfeError, UsageError):
            return  # an application has sent something else on this MsgId, which the packet's own channel shows
        self.sent += self._events.show(event_json(event, time_ns), time_ns)

    def _packet(self, name: str, declared: Command | Telemetry | None, msg_id: int) -> ShownChannel:
        title = name[1:].replace("/", ".")
        made = self._json(name, title, packet_schema(name, declared), {"msg_id": f"0x{msg_id:04X}"})
        self._packets[name] = made
        return made

    def _json(self, name: str, title: str, schema: bytes, about: Mapping[str, str]) -> ShownChannel:
        return self._keep(name, self._make(name, "json", (title, "jsonschema", schema), about))

    def _keep(self, name: str, channel: Any) -> ShownChannel:
        made = ShownChannel(name, channel, self._listeners, self._counts)
        self._by_id[made.id] = made
        return made

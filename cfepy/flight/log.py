"""The log of a flight: packets, events, messages on topics and console lines, in order.

It observes the Software Bus and changes nothing, so the trace is the same as without it.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from cfepy.attachment import Attachment
from cfepy.ground import (
    EVENT_IDS,
    DecodedEvent,
    Dictionary,
    MessageDecoder,
    SeriesSet,
    Topic,
    dictionary_of,
    flat,
    packet_series,
    topics_of,
)
from cfepy.interpreter.cached import CachedProperty
from cfepy.mission import Mission, MissionSpec, PacketWatch, Seen, TopicWatch
from cfepy.monitors import Heard
from cfepy.msg import Command, MsgType, get_type
from cfepy.sb import SoftwareBus
from cfepy.units import NS_PER_S


class Packet:
    """A decoded telemetry packet; `packet["PacketID.AppName"]` returns a field by its path.

    Attributes:
        name: its name in the dictionary.
        at: virtual time in s at which it was sent.
        sender: the application that sent it.
        values: its fields, as nested dictionaries.
        flat: its fields by path.
        data: its bytes.
    """

    def __init__(self, seen: Seen, dictionary: Dictionary) -> None:
        decoded = dictionary.decode(seen.packet)
        self.name, self.values = decoded.name, decoded.values
        self.at, self.sender, self.data = seen.at_ns / NS_PER_S, seen.sender, seen.packet
        self.flat = flat(self.values)

    def __getitem__(self, path: str) -> Any:
        return self.values[path] if path in self.values else self.flat[path]

    def __repr__(self) -> str:
        fields = ", ".join(f"{path}={value!r}" for path, value in self.flat.items())
        return f"<{self.name} at {self.at:.3f} s: {fields}>"


class Here(NamedTuple):
    """A position in a log: the numbers of events, console lines, packets by MsgId and messages by topic."""

    events: int
    lines: int
    packets: dict[int, int]
    messages: dict[str, int]


START = Here(0, 0, {}, {})


class FlightLog(Attachment):
    """Records everything sent in a mission.

    Args:
        spec: the mission.

    Attributes:
        events: all events, in order.
        packets: telemetry and commands by MsgId, in order.
        topics: the messages on ROS topics.
        lines: the lines of the console.
    """

    def __init__(self, spec: MissionSpec) -> None:
        self.events: list[DecodedEvent] = []
        self.packets: dict[int, list[Seen]] = {}
        self.topics = SeriesSet()
        self.lines: list[str] = []
        self._spec = spec
        self._decoder = MessageDecoder()
        self._heard: dict[str, list[Heard]] = {}
        self._declared = SeriesSet()  # of packets
        self._in_series: dict[int, int] = {}  # how many packets of a MsgId are in it
        self._packet_watch = PacketWatch(self._take_packet)
        self._topic_watch = TopicWatch(self.topics.take_message)
        self._mission: Mission | None = None

    @CachedProperty
    def dictionary(self) -> Dictionary:
        """Return the mission's packets by name, created on demand, because it requires reading the
        applications' code.
        """
        return dictionary_of(self._spec)

    def bus(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
        return self._topic_watch.hearing(self._packet_watch.bus(base))  # each packet is observed only once

    def begin(self, mission: Mission) -> None:
        self._mission = mission
        self.lines = mission.console.lines
        self._topic_watch.begin(mission)

    def _take_packet(self, seen: Seen) -> None:
        self.packets.setdefault(seen.msg_id, []).append(seen)
        self._topic_watch.take_packet(seen)
        if seen.msg_id in EVENT_IDS:
            self.events.append(DecodedEvent.of(seen))

    def heard(self, topic: str) -> list[Heard]:
        """Return the messages on a ROS topic."""
        series = self.topics.get(topic)
        if series is None:
            return []
        found = self._heard.setdefault(topic, [])
        found += [Heard.of(message, self._decoder) for message in series.sent[len(found) :]]
        return found

    def here(self) -> Here:
        """Return the present end of the log."""
        packets = {msg_id: len(seen) for msg_id, seen in self.packets.items()}
        messages = {name: len(self.topics.series(name)) for name in self.topics.names}
        return Here(len(self.events), len(self.lines), packets, messages)

    def packet(self, seen: Seen) -> Packet:
        """Return a packet, decoded."""
        dictionary = self.dictionary
        entry = dictionary.telemetry_of(f"0x{seen.msg_id:04X}")
        if isinstance(entry, Topic) and not entry.type and self._mission is not None:
            dictionary.learn(topics_of(self._mission))
        return Packet(seen, dictionary)

    def series(self) -> SeriesSet:
        """Return everything sent so far with a known layout: topics, telemetry and commands by name."""
        found = SeriesSet()
        for name in self.topics.names:
            found.add(self.topics.series(name))
        for msg_id, packets in self.packets.items():
            for seen in packets[self._in_series.get(msg_id, 0) :]:
                self._take_into_series(seen)
            self._in_series[msg_id] = len(packets)
        for name in self._declared.names:
            found.add(self._declared.series(name))
        return found

    def _take_into_series(self, seen: Seen) -> None:
        entry = self.dictionary.declared_as(seen.packet)
        if entry is None:
            return
        series = self._declared.get(entry.name)
        if series is None:
            series = packet_series(entry.name, isinstance(entry, Command), self.dictionary)
            self._declared.add(series)
        series.add(seen)

    def telemetry_names(self) -> list[str]:
        """Return the names of the telemetry packets sent so far, in the order of their first packets."""
        sent = [seen[0] for seen in self.packets.values()]
        return [self.dictionary.decode(each.packet).name for each in sent if get_type(each.packet) == MsgType.TLM]

"""The log of a flight: packets, events, messages on topics and console lines, in the order in which they came.

It watches the Software Bus and changes nothing, so the run has the trace of one that is not watched.
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
    """A telemetry packet that was read; `packet["PacketID.AppName"]` gives a field by its path.

    Attributes:
        name: as the dictionary has it.
        at: virtual time of sending in s.
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
    """A place in a log: how many events, console lines, packets by MsgId, messages by topic there were."""

    events: int
    lines: int
    packets: dict[int, int]
    messages: dict[str, int]


START = Here(0, 0, {}, {})


class FlightLog(Attachment):
    """Takes down what is sent in a mission.

    Args:
        spec: the mission's.

    Attributes:
        events: all events, in order.
        packets: telemetry and commands by MsgId, in order.
        topics: the messages on ROS topics.
        lines: of the console.
    """

    def __init__(self, spec: MissionSpec) -> None:
        self.events: list[DecodedEvent] = []
        self.packets: dict[int, list[Seen]] = {}
        self.topics = SeriesSet()
        self.lines: list[str] = []
        self._spec = spec
        self._decoder = MessageDecoder()
        self._heard: dict[str, list[Heard]] = {}
        self._packet_watch = PacketWatch(self._take_packet)
        self._topic_watch = TopicWatch(self.topics.take_message)
        self._mission: Mission | None = None

    @CachedProperty
    def dictionary(self) -> Dictionary:
        """The mission's packets by name; made when first asked for, since the applications' code is read for it."""
        return dictionary_of(self._spec)

    def bus(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
        return self._topic_watch.hearing(self._packet_watch.bus(base))  # a packet is looked at once

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
        """The messages on a ROS topic."""
        series = self.topics.get(topic)
        if series is None:
            return []
        found = self._heard.setdefault(topic, [])
        found += [Heard.of(message, self._decoder) for message in series.sent[len(found) :]]
        return found

    def here(self) -> Here:
        """Where what is still to come begins."""
        packets = {msg_id: len(seen) for msg_id, seen in self.packets.items()}
        messages = {name: len(self.topics.series(name)) for name in self.topics.names}
        return Here(len(self.events), len(self.lines), packets, messages)

    def packet(self, seen: Seen) -> Packet:
        """A packet, read."""
        dictionary = self.dictionary
        entry = dictionary.telemetry_of(f"0x{seen.msg_id:04X}")
        if isinstance(entry, Topic) and not entry.type and self._mission is not None:
            dictionary.learn(topics_of(self._mission))
        return Packet(seen, dictionary)

    def series(self) -> SeriesSet:
        """Everything that was sent until now and whose layout is known: topics, telemetry and commands by name."""
        found, dictionary = SeriesSet(), self.dictionary
        for name in self.topics.names:
            found.add(self.topics.series(name))
        for seen in (seen for packets in self.packets.values() for seen in packets):
            entry = dictionary.declared_as(seen.packet)
            if entry is None:
                continue
            series = found.get(entry.name)
            if series is None:
                series = packet_series(entry.name, isinstance(entry, Command), dictionary)
                found.add(series)
            series.add(seen)
        return found

    def telemetry_names(self) -> list[str]:
        """Names of the telemetry packets that were sent, in the order in which they first came."""
        sent = [seen[0] for seen in self.packets.values()]
        return [self.dictionary.decode(each.packet).name for each in sent if get_type(each.packet) == MsgType.TLM]

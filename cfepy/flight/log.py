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
    Series,
    SeriesSet,
    Topic,
    dictionary_of,
    flat,
    packet_series,
    topics_of,
)
from cfepy.ground.on_demand import DecodingList, OnDemand
from cfepy.interpreter.cached import CachedProperty
from cfepy.mission import Mission, MissionSpec, PacketWatch, Seen, TopicWatch
from cfepy.monitors import Heard
from cfepy.msg import TLM_HEADER_SIZE, Command, MsgType, Telemetry, get_header_size, get_type
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
        self._heard: dict[str, DecodingList[Heard]] = {}
        self._read: dict[int, DecodingList[Packet]] = {}  # by MsgId
        self._series: dict[int, dict[str, Series]] = {}  # of packets, by MsgId and name
        self._in_series: dict[int, int] = {}  # how many packets of a MsgId are in them
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

    def heard(self, topic: str) -> OnDemand[Heard]:
        """Return the messages on a ROS topic so far."""
        found = self._heard.get(topic)
        if found is None:
            series = self.topics.get(topic)
            found = DecodingList(
                () if series is None else series.sent, lambda message: Heard.of(message, self._decoder)
            )
            if series is not None:
                self._heard[topic] = found
        return found.present()

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

    def read(self, msg_id: int) -> OnDemand[Packet]:
        """Return the packets of a MsgId so far, decoded."""
        found = self._read.get(msg_id)
        if found is None:
            found = DecodingList(self.packets.get(msg_id, ()), self.packet)
            if msg_id in self.packets and isinstance(self.dictionary.telemetry_of(f"0x{msg_id:04X}"), Telemetry):
                self._read[msg_id] = found  # that of a topic may get a type later
        return found.present()

    def series(self) -> SeriesSet:
        """Return everything sent so far with a known layout: topics, telemetry and commands by name."""
        found = SeriesSet()
        for name in self.topics.names:
            found.add(self.topics.series(name))
        for msg_id in self.packets:
            for series in self._of_msg_id(msg_id):
                found.add(series)
        return found

    def series_of(self, name: str) -> Series | None:
        """Return the messages of a topic, or the packets of a name, sent so far; None if there is none."""
        series = self.topics.get(name)
        if series is not None:
            return series
        entry = self.dictionary.telemetry.get(name) or self.dictionary.commands.get(name)
        of_msg_id = () if entry is None or entry.msg_id not in self.packets else self._of_msg_id(entry.msg_id)
        return next((each for each in of_msg_id if each.name == name), None)

    def _of_msg_id(self, msg_id: int) -> list[Series]:
        """Return the series of the packets of a MsgId. All of a telemetry packet are one series. Packets that share
        a MsgId are sorted one by one, each once.
        """
        packets = self.packets[msg_id]
        found = self._series.setdefault(msg_id, {})
        is_telemetry = get_header_size(packets[0].packet) == TLM_HEADER_SIZE
        entry = self.dictionary.telemetry_of(f"0x{msg_id:04X}")
        if is_telemetry and self.dictionary.declared_as(packets[0].packet) is None:
            return []
        if is_telemetry and isinstance(entry, Telemetry) and not entry.variants:
            if entry.name not in found:
                found[entry.name] = packet_series(entry.name, False, self.dictionary, packets)
            return [*found.values()]
        for seen in packets[self._in_series.get(msg_id, 0) :]:
            each = self.dictionary.declared_as(seen.packet)
            if each is not None:
                if each.name not in found:
                    found[each.name] = packet_series(each.name, isinstance(each, Command), self.dictionary)
                found[each.name].add(seen)
        self._in_series[msg_id] = len(packets)
        return [*found.values()]

    def telemetry_names(self) -> list[str]:
        """Return the names of the telemetry packets sent so far, in the order of their first packets."""
        sent = [seen[0] for seen in self.packets.values()]
        return [self.dictionary.decode(each.packet).name for each in sent if get_type(each.packet) == MsgType.TLM]

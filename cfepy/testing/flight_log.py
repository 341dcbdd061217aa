"""Everything that a test can look back at: packets, events and ROS messages, as they were sent.

It looks on at the Software Bus, so it changes nothing: the run has the trace of one that nobody watches.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from cfepy.attachment import Attachment
from cfepy.mission.dictionary import Dictionary
from cfepy.mission.message_watch import Heard, MessageWatch
from cfepy.mission.mission import Mission
from cfepy.mission.script_packets import EVENT_IDS, Event
from cfepy.mission.spec import MissionSpec
from cfepy.mission.topics import Topic, topics_of
from cfepy.mission.values import flat
from cfepy.mission.watch import PacketWatch, Seen
from cfepy.msg import MsgType, get_type
from cfepy.rtos.units import NS_PER_S
from cfepy.sb import SoftwareBus

ALL_TOPICS = ("*",)


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
        dictionary: gives its packets by name, when they are first asked for.

    Attributes:
        events: all events, in order.
        packets: telemetry and commands by MsgId, in order.
        messages: messages by topic, in order.
        lines: of the console.
    """

    def __init__(self, spec: MissionSpec, dictionary: Callable[[], Dictionary]) -> None:
        self.events: list[Event] = []
        self.packets: dict[int, list[Seen]] = {}
        self.messages: dict[str, list[Heard]] = {}
        self.lines: list[str] = []
        self._dictionary = dictionary
        self._watches = (PacketWatch(self._take_packet), MessageWatch(spec, self._take_message, ALL_TOPICS))
        self._mission: Mission | None = None

    def bus(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
        """See `Attachment.bus`."""
        for each in self._watches:
            base = each.bus(base)
        return base

    def begin(self, mission: Mission) -> None:
        """See `Attachment.begin`."""
        self._mission = mission
        self.lines = mission.console.lines
        for each in self._watches:
            each.begin(mission)

    def _take_packet(self, seen: Seen) -> None:
        self.packets.setdefault(seen.msg_id, []).append(seen)
        if seen.msg_id in EVENT_IDS:
            self.events.append(Event.of(seen))

    def _take_message(self, message: Heard) -> None:
        self.messages.setdefault(message.topic, []).append(message)

    def here(self) -> Here:
        """Where what is still to come begins."""
        packets = {msg_id: len(seen) for msg_id, seen in self.packets.items()}
        messages = {name: len(heard) for name, heard in self.messages.items()}
        return Here(len(self.events), len(self.lines), packets, messages)

    def packet(self, seen: Seen) -> Packet:
        """A packet, read."""
        dictionary = self._dictionary()
        entry = dictionary.telemetry_of(f"0x{seen.msg_id:04X}")
        if isinstance(entry, Topic) and not entry.type and self._mission is not None:
            dictionary.learn(topics_of(self._mission))
        return Packet(seen, dictionary)

    def telemetry_names(self) -> list[str]:
        """Names of the telemetry packets that were sent, in the order in which they first came."""
        sent = [seen[0] for seen in self.packets.values()]
        return [self._dictionary().decode(each.packet).name for each in sent if get_type(each.packet) == MsgType.TLM]

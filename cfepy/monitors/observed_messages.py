"""Observation of selected messages of a mission, ROS topics as well as cFE packets, decoded.

It observes the Software Bus without changing anything: no subscription, no virtual time, no record in the trace.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from cfepy.attachment import Attachment
from cfepy.ground import Dictionary, MessageDecoder, dictionary_of, measured_fields
from cfepy.mission import Mission, MissionSpec, PacketWatch, Seen, TopicMessage, TopicWatch
from cfepy.msg import Command, Measurement, Telemetry, get_fcn_code
from cfepy.sb import SoftwareBus
from cfepy.status import UsageError, together
from cfepy.units import NS_PER_S


class Fields(dict[str, Any]):
    """Fields of a packet: `msg.PacketID.AppName`, or as a dict.

    A packet without a declared layout has one field `data`: its bytes after the header.
    """

    def __getattr__(self, name: str) -> Any:
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"unknown field {name!r}; the packet has {', '.join(self) or 'none'}") from None


class Heard:
    """A message that was sent.

    Attributes:
        topic: the topic's resolved name, or the packet's name in the dictionary.
        sender: cFE name of the application that sent it, "host" for a message from outside the simulation.
        at_ns: virtual time.
    """

    __slots__ = ("_message", "_read", "at_ns", "sender", "topic")

    def __init__(self, topic: str, sender: str, at_ns: int, read: Callable[[], Any]) -> None:
        self.topic, self.sender, self.at_ns = topic, sender, at_ns
        self._read = read
        self._message: Any = None

    @classmethod
    def of(cls, message: TopicMessage, decoder: MessageDecoder) -> Heard:
        """Return a message on a topic.

        Args:
            message: as it was sent.
            decoder: decodes it as for nodes, on request.
        """
        node = message.header.get("callerid", "")
        return cls(message.topic, node, message.at_ns, lambda: decoder.decode(message))

    @property
    def t(self) -> float:
        """Virtual time of sending in s."""
        return self.at_ns / NS_PER_S

    @property
    def msg(self) -> Any:
        """The message as a node receives it, or the fields of a packet (`Fields`).

        Raises:
            UsageError: if its type is not known, or its bytes are not a valid message.
        """
        if self._message is None:
            self._message = self._read()
        return self._message


def unknown_packets(spec: MissionSpec, section: str, packets: Iterable[tuple[str, str]]) -> UsageError | None:
    """Return one error about all packets of a section that the mission does not have, or None.

    Args:
        spec: the mission.
        section: the section of its mission file.
        packets: the entries of the section, each with the packet that it names.
    """
    dictionary = dictionary_of(spec)
    places = spec.demands[section].mapping() if section in spec.demands else {}
    errors = []
    for entry, packet in packets:
        try:
            _declared(dictionary, packet)
        except UsageError as error:
            plain = UsageError(error.text, file=spec.mission_file, field=f"{section}.{entry}")
            errors.append(places[entry].fail(error.text) if entry in places else plain)
    return together(errors) if errors else None


def _declared(dictionary: Dictionary, name: str) -> tuple[int, int | None]:
    """Return the MsgId of a packet, and the function code of a command."""
    found: Any = dictionary.commands.get(name)
    found = dictionary.telemetry_of(name) if found is None else found
    return found.msg_id, found.code if isinstance(found, Command) else None


class MessageWatch(Attachment):
    """Passes on messages when they are sent.

    Args:
        spec: the mission.
        take: receives each; called inside the simulation, so it must not wait.
        topics: names and patterns of ROS topics; empty for none.
        packets: names in the dictionary, or MsgIds.

    Raises:
        UsageError: if the mission has no such packet.
    """

    def __init__(
        self,
        spec: MissionSpec,
        take: Callable[[Heard], object],
        topics: tuple[str, ...] = (),
        packets: tuple[str, ...] = (),
    ) -> None:
        self._take = take
        self._dictionary = dictionary_of(spec) if packets else Dictionary()
        self._decoder = MessageDecoder()
        self._names: dict[int, dict[int | None, str]] = {}
        for name in packets:
            msg_id, code = _declared(self._dictionary, name)
            self._names.setdefault(msg_id, {})[code] = name
        self._watches: list[TopicWatch | PacketWatch] = []
        if topics:
            self._watches.append(TopicWatch(self._take_message, topics))
        if packets:
            self._watches.append(PacketWatch(self._take_packet, self._names.__contains__))
        self._mission: Mission | None = None

    def measured(self, packet: str) -> Mapping[str, Measurement]:
        """Return the measurements of a telemetry packet, by the path of the field."""
        found = self._dictionary.telemetry.get(packet)
        found = self._dictionary.telemetry_of(packet) if found is None else found
        return measured_fields(found.payload) if isinstance(found, Telemetry) else {}

    def bus(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
        for each in self._watches:
            base = each.bus(base)
        return base

    def begin(self, mission: Mission) -> None:
        self._mission = mission
        for each in self._watches:
            each.begin(mission)

    def _take_message(self, message: TopicMessage) -> None:
        self._take(Heard.of(message, self._decoder))

    def _take_packet(self, seen: Seen) -> None:
        names = self._names[seen.msg_id]
        name = names.get(None) or names.get(get_fcn_code(seen.packet) if seen.msg_id & 0x1000 else None)
        if name is not None:
            self._take(Heard(name, seen.sender, seen.at_ns, lambda: self._fields_of(seen.packet)))

    def _fields_of(self, packet: bytes) -> Fields:
        fields: Fields = _as_fields(self._dictionary.fields_of(packet))
        return fields


def _as_fields(value: Any) -> Any:
    if isinstance(value, Mapping):
        return Fields({name: _as_fields(item) for name, item in value.items()})
    return [_as_fields(item) for item in value] if isinstance(value, list | tuple) else value

"""Looking on at the messages of a mission that somebody has selected: ROS topics and cFE packets alike, decoded.

It looks on at the Software Bus, so it changes nothing: no subscription, no virtual time, no record in the trace.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from cfepy.attachment import Attachment
from cfepy.mission.dictionary import Dictionary, dictionary_of
from cfepy.mission.mission import Mission
from cfepy.mission.spec import MissionSpec
from cfepy.mission.topic_watch import Message, TopicWatch
from cfepy.mission.topics import Topic, library_of
from cfepy.mission.watch import PacketWatch, Seen
from cfepy.msg import Command, get_fcn_code, get_header_size
from cfepy.rtos.units import NS_PER_S
from cfepy.sb import SoftwareBus
from cfepy.status import UsageError


class Fields(dict[str, Any]):
    """The fields of a packet: `msg.PacketID.AppName`, and as a dict.

    A packet whose layout nobody declares has one field, `data`, its bytes behind the header.
    """

    def __getattr__(self, name: str) -> Any:
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"the packet has no field {name!r}; it has {', '.join(self) or 'none'}") from None


class Heard:
    """A message that was sent.

    Attributes:
        topic: the topic's resolved name, or the packet's name in the dictionary.
        sender: the cFE name of the application that sent it, "host" for one from outside the simulation.
        at_ns: virtual time.
    """

    __slots__ = ("_message", "_read", "at_ns", "sender", "topic")

    def __init__(self, topic: str, sender: str, at_ns: int, read: Callable[[], Any]) -> None:
        self.topic, self.sender, self.at_ns = topic, sender, at_ns
        self._read = read
        self._message: Any = None

    @property
    def t(self) -> float:
        """Virtual time of its sending in s."""
        return self.at_ns / NS_PER_S

    @property
    def msg(self) -> Any:
        """The message, as a node gets it; of a packet its fields (`Fields`).

        Raises:
            UsageError: its type is not known, or its bytes are no such message.
        """
        if self._message is None:
            self._message = self._read()
        return self._message


class MessageWatch(Attachment):
    """Shows messages when they are sent.

    Args:
        spec: the mission.
        take: gets each; called inside the simulation, so it must not wait.
        topics: names and patterns of ROS topics; none when it is empty.
        packets: names of the dictionary, or MsgIds.

    Raises:
        UsageError: the mission has no such packet.
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
        self._names: dict[int, dict[int | None, str]] = {}
        for name in packets:
            msg_id, code = self._declared(name)
            self._names.setdefault(msg_id, {})[code] = name
        self._watches: list[TopicWatch | PacketWatch] = []
        if topics:
            self._watches.append(TopicWatch(self._take_message, topics))
        if packets:
            self._watches.append(PacketWatch(self._take_packet, self._names.__contains__))
        self._mission: Mission | None = None

    def bus(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
        """See `Attachment.bus`."""
        for each in self._watches:
            base = each.bus(base)
        return base

    def begin(self, mission: Mission) -> None:
        """See `Attachment.begin`."""
        self._mission = mission
        for each in self._watches:
            each.begin(mission)

    def _declared(self, name: str) -> tuple[int, int | None]:
        """The MsgId of a packet, and the function code of a command."""
        found: Any = self._dictionary.commands.get(name)
        found = self._dictionary.telemetry_of(name) if found is None else found
        return found.msg_id, found.code if isinstance(found, Command) else None

    def _has_layout(self, name: str) -> bool:
        return name in self._dictionary.telemetry or name in self._dictionary.commands

    def _take_message(self, message: Message) -> None:
        about = Topic(
            message.topic, 0, message.header.get("type", ""), False, message.header.get("message_definition", "")
        )
        node = message.header.get("callerid", "")
        self._take(Heard(message.topic, node, message.at_ns, lambda: _message_of(about, message.data)))

    def _take_packet(self, seen: Seen) -> None:
        names = self._names[seen.msg_id]
        name = names.get(None) or names.get(get_fcn_code(seen.packet) if seen.msg_id & 0x1000 else None)
        if name is not None:
            self._take(Heard(name, seen.sender, seen.at_ns, lambda: self._fields_of(seen.packet)))

    def _fields_of(self, packet: bytes) -> Fields:
        decoded = self._dictionary.decode(packet)
        if decoded.problem and not decoded.values and not self._has_layout(decoded.name):
            return Fields(data=packet[get_header_size(packet) :])
        if decoded.problem:
            raise UsageError(f"{decoded.name}: {decoded.problem}")
        fields: Fields = _as_fields(decoded.values)
        return fields


def _message_of(about: Topic, data: bytes) -> Any:
    if not about.type:
        raise UsageError("the type of its messages is not known")
    return library_of(about).message_class(about.type)().deserialize(data)


def _as_fields(value: Any) -> Any:
    if isinstance(value, Mapping):
        return Fields({name: _as_fields(item) for name, item in value.items()})
    return [_as_fields(item) for item in value] if isinstance(value, list | tuple) else value

"""What a mission script can expect on the Software Bus: events, and telemetry with certain values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

from cfepy.evs import packets as evs
from cfepy.evs.events import CRITICAL, DEBUG, ERROR, INFORMATION
from cfepy.mission.script_conditions import OPERATORS, Condition, Scene, Window, seconds
from cfepy.mission.topics import Topic, topics_of
from cfepy.mission.values import flat, line_of, number_of, text_of, unknown_field
from cfepy.mission.watch import Seen
from cfepy.msg import TLM_HEADER_SIZE
from cfepy.status import UsageError

EVENT_TYPES = {"DEBUG": DEBUG, "INFORMATION": INFORMATION, "ERROR": ERROR, "CRITICAL": CRITICAL}
EVENT_IDS = frozenset((evs.LONG_EVENT_MSG_MID, evs.SHORT_EVENT_MSG_MID))
NEAR = 3  # things that are told of those that came instead


class PacketCondition:
    """A condition that packets meet."""

    lasts = False

    def holds(self, scene: Scene, window: Window) -> bool:
        """See `Condition.holds`."""
        return False


@dataclass(frozen=True)
class EventCondition(PacketCondition):
    """An event; None stands for any."""

    app: str | None = None
    event_id: int | None = None
    event_type: int | None = None
    text: str | None = None

    @property
    def msg_ids(self) -> frozenset[int]:
        """See `Condition.msg_ids`."""
        return EVENT_IDS

    def met_by(self, scene: Scene, packet: Seen) -> bool:
        """See `Condition.met_by`."""
        event = Event.of(packet)
        return (
            self.app in (None, event.app)
            and self.event_id in (None, event.event_id)
            and self.event_type in (None, event.event_type)
            and (self.text is None or self.text in event.text)
        )

    def instead(self, scene: Scene, window: Window) -> str:
        """See `Condition.instead`."""
        events = [Event.of(seen) for seen in scene.packets[window.packets :] if seen.msg_id in EVENT_IDS]
        own = [event for event in events if self.app in (None, event.app)]
        if own:
            return "there was " + "; ".join(map(str, own[-NEAR:]))
        others = ", ".join(dict.fromkeys(event.app for event in events))
        return f"there was no event of {self.app}, only of {others}" if others else "there was no event at all"


class Event(NamedTuple):
    """An event as its packet tells it; the short format has no text."""

    at_ns: int
    app: str
    event_id: int
    event_type: int
    text: str

    @classmethod
    def of(cls, seen: Seen) -> Event:
        """The event in a packet of EVS."""
        packet_id = evs.PACKET_ID.unpack(seen.packet, TLM_HEADER_SIZE)
        is_long = seen.msg_id == evs.LONG_EVENT_MSG_MID
        text = evs.LONG_EVENT.unpack(seen.packet, TLM_HEADER_SIZE)["Message"] if is_long else ""
        return cls(seen.at_ns, packet_id["AppName"], packet_id["EventID"], packet_id["EventType"], text)

    @property
    def type_name(self) -> str:
        """DEBUG, INFORMATION, ERROR or CRITICAL."""
        names = {number: name for name, number in EVENT_TYPES.items()}
        return names.get(self.event_type, str(self.event_type))

    def __str__(self) -> str:
        return f'{self.app} {self.event_id} {self.type_name} "{self.text}" at {seconds(self.at_ns)}'


class Comparison(NamedTuple):
    """`path sign value` of a field; a text is compared as it stands, a number as a number."""

    path: str
    sign: str
    value: str

    def holds(self, actual: Any) -> bool:
        """Whether a field's value is as wanted."""
        if isinstance(actual, str | bytes):
            return OPERATORS[self.sign](actual if isinstance(actual, str) else actual.hex(), self.value)
        try:
            return OPERATORS[self.sign](actual, number_of(self.value))
        except ValueError:
            return False

    def __str__(self) -> str:
        return f"{self.path} {self.sign} {self.value}"


@dataclass(frozen=True)
class TelemetryCondition(PacketCondition):
    """A telemetry packet with certain values.

    Args:
        name: as the dictionary has it.
        msg_id: its MsgId.
        comparisons: all have to hold.
    """

    name: str
    msg_id: int
    comparisons: tuple[Comparison, ...] = ()

    @property
    def msg_ids(self) -> frozenset[int]:
        """See `Condition.msg_ids`."""
        return frozenset((self.msg_id,))

    def met_by(self, scene: Scene, packet: Seen) -> bool:
        """See `Condition.met_by`."""
        if not self.comparisons:
            return True
        values = self._values(scene, packet)
        return all(each.path in values and each.holds(values[each.path]) for each in self.comparisons)

    def instead(self, scene: Scene, window: Window) -> str:
        """See `Condition.instead`."""
        packets = [seen for seen in scene.packets[window.packets :] if seen.msg_id == self.msg_id]
        if not packets:
            return f"there was no {self.name}"
        values = self._values(scene, packets[-1])
        try:
            shown = ", ".join(f"{each.path} was {_field(self.name, values, each.path)}" for each in self.comparisons)
        except UsageError as error:
            return str(error)
        count = "1 packet" if len(packets) == 1 else f"{len(packets)} packets"
        return f"{shown} in the last of {count}, at {seconds(packets[-1].at_ns)}"

    def _values(self, scene: Scene, packet: Seen) -> Mapping[str, Any]:
        entry = scene.dictionary.telemetry.get(self.name)
        if isinstance(entry, Topic) and not entry.type:
            scene.dictionary.learn(topics_of(scene.mission))
        return flat(scene.dictionary.decode(packet.packet).values)


def _field(owner: str, values: Mapping[str, Any], path: str) -> str:
    if path not in values:
        raise unknown_field(owner, values, path)
    return text_of(values[path])


def seen_text(condition: Condition, scene: Scene, packet: Seen | None, window: Window) -> str:
    """What met a condition that was not to be met."""
    if packet is None:
        return condition.instead(scene, window)
    if packet.msg_id in EVENT_IDS:
        return f"there was {Event.of(packet)}"
    decoded = scene.dictionary.decode(packet.packet)
    return f"there was {decoded.name} {line_of(decoded.values)} at {seconds(packet.at_ns)}"

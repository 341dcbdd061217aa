"""Conditions in a mission script: an application's state, a file, a line of the console, an event, telemetry.

A condition has no state: it checks the current mission, or a packet from the Software Bus, and describes the actual
state.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple, Protocol

from cfepy.es import STATE_NAMES
from cfepy.ground import (
    EVENT_IDS,
    AbsentError,
    DecodedEvent,
    Dictionary,
    RosSide,
    Topic,
    flat,
    number_of,
    plain,
    text_of,
    topics_of,
    unknown_field,
)
from cfepy.mission import CALL, PUBLISH, HostCall, Mission, Seen, receivers
from cfepy.msg import get_msg_id
from cfepy.osal import FileNode
from cfepy.status import CfeError, OsalError, UsageError
from cfepy.units import NS_PER_S

GONE = "GONE"
APP_STATES = (*STATE_NAMES.values(), GONE)
OPERATORS: dict[str, Callable[[Any, Any], bool]] = {
    "==": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}
NEAR = 3  # maximum number of other findings in a description


@dataclass(frozen=True, slots=True)
class RosAction:
    """An action of a step on the ROS side.

    Attributes:
        kind: PUBLISH, CALL or PARAM.
        name: name of the topic, service or parameter.
        value: the parameter's value, or the fields of the message by name.
        text: the step without its time.
    """

    kind: str
    name: str
    value: Any
    text: str


class Since(NamedTuple):
    """Start of an expectation: the first packet and console line that count."""

    packets: int
    lines: int


@dataclass(slots=True)
class Collected:
    """Packets sent so far, by number from 0.

    Attributes:
        most: minimum number of packets that are kept; None for all. Older ones are dropped.
    """

    most: int | None = None
    _kept: list[Seen] = field(default_factory=list)
    _gone: int = 0

    def append(self, packet: Seen) -> None:
        """Add a packet."""
        self._kept.append(packet)
        if self.most is not None and len(self._kept) > 2 * self.most:
            self._gone += len(self._kept) - self.most
            del self._kept[: -self.most]

    def __len__(self) -> int:
        return self._gone + len(self._kept)

    def since(self, number: int) -> list[Seen]:
        """Return the packets from a number on, as far as they are kept."""
        return self._kept[max(0, number - self._gone) :]


class Scene:
    """Objects that conditions check and steps act on: a mission, its dictionary, and the packets sent so far.

    Args:
        mission: None for another computer, of which only packets are known.
        dictionary: names the packets.
        packets: collects them.

    Attributes:
        mark_ns, since: time of a script's last action, and the position from which packets count after it.
        call: the last service call; None before the first.
    """

    def __init__(self, mission: Mission | None, dictionary: Dictionary, packets: Collected) -> None:
        self.dictionary = dictionary
        self.packets = packets
        self.mark_ns = 0
        self.since = Since(0, 0)
        self.call: HostCall | None = None
        self._mission = mission

    @property
    def mission(self) -> Mission:
        """The mission.

        Raises:
            UsageError: if there is no mission.
        """
        if self._mission is None:
            raise UsageError("a remote target can only be checked by its packets; expect events or telemetry")
        return self._mission

    @property
    def has_mission(self) -> bool:
        """Whether there is a mission."""
        return self._mission is not None

    @property
    def now_ns(self) -> int:
        """The virtual time in ns."""
        return self.mission.kernel.now

    def here(self) -> Since:
        """Return the start for things that are still to come."""
        return Since(len(self.packets), len(self.mission.console.lines))

    def set_mark(self) -> None:
        """Mark that a script acts now."""
        self.mark_ns, self.since = self.now_ns, self.here()

    def send(self, packet: bytes, must_arrive: bool) -> str:
        """Put a packet on the bus.

        Args:
            packet: its bytes.
            must_arrive: whether a packet without subscribers is an error.

        Returns:
            The error; "" if there was none.
        """
        detail = ""
        if must_arrive and not receivers(self.mission.cfe.sb, get_msg_id(packet)):
            detail = f"MsgId 0x{get_msg_id(packet):04X} has no subscriber at this time"
        try:
            self.transmit(packet)
        except CfeError as error:
            detail = str(error)
        return detail

    def transmit(self, packet: bytes) -> None:
        """Put a packet on the bus as it is.

        Raises:
            CfeError: if the bus refuses it.
        """
        self.mission.cfe.sb.transmit_msg(packet, is_origination=False)

    def perform(self, action: RosAction) -> str:
        """Carry out an action on the ROS side; a service call goes on while the mission runs.

        Returns:
            The error; "" if there was none.
        """
        ros = self._ros
        try:
            if action.kind == PUBLISH:
                ros.publish(action.name, None, action.value)
            elif action.kind == CALL:
                self.call = ros.call(action.name, None, action.value)
            else:
                ros.set_param(action.name, action.value)
        except (AbsentError, CfeError, UsageError) as error:
            return str(error)
        return ""

    def parameter(self, name: str) -> Any:
        """Return the value of a ROS parameter.

        Raises:
            AbsentError: if it does not exist.
        """
        return self._ros.param(name)

    @property
    def _ros(self) -> RosSide:
        return RosSide(self.mission, self.act)

    def act(self, name: str, *values: Any) -> Any:
        """Carry out a host action; see `cfepy.mission.host_actions`."""
        return self.mission.outside.do(name, *values)

    def learn_topics(self) -> None:
        """Update the dictionary with the topics that the mission has now."""
        self.dictionary.learn(topics_of(self.mission))


class Condition(Protocol):
    """An expected condition. `lasts` is whether it is a state, which is checked at once, and not an event."""

    lasts: bool

    @property
    def msg_ids(self) -> frozenset[int]:
        """MsgIds of the packets that can meet it; empty if it is checked on the current mission."""

    def met_by(self, scene: Scene, packet: Seen) -> bool:
        """Return whether a packet meets it."""

    def holds(self, scene: Scene, since: Since) -> bool:
        """Return whether the current mission meets it."""

    def is_hopeless(self, scene: Scene) -> bool:
        """Return whether it can no longer be met."""

    def instead(self, scene: Scene, since: Since) -> str:
        """Return a description of the actual state; for an unwanted condition, of the finding that met it."""


class StateCondition:
    """A condition on the current mission."""

    lasts = True
    msg_ids: frozenset[int] = frozenset()

    def met_by(self, scene: Scene, packet: Seen) -> bool:
        return False

    def is_hopeless(self, scene: Scene) -> bool:
        return False


def seconds(ns: int) -> str:
    """Return a virtual time as shown in verdicts."""
    return f"{ns / NS_PER_S:.3f}"


@dataclass(frozen=True)
class AppCondition(StateCondition):
    """An application in a state; GONE for one that does not exist, None for any that does."""

    name: str
    state: str | None = None

    def holds(self, scene: Scene, since: Since) -> bool:
        state = self._state(scene)
        return state != GONE if self.state is None else state == self.state

    def instead(self, scene: Scene, since: Since) -> str:
        state = self._state(scene)
        if state != GONE:
            return f"it is {state}"
        return f"there are {', '.join(app.name for app in scene.mission.cfe.es.apps)}"

    def _state(self, scene: Scene) -> str:
        app = next((app for app in scene.mission.cfe.es.apps if app.name == self.name), None)
        return GONE if app is None else STATE_NAMES[app.state]


@dataclass(frozen=True)
class ResetCondition(StateCondition):
    """The processor has been reset more often than a given number in this run."""

    times: int

    def holds(self, scene: Scene, since: Since) -> bool:
        return len(scene.mission.record.resets) > self.times

    def instead(self, scene: Scene, since: Since) -> str:
        return "the processor was not reset"


@dataclass(frozen=True)
class FileCondition(StateCondition):
    """A file of the mission, with a size in bytes if given."""

    path: str
    sign: str = ">="
    size: int = 0

    def holds(self, scene: Scene, since: Since) -> bool:
        node = self._node(scene)
        return node is not None and OPERATORS[self.sign](len(node.data), self.size)

    def instead(self, scene: Scene, since: Since) -> str:
        node = self._node(scene)
        if node is not None:
            return f"it has {len(node.data)} bytes"
        folder = self.path.rpartition("/")[0] or "/"
        try:
            names: Sequence[str] = scene.mission.files.list_dir(folder)
        except OsalError:
            return f"the folder {folder} does not exist"
        return f"{folder} has {', '.join(names) or 'no files'}"

    def _node(self, scene: Scene) -> FileNode | None:
        try:
            return scene.mission.files.find(self.path)
        except OsalError:
            return None


@dataclass(frozen=True)
class ConsoleCondition(StateCondition):
    """A line of the console that contains a text."""

    lasts = False

    text: str

    def holds(self, scene: Scene, since: Since) -> bool:
        return any(self.text in line for line in scene.mission.console.lines[since.lines :])

    def instead(self, scene: Scene, since: Since) -> str:
        lines = scene.mission.console.lines[since.lines :]
        found = [line for line in lines if self.text in line]
        if found:
            return f'there was "{found[0]}"'
        return f'the last line was "{lines[-1]}"' if lines else "the console is empty"


class Comparison(NamedTuple):
    """`path sign value` of a field; texts are compared as text, numbers as numbers."""

    path: str
    sign: str
    value: str

    def holds(self, actual: Any) -> bool:
        """Return whether a field's value is as wanted."""
        if isinstance(actual, str | bytes):
            return OPERATORS[self.sign](actual if isinstance(actual, str) else actual.hex(), self.value)
        try:
            return OPERATORS[self.sign](actual, number_of(self.value))
        except ValueError:
            return False

    def __str__(self) -> str:
        return f"{self.path} {self.sign} {self.value}"


@dataclass(frozen=True)
class CallCondition(StateCondition):
    """The last service call has a response."""

    def holds(self, scene: Scene, since: Since) -> bool:
        return scene.call is not None and scene.call.response is not None

    def is_hopeless(self, scene: Scene) -> bool:
        return scene.call is not None and scene.call.error is not None

    def instead(self, scene: Scene, since: Since) -> str:
        return str(scene.call.error) if scene.call is not None and scene.call.error is not None else "no response came"


@dataclass(frozen=True)
class ResponseCondition(StateCondition):
    """The last response of a service has given values."""

    comparisons: tuple[Comparison, ...]

    def holds(self, scene: Scene, since: Since) -> bool:
        values = self._values(scene)
        return values is not None and all(
            each.path in values and each.holds(values[each.path]) for each in self.comparisons
        )

    def instead(self, scene: Scene, since: Since) -> str:
        values = self._values(scene)
        if values is None:
            return "no service has responded"
        missing = [each.path for each in self.comparisons if each.path not in values]
        if missing:
            return str(unknown_field("the response", values, missing[0]))
        return ", ".join(f"{each.path} was {text_of(values[each.path])}" for each in self.comparisons)

    def _values(self, scene: Scene) -> Mapping[str, Any] | None:
        if scene.call is None or scene.call.response is None:
            return None
        return flat(plain(scene.call.response))


@dataclass(frozen=True)
class ParameterCondition(StateCondition):
    """A ROS parameter exists, and has a given value.

    Args:
        name: its full name.
        comparison: None for any value.
    """

    name: str
    comparison: Comparison | None = None

    def holds(self, scene: Scene, since: Since) -> bool:
        try:
            value = scene.parameter(self.name)
        except AbsentError:
            return False
        return self.comparison is None or self.comparison.holds(value)

    def instead(self, scene: Scene, since: Since) -> str:
        try:
            return f"it is {text_of(scene.parameter(self.name))}"
        except AbsentError as error:
            return str(error)


class PacketCondition:
    """A condition that packets can meet."""

    lasts = False

    def is_hopeless(self, scene: Scene) -> bool:
        return False

    def holds(self, scene: Scene, since: Since) -> bool:
        return False


@dataclass(frozen=True)
class EventCondition(PacketCondition):
    """An event; None for any."""

    app: str | None = None
    event_id: int | None = None
    event_type: int | None = None
    text: str | None = None

    @property
    def msg_ids(self) -> frozenset[int]:
        return EVENT_IDS

    def met_by(self, scene: Scene, packet: Seen) -> bool:
        event = DecodedEvent.of(packet)
        return (
            self.app in (None, event.app)
            and self.event_id in (None, event.event_id)
            and self.event_type in (None, event.event_type)
            and (self.text is None or self.text in event.text)
        )

    def instead(self, scene: Scene, since: Since) -> str:
        events = [DecodedEvent.of(seen) for seen in scene.packets.since(since.packets) if seen.msg_id in EVENT_IDS]
        own = [event for event in events if self.app in (None, event.app)]
        if own:
            return "there was " + "; ".join(map(str, own[-NEAR:]))
        others = ", ".join(dict.fromkeys(event.app for event in events))
        return f"no event of {self.app} was sent, only of {others}" if others else "no event was sent"


@dataclass(frozen=True)
class TelemetryCondition(PacketCondition):
    """A telemetry packet with given values.

    Args:
        name: name in the dictionary.
        msg_id: its MsgId.
        comparisons: all must hold.
    """

    name: str
    msg_id: int
    comparisons: tuple[Comparison, ...] = ()

    @property
    def is_topic(self) -> bool:
        """Whether the packet is a message of a topic."""
        return self.name.startswith("/")

    @property
    def msg_ids(self) -> frozenset[int]:
        return frozenset((self.msg_id,))

    def met_by(self, scene: Scene, packet: Seen) -> bool:
        if not self.comparisons:
            return True
        values = self._values(scene, packet)
        return all(each.path in values and each.holds(values[each.path]) for each in self.comparisons)

    def instead(self, scene: Scene, since: Since) -> str:
        packets = [seen for seen in scene.packets.since(since.packets) if seen.msg_id == self.msg_id]
        if not packets:
            return f"no {self.name} was sent"
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
            scene.learn_topics()
        return flat(scene.dictionary.decode(packet.packet).values)


def _field(owner: str, values: Mapping[str, Any], path: str) -> str:
    if path not in values:
        raise unknown_field(owner, values, path)
    return text_of(values[path])


def seen_text(condition: Condition, scene: Scene, packet: Seen | None, since: Since) -> str:
    """Return the finding that met an unwanted condition."""
    if packet is None:
        return condition.instead(scene, since)
    if packet.msg_id in EVENT_IDS:
        return f"there was {DecodedEvent.of(packet)}"
    decoded = scene.dictionary.decode(packet.packet)
    return f"there was {decoded.name} {decoded.line(raw=True)} at {seconds(packet.at_ns)}"

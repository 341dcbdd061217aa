"""What a mission script can expect of the mission as it is: an application's state, a file, a line of the console.

A condition keeps no state: it judges the mission, or a packet (`cfepy.mission.script_packets`), and says what there was
instead.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

from cfepy.es.records import STATE_NAMES
from cfepy.mission.dictionary import Dictionary
from cfepy.mission.mission import Mission
from cfepy.mission.watch import Seen
from cfepy.osal.volumes import Node
from cfepy.rtos.units import NS_PER_S
from cfepy.status import OsalError

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


class Window(NamedTuple):
    """From where on an expectation looks: the first packet and console line that count."""

    packets: int
    lines: int


@dataclass(slots=True)
class Scene:
    """What conditions look at: the mission, its dictionary, and the packets that were collected so far."""

    mission: Mission
    dictionary: Dictionary
    packets: list[Seen]

    def here(self) -> Window:
        """Where things begin that are still to come."""
        return Window(len(self.packets), len(self.mission.console.lines))


class Condition(Protocol):
    """Something that can be expected. `lasts` says that it is a state, which is judged at once, and no occurrence."""

    lasts: bool

    @property
    def msg_ids(self) -> frozenset[int]:
        """MsgIds of the packets that can meet it; none when the mission as it is meets it."""

    def met_by(self, scene: Scene, packet: Seen) -> bool:
        """Whether this packet meets it."""

    def holds(self, scene: Scene, window: Window) -> bool:
        """Whether the mission as it is meets it."""

    def instead(self, scene: Scene, window: Window) -> str:
        """What there was instead; for something that must not be, what there was."""


class StateCondition:
    """A condition on the mission as it is."""

    lasts = True
    msg_ids: frozenset[int] = frozenset()

    def met_by(self, scene: Scene, packet: Seen) -> bool:
        """See `Condition.met_by`."""
        return False


def seconds(ns: int) -> str:
    """A virtual time as verdicts show it."""
    return f"{ns / NS_PER_S:.3f}"


@dataclass(frozen=True)
class AppCondition(StateCondition):
    """An application in a state; GONE stands for one that does not exist, None for any that does."""

    name: str
    state: str | None = None

    def holds(self, scene: Scene, window: Window) -> bool:
        """See `Condition.holds`."""
        state = self._state(scene)
        return state != GONE if self.state is None else state == self.state

    def instead(self, scene: Scene, window: Window) -> str:
        """See `Condition.instead`."""
        state = self._state(scene)
        if state != GONE:
            return f"it is {state}"
        return f"there are {', '.join(app.name for app in scene.mission.cfe.es.apps)}"

    def _state(self, scene: Scene) -> str:
        app = next((app for app in scene.mission.cfe.es.apps if app.name == self.name), None)
        return GONE if app is None else STATE_NAMES[app.state]


@dataclass(frozen=True)
class ResetCondition(StateCondition):
    """The processor has been reset more than so many times in this run."""

    times: int

    def holds(self, scene: Scene, window: Window) -> bool:
        """See `Condition.holds`."""
        return len(scene.mission.record.resets) > self.times

    def instead(self, scene: Scene, window: Window) -> str:
        """See `Condition.instead`."""
        return "the processor was not reset"


@dataclass(frozen=True)
class FileCondition(StateCondition):
    """A file of the mission, with a size in bytes if that matters."""

    path: str
    sign: str = ">="
    size: int = 0

    def holds(self, scene: Scene, window: Window) -> bool:
        """See `Condition.holds`."""
        node = self._node(scene)
        return node is not None and OPERATORS[self.sign](len(node.data), self.size)

    def instead(self, scene: Scene, window: Window) -> str:
        """See `Condition.instead`."""
        node = self._node(scene)
        if node is not None:
            return f"it has {len(node.data)} bytes"
        folder = self.path.rpartition("/")[0] or "/"
        try:
            names: Sequence[str] = scene.mission.files.list_dir(folder)
        except OsalError:
            return f"there is no folder {folder}"
        return f"{folder} has {', '.join(names) or 'no files'}"

    def _node(self, scene: Scene) -> Node | None:
        try:
            return scene.mission.files.find(self.path)
        except OsalError:
            return None


@dataclass(frozen=True)
class ConsoleCondition(StateCondition):
    """A line of the console that contains a text."""

    lasts = False

    text: str

    def holds(self, scene: Scene, window: Window) -> bool:
        """See `Condition.holds`."""
        return any(self.text in line for line in scene.mission.console.lines[window.lines :])

    def instead(self, scene: Scene, window: Window) -> str:
        """See `Condition.instead`."""
        lines = scene.mission.console.lines[window.lines :]
        found = [line for line in lines if self.text in line]
        if found:
            return f'there was "{found[0]}"'
        return f'the last line was "{lines[-1]}"' if lines else "there was no line"

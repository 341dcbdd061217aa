"""What a page about a run shows besides its numbers: what happened when, how long messages took, events, the console.

A long run is summed up while it goes on, so the memory that this takes does not grow with it.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from cfepy.evs import ERROR
from cfepy.extra.reports.bins import Bins, Histogram
from cfepy.extra.reports.noteworthy import event_in, mark_of
from cfepy.ground import DecodedEvent, LiveNames, MissionGraph, graph_of
from cfepy.monitors import Observer, Sent, app_of
from cfepy.pilot.determinism_look import place_text
from cfepy.rtos import HOLD, AskingPolicy, Decision, Moment, Policy, Task
from cfepy.sb import Pipe
from cfepy.schedules import Move, MoveNumbers

MOST = 2_000
"""Events and lines that are kept of each; the others are only counted."""

SWITCH = "switch"
MOST_OF_A_KIND = 500  # marks, so that many of one kind leave room for the others


class ConsoleLine(NamedTuple):
    """A line of the console, and its virtual time in ns."""

    at_ns: int
    text: str


class PageMark(NamedTuple):
    """Something that stands out: a "reset", "note", "switch", or what `mark_of` knows, at a virtual time in ns."""

    at_ns: int
    kind: str
    text: str


class DropPlace(NamedTuple):
    """Where messages were lost: MsgId, name of the pipe, why."""

    msg_id: int
    pipe: str
    why: str


@dataclass(slots=True)
class AppActivity:
    """An application: how often its tasks got the processor, and the ns that they used it."""

    runs: Bins = field(default_factory=Bins)
    busy: Bins = field(default_factory=Bins)


@dataclass(slots=True)
class TopicActivity:
    """A MsgId: when and by which applications it was sent, and how long each receiver waited for it."""

    senders: set[str] = field(default_factory=set)
    sent: Bins = field(default_factory=Bins)
    latency: Histogram = field(default_factory=Histogram)


class Collector(Observer):
    """Collects; what the attributes hold is complete when the run is over.

    Attributes:
        apps: by name, in order of appearance.
        topics: by MsgId, likewise.
        drops: how many messages were lost where.
        events, lines: the first `MOST` of each; `event_count` and `line_count` count all.
        marks: the first `MOST_OF_A_KIND` of each kind; `mark_counts` counts all, by kind.
        first_errors: when an application sent its first ERROR or CRITICAL event.
        memory: bytes that are booked by (owner, purpose).
        graph: who sends what to whom; as it was then, and so is `memory`.
        end_ns: when the time of the run was over.
        names: of MsgIds.
    """

    def __init__(self) -> None:
        super().__init__()
        self.apps: dict[str, AppActivity] = {}
        self.topics: dict[int, TopicActivity] = {}
        self.drops: dict[DropPlace, int] = {}
        self.events: list[DecodedEvent] = []
        self.lines: list[ConsoleLine] = []
        self.marks: list[PageMark] = []
        self.event_count = self.line_count = 0
        self.mark_counts: dict[str, int] = {}
        self.first_errors: dict[str, int] = {}
        self.memory: dict[tuple[str, str], int] = {}
        self.graph: MissionGraph
        self.end_ns = 0
        self.names: LiveNames
        self._since_ns = 0

    def begin(self, mission: Any) -> None:
        super().begin(mission)
        self.names = LiveNames(mission)

    def power_up(self, processor: Any) -> None:
        super().power_up(processor)
        resets = self.mission.record.resets
        if resets:
            self._mark("reset", resets[-1].reason, resets[-1].at_ns)

    def conclude(self) -> None:
        """Take down what the end of the tasks would change."""
        self.end_ns = self._kernel.now
        self.memory = self.mission.memory.totals()
        self.graph = graph_of(self.mission, {msg_id: topic.senders for msg_id, topic in self.topics.items()})

    def on_run(self, task: Task, at_ns: int) -> None:
        self._app(task).runs.add(at_ns)
        self._since_ns = at_ns

    def on_leave(self, task: Task, at_ns: int, waits: bool) -> None:
        if at_ns > self._since_ns:
            self._app(task).busy.add_span(self._since_ns, at_ns)

    def _app(self, task: Task) -> AppActivity:
        name = app_of(task)
        app = self.apps.get(name)
        if app is None:
            app = self.apps[name] = AppActivity()
        return app

    def on_send(self, sent: Sent, packet: bytes | bytearray) -> None:
        topic = self._topic(sent.msg_id)
        topic.sent.add(sent.at_ns)
        topic.senders.add(app_of(sent.task))
        event = event_in(sent.msg_id, packet, sent.at_ns)
        if event is not None:
            self.event_count += 1
            if event.event_type >= ERROR:
                self.first_errors.setdefault(event.app, sent.at_ns)
            _keep(self.events, event)

    def on_receive(self, sent: Sent | None, pipe: Pipe, task: Task, at_ns: int) -> None:
        if sent is not None:
            self._topic(sent.msg_id).latency.add(at_ns - sent.at_ns)

    def _topic(self, msg_id: int) -> TopicActivity:
        topic = self.topics.get(msg_id)
        if topic is None:
            topic = self.topics[msg_id] = TopicActivity()
        return topic

    def on_drop(self, msg_id: int, pipe: Pipe, why: str, at_ns: int) -> None:
        drop = DropPlace(msg_id, pipe.name, why)
        self.drops[drop] = self.drops.get(drop, 0) + 1

    def on_console(self, line: str, at_ns: int) -> None:
        self.line_count += 1
        _keep(self.lines, ConsoleLine(at_ns, line))
        mark = mark_of(line)
        if mark is not None:
            self._mark(*mark, at_ns)

    def on_note(self, text: str, at_ns: int) -> None:
        self._mark(*(mark_of(text) or ("note", text)), at_ns)

    def policy(self, inner: Policy) -> Policy:
        """A policy that decides as another does, and lets each decision that is not fifo's be marked as a switch."""
        return _SwitchNotes(inner, lambda *switch: self._mark(SWITCH, _switch_text(*switch), switch[0].now))

    def _mark(self, kind: str, text: str, at_ns: int) -> None:
        self.mark_counts[kind] = count = self.mark_counts.get(kind, 0) + 1
        if count <= MOST_OF_A_KIND:
            self.marks.append(PageMark(at_ns, kind, text))

    # -- for the timeline --------------------------------------------------------------------------------------------

    def width_ns(self) -> int:
        """The width of a bin that suits all of them."""
        all_bins = [bins for app in self.apps.values() for bins in (app.runs, app.busy)]
        all_bins += [topic.sent for topic in self.topics.values()]
        return max((bins.width_ns for bins in all_bins), default=1)


class _SwitchNotes(AskingPolicy):
    """Asks another policy, and tells of what is not fifo's answer, with the line that was about to go on."""

    def __init__(self, inner: Policy, note: Callable[[Moment, Move, str], None]) -> None:
        super().__init__(inner)
        self._note = note
        self._numbers = MoveNumbers()

    def choose(self, decision: Decision) -> int:
        """A policy is asked in the task that gives the processor away, so its stack is there."""
        choice = self._inner.choose(decision)
        moves = self._numbers.moves(decision)
        if choice:
            place = place_text(sys._getframe(1)) if decision.running else ""
            self._note(Moment.of(decision, choice), moves[choice - 1], place)
        return choice


def _switch_text(moment: Moment, move: Move, place: str) -> str:
    at = f" at {place}" if place else ""
    number = f"(move {move.text()})"
    if moment.question:
        return f"{moment.instead_of}: {moment.chosen} {number}"
    if moment.chosen == HOLD:
        return f"{moment.instead_of} is held up{at} {number}"
    if moment.preemption:
        return f"{moment.instead_of} is preempted by {moment.chosen}{at} {number}"
    return f"{moment.chosen} goes before {moment.instead_of} {number}"


def _keep(kept: list[Any], thing: Any) -> None:
    if len(kept) < MOST:
        kept.append(thing)

"""The data of a page about a run besides its numbers: activity over time, latencies, events, the console.

The data of a long run is summed up while it goes on, so its memory does not grow with the run.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from cfepy.evs import ERROR
from cfepy.extra.reports.bins import Bins, ExactActivity, ExactWindow, Histogram
from cfepy.extra.reports.noteworthy import event_in, is_end_of_app, mark_of
from cfepy.ground import DecodedEvent, LiveNames, MissionGraph, graph_of
from cfepy.monitors import Observer, Sent, app_of
from cfepy.pilot.determinism_look import place_text
from cfepy.rtos import HOLD, AskingPolicy, Decision, Moment, Policy, Task
from cfepy.sb import Pipe
from cfepy.schedules import Move, MoveNumbers

MOST = 2_000
"""Maximum number of events and of lines that are kept; further ones are only counted."""

SWITCH = "switch"
MOST_OF_A_KIND = 500  # marks of one kind, so that one kind leaves room for the others


class ConsoleLine(NamedTuple):
    """A line of the console, and its virtual time in ns."""

    at_ns: int
    text: str


class PageMark(NamedTuple):
    """A remarkable event: a "reset", "note", "switch", or a kind of `mark_of`, at a virtual time in ns."""

    at_ns: int
    kind: str
    text: str


class DropPlace(NamedTuple):
    """A place of message loss: MsgId, name of the pipe, reason."""

    msg_id: int
    pipe: str
    why: str


@dataclass(slots=True)
class AppActivity:
    """The activity of an application: how often its tasks got the processor, and the ns that they used it."""

    runs: Bins = field(default_factory=Bins)
    busy: Bins = field(default_factory=Bins)


@dataclass(slots=True)
class TopicActivity:
    """The activity of a MsgId: when and by which applications it was sent, and how long each receiver waited for it."""

    senders: set[str] = field(default_factory=set)
    sent: Bins = field(default_factory=Bins)
    latency: Histogram = field(default_factory=Histogram)


class Collector(Observer):
    """Collects the data; the attributes are complete when the run is over.

    Attributes:
        apps: activity by application, in order of appearance.
        topics: activity by MsgId, in order of appearance.
        exact: exact times around marks and ERROR events, and at the end of the run.
        drops: number of lost messages by place.
        events: the first `MOST` events.
        event_count: number of all events.
        lines: the first `MOST` lines.
        line_count: number of all lines.
        marks: the first `MOST_OF_A_KIND` of each kind.
        mark_counts: number of all marks, by kind.
        first_errors: time of the first ERROR or CRITICAL event of each application.
        memory: bytes that are booked by (owner, purpose), at the end of the run.
        graph: senders, messages and receivers, at the end of the run.
        end_ns: time of the end of the run.
        names: names of MsgIds.
    """

    def __init__(self) -> None:
        super().__init__()
        self.apps: dict[str, AppActivity] = {}
        self.topics: dict[int, TopicActivity] = {}
        self.exact = ExactActivity()
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
        """Record the data that the end of the tasks would change."""
        self.end_ns = self._kernel.now
        self.exact.conclude(self.end_ns)
        self.memory = self.mission.memory.totals()
        self.graph = graph_of(self.mission, {msg_id: topic.senders for msg_id, topic in self.topics.items()})

    def on_run(self, task: Task, at_ns: int) -> None:
        self._app(task).runs.add(at_ns)
        self._since_ns = at_ns

    def on_leave(self, task: Task, at_ns: int, waits: bool) -> None:
        if at_ns > self._since_ns:
            self._app(task).busy.add_span(self._since_ns, at_ns)
        self.exact.add(app_of(task), self._since_ns, at_ns)

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
        self.exact.add(sent.msg_id, sent.at_ns, sent.at_ns)
        event = event_in(sent.msg_id, packet, sent.at_ns)
        if event is not None:
            self.event_count += 1
            if event.event_type >= ERROR:
                self.first_errors.setdefault(event.app, sent.at_ns)
                self.exact.keep()
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
        elif is_end_of_app(line):
            self.exact.keep()

    def on_note(self, text: str, at_ns: int) -> None:
        self._mark(*(mark_of(text) or ("note", text)), at_ns)

    def policy(self, inner: Policy) -> Policy:
        """Wrap a policy: it decides as `inner` does, and each decision that deviates from fifo is marked as a
        switch.
        """
        return _SwitchNotes(inner, lambda *switch: self._mark(SWITCH, _switch_text(*switch), switch[0].now))

    def _mark(self, kind: str, text: str, at_ns: int) -> None:
        self.exact.keep()
        self.mark_counts[kind] = count = self.mark_counts.get(kind, 0) + 1
        if count <= MOST_OF_A_KIND:
            self.marks.append(PageMark(at_ns, kind, text))

    # -- for the timeline --------------------------------------------------------------------------------------------

    def width_ns(self) -> int:
        """Return the width of a bin that suits all activities."""
        all_bins = [bins for app in self.apps.values() for bins in (app.runs, app.busy)]
        all_bins += [topic.sent for topic in self.topics.values()]
        return max((bins.width_ns for bins in all_bins), default=1)


def timeline_data(collector: Collector) -> dict[str, Any]:
    """Return the data of the timeline: lanes of counts by time, run-length coded, and instants. Times in ns."""
    width_ns = collector.width_ns()
    lanes: list[dict[str, Any]] = []
    for name, app in collector.apps.items():
        lane = {"name": name, "kind": "app", "runs": app.runs.runs(width_ns), "busy": app.busy.runs(width_ns)}
        lanes.append(lane)
    sent = sorted(collector.topics, key=lambda msg_id: collector.names[msg_id])
    for msg_id in sent:
        runs = collector.topics[msg_id].sent.runs(width_ns)
        lanes.append({"name": collector.names[msg_id], "kind": "topic", "runs": runs, "busy": []})
    marks = [[mark.at_ns, mark.kind, mark.text] for mark in collector.marks]
    numbers: dict[str | int, int] = {name: number for number, name in enumerate(collector.apps)}
    numbers |= {msg_id: len(collector.apps) + number for number, msg_id in enumerate(sent)}
    exact = [_exact(window, numbers) for window in collector.exact.windows]
    return {"end": collector.end_ns, "width": width_ns, "lanes": lanes, "marks": marks, "exact": exact}


def _exact(window: ExactWindow, lanes: Mapping[str | int, int]) -> dict[str, Any]:
    """Return a window of exact activities as plain data: lane, distance of the begin from the last one, length, ..."""
    found: list[int] = []
    before = window.from_ns
    for each in window.activities:
        if each.lane in lanes:
            found += [lanes[each.lane], each.begin_ns - before, each.end_ns - each.begin_ns]
            before = each.begin_ns
    return {"from": window.from_ns, "to": window.to_ns, "activities": found}


class _SwitchNotes(AskingPolicy):
    """Asks another policy, and reports deviations from fifo, with the line that was about to run."""

    def __init__(self, inner: Policy, note: Callable[[Moment, Move, str], None]) -> None:
        super().__init__(inner)
        self._note = note
        self._numbers = MoveNumbers()

    def choose(self, decision: Decision) -> int:
        """Make a decision. A policy is called in the task that gives up the processor, so its stack is available."""
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
        return f"{moment.instead_of} is delayed{at} {number}"
    if moment.preemption:
        return f"{moment.instead_of} is preempted by {moment.chosen}{at} {number}"
    return f"{moment.chosen} runs before {moment.instead_of} {number}"


def _keep(kept: list[Any], thing: Any) -> None:
    if len(kept) < MOST:
        kept.append(thing)

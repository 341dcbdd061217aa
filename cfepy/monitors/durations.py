"""Durations whose maximum in a run is measured: responses, latencies of messages, waits for the processor.

    latency:/scan           from the sending of a message until a receiver has it
    latency:/scan->/cmd     from a message on /scan to the next one on /cmd
    response:ARM            of a task of an application: from the end of a wait to the start of the next one
    age:/scan               from a message to the next one, or to the end of the run
    wait:ARM                of a task: how long it is ready and others run

`latency`, `response` and `age` are measured like the deadlines `latency`, `response` and `at_least_every` of a mission
file are, which docs/reference/mission_file.md describes, and like them while the mission is OPERATIONAL.
"""

from __future__ import annotations

from collections.abc import Callable
from fnmatch import fnmatchcase
from typing import NamedTuple

from cfepy.mission import Mission, Processor
from cfepy.monitors.deadline_monitor import DeadlineMonitor
from cfepy.monitors.deadlines import LONGEST_NS, AppDeadline, Check, Deadlines, TopicDeadline
from cfepy.monitors.record import DeadlineRecord
from cfepy.reading.suggestions import did_you_mean
from cfepy.rtos import Task
from cfepy.status import UsageError

LATENCY, RESPONSE, AGE, WAIT = KINDS = ("latency", "response", "age", "wait")
FORMS = "latency:/topic, latency:/cause->/effect, response:APP, age:/topic or wait:TASK"
_ARROW = "->"


class Measure(NamedTuple):
    """A duration to measure.

    Attributes:
        kind: one of `KINDS`.
        name: a topic, a packet's name or a MsgId (`0x0883`); an application; a task, also as a pattern.
        effect: for a latency between two messages, the second one; empty for the latency of one message.
    """

    kind: str
    name: str
    effect: str = ""

    @classmethod
    def parse(cls, text: str) -> Measure:
        """Return the measure of a text.

        Raises:
            UsageError: if the text is not a measure.
        """
        kind, _, name = text.partition(":")
        name, arrow, effect = name.partition(_ARROW)
        if kind not in KINDS:
            hint = did_you_mean(kind, KINDS, f"expected {FORMS}")
            raise UsageError(f"unknown measure {text!r}; {hint}", field="--worst")
        if not name or (arrow and (kind != LATENCY or not effect)):
            raise UsageError(f"invalid measure {text!r}; expected {FORMS}", field="--worst")
        return cls(kind, name, effect)

    @property
    def text(self) -> str:
        """Return the text from which `parse` makes this."""
        return f"{self.kind}:{self.name}{_ARROW if self.effect else ''}{self.effect}"

    def deadlines(self) -> Deadlines:
        """Return deadlines without limits, with the measurement of this duration."""
        if self.kind == RESPONSE:
            return Deadlines(apps=(AppDeadline(self.name, response_ns=LONGEST_NS),))
        if self.kind == WAIT:
            return Deadlines()
        if self.effect:
            return Deadlines(topics=tuple(TopicDeadline(each, None, LONGEST_NS) for each in (self.name, self.effect)))
        latency_ns, longest_ns = (LONGEST_NS, None) if self.kind == LATENCY else (None, LONGEST_NS)
        return Deadlines(topics=(TopicDeadline(self.name, latency_ns, longest_ns),))


class Longest(NamedTuple):
    """The longest measured duration, in virtual ns; its end, place and the task."""

    time_ns: int
    at_ns: int
    where: str
    task: str


class LongestWatch(DeadlineMonitor):
    """Measures one duration in a run.

    Args:
        measure: the duration.
        on_longest: called whenever a new maximum was measured.

    Attributes:
        longest: maximum so far; None without measurement.
    """

    def __init__(self, measure: Measure, on_longest: Callable[[], object] = lambda: None) -> None:
        super().__init__(measure.deadlines())
        self.longest: Longest | None = None
        self._measure_of = measure
        self._on_longest = on_longest
        self._causes: list[int] = []  # times of messages that have had no effect yet
        self._ready: dict[Task, int] = {}  # tasks that are ready, and since when
        self._due: dict[Task, int | None] = {}  # time limits of the tasks' waits

    def begin(self, mission: Mission) -> None:
        """Leave the mission's own deadlines in its record."""
        kept = mission.record.part(DeadlineRecord).checks
        super().begin(mission)
        mission.record.part(DeadlineRecord).checks = kept

    def power_up(self, processor: Processor) -> None:
        super().power_up(processor)
        self._causes.clear()
        self._ready.clear()
        self._due.clear()

    def conclude(self) -> None:
        """Measure unfinished durations until now."""
        now_ns = self._kernel.now
        if self._measures:
            for _, state in self._topics:
                if state.last_ns is not None and self._measure_of.kind == AGE:
                    self._saw(now_ns - state.last_ns, now_ns, "until the end of the run", "")
            for task in list(self._ready):
                self._saw_ready(task, now_ns)
        super().conclude()

    # -- deadlines as durations ----------------------------------------------------------------------------------------

    def _measure(self, check: Check, measured_ns: int, at_ns: int, where: str) -> None:
        self._saw(measured_ns, at_ns, where, self._kernel.current.name)

    def _saw(self, time_ns: int, at_ns: int, where: str, task: str) -> None:
        if self.longest is None or time_ns > self.longest.time_ns:
            self.longest = Longest(time_ns, at_ns, where, task)
            self._on_longest()

    # -- from cause to effect ------------------------------------------------------------------------------------------

    def _comes(self, msg_id: int, at_ns: int) -> None:
        """A message was sent; see `DeadlineMonitor`."""
        if not self._measure_of.effect:
            super()._comes(msg_id, at_ns)
            return
        cause, effect = (state for _, state in self._topics)
        found = self._states_of(msg_id)
        if effect in found and self._causes:
            self._saw(at_ns - self._causes[0], at_ns, f"until {self._measure_of.effect}", self._kernel.current.name)
            self._causes.clear()
        if cause in found:
            self._causes.append(at_ns)

    # -- ready tasks ---------------------------------------------------------------------------------------------------

    def _means(self, task: Task) -> bool:
        return self._measure_of.kind == WAIT and fnmatchcase(task.name, self._measure_of.name)

    def on_ready(self, task: Task, at_ns: int) -> None:
        super().on_ready(task, at_ns)
        if self._means(task):
            self._ready[task] = at_ns

    def on_leave(self, task: Task, at_ns: int, waits: bool) -> None:
        """The task starts to wait, or is ready."""
        super().on_leave(task, at_ns, waits)
        if not self._means(task):
            return
        if not waits:
            self._ready[task] = at_ns
        self._due[task] = self._timer_of(task) if waits else None

    def on_run(self, task: Task, at_ns: int) -> None:
        """The task runs; if no call ended its wait, its timer did."""
        super().on_run(task, at_ns)
        if not self._means(task):
            return
        due = self._due.pop(task, None)
        if due is not None and task not in self._ready:
            self._ready[task] = min(due, at_ns)
        self._saw_ready(task, at_ns)

    def _saw_ready(self, task: Task, at_ns: int) -> None:
        since = self._ready.pop(task, None)
        if since is not None and self._measures_from(since):
            self._saw(at_ns - since, at_ns, f"until {task.name} ran", task.name)

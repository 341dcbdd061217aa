"""The monitor of a mission file's deadlines: it measures each, and writes a line for each overrun."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from cfepy.ground import LiveNames
from cfepy.mission import Mission, Processor, hearing
from cfepy.monitors.deadlines import AppDeadline, Check, Deadlines, Overrun, TopicDeadline, limits_of
from cfepy.monitors.observer import Observer, Sent
from cfepy.monitors.record import DeadlineRecord
from cfepy.rtos import Task
from cfepy.sb import Pipe, SoftwareBus
from cfepy.units import NS_PER_S, time_text

SHOWN = 10  # maximum number of overruns of one deadline on the console; all are in the trace
KEPT = 1000  # maximum number of overruns of one deadline that are kept for tools, the first ones
FIRST_SEGMENT = 0x40  # of the sequence flags in byte 2: start of a message, whole or in segments
BETWEEN_MESSAGES = ("at_least_every", "at_most_every")
PREFIX = "DEADLINE "
"""Start of the line for an overrun."""


@dataclass(slots=True)
class TopicState:
    """Checks of a topic by kind, the time of its last message, and whether the next one is already late."""

    checks: dict[str, Check]
    last_ns: int | None = None
    is_late: bool = False

    def due_ns(self, booted_ns: int) -> int | None:
        """Return the latest time at which the next message is in time; None if there is none, or it has passed."""
        check = self.checks.get("at_least_every")
        if check is None or self.is_late:
            return None
        return (booted_ns if self.last_ns is None else self.last_ns) + check.limit_ns


@dataclass(slots=True)
class TaskState:
    """A task with deadlines: `waits` is whether it waits, `due_ns` its time limit, `woken_ns` when the last
    wait ended.
    """

    checks: list[Check] = field(default_factory=list)
    waits: bool = False
    due_ns: int | None = None
    woken_ns: int | None = None
    before_ns: int | None = None  # end of the previous wait


class DeadlineMonitor(Observer):
    """Measures deadlines while the mission is OPERATIONAL, until the end of the run.

    A time that began earlier is not measured, such as the latency of a message from before.
    The mission's record gets the checks, and the first overruns of each.

    Args:
        deadlines: the deadlines.
    """

    def __init__(self, deadlines: Deadlines) -> None:
        super().__init__()
        self._apps = [(each, self._checks(each.app, each)) for each in deadlines.apps]
        self._topics = [(each, TopicState(self._checks(each.name, each))) for each in deadlines.topics]
        self._tasks: dict[Task, TaskState | None] = {}
        self._by_msg_id: dict[int, list[TopicState]] = {}
        self._names: LiveNames
        self._next_due: int | None = None
        self._is_over = False
        self._processor: Processor

    @staticmethod
    def _checks(owner: str, deadline: AppDeadline | TopicDeadline) -> dict[str, Check]:
        jitter = deadline.jitter_ns if isinstance(deadline, AppDeadline) else 0
        found = {}
        for kind, limit_ns in limits_of(deadline).items():
            found[kind] = Check(owner, kind, limit_ns, jitter if kind == "period" else 0)
        return found

    def bus(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
        """Return a bus that reports messages without subscribers too: they are never sent, but count here."""
        base = super().bus(base)
        is_paced = any(state.checks.keys() & set(BETWEEN_MESSAGES) for _, state in self._topics)
        return hearing(base, self._take_unheard) if is_paced else base

    def begin(self, mission: Mission) -> None:
        super().begin(mission)
        self._names = LiveNames(mission)
        mission.record.part(DeadlineRecord).checks = list(self._all())

    def power_up(self, processor: Processor) -> None:
        """After a reset, start all checks again when the mission is OPERATIONAL again."""
        super().power_up(processor)
        self._processor = processor
        self._tasks.clear()
        self._by_msg_id.clear()
        self._next_due = None
        for _, state in self._topics:
            state.last_ns, state.is_late = None, False

    def conclude(self) -> None:
        """Record messages that are late now, and stop measuring."""
        self._find_late(self._kernel.now)
        self._is_over = True

    def _all(self) -> Iterator[Check]:
        for _, checks in self._apps:
            yield from checks.values()
        for _, state in self._topics:
            yield from state.checks.values()

    @property
    def _measures(self) -> bool:
        return self._measures_from(self._kernel.now)

    def _measures_from(self, begin_ns: int) -> bool:
        """Return whether a time that began then is measured: the mission was OPERATIONAL, and the run is not over."""
        booted = self._processor.booted
        return booted is not None and booted <= begin_ns and not self._is_over

    # -- applications ------------------------------------------------------------------------------------------------

    def on_leave(self, task: Task, at_ns: int, waits: bool) -> None:
        """A wait starts and a response ends; waiting for a mutex is part of the work."""
        state = self._state_of(task)
        if state is None or not waits or task.mutex is not None:
            return
        began, state.woken_ns = state.woken_ns, None
        state.waits, state.due_ns = True, self._timer_of(task)
        if began is None or not self._measures_from(began):
            return
        for check in state.checks:
            if check.kind == "response":
                self._measure(check, at_ns - began, at_ns, f"in task {task.name}")

    def on_ready(self, task: Task, at_ns: int) -> None:
        """The wait of a task is over."""
        state = self._state_of(task)
        if state is not None and state.waits:
            self._wakes(state, task, at_ns, at_ns)

    def on_run(self, task: Task, at_ns: int) -> None:
        """A task runs; if no call ended its wait, its timer did so when it was due."""
        self._find_late(at_ns)
        state = self._state_of(task)
        if state is not None and state.waits:
            self._wakes(state, task, at_ns if state.due_ns is None else min(state.due_ns, at_ns), at_ns)

    def _wakes(self, state: TaskState, task: Task, woken_ns: int, at_ns: int) -> None:
        state.waits, state.woken_ns = False, woken_ns
        before, state.before_ns = state.before_ns, woken_ns
        if before is None or not self._measures_from(before):
            return
        for check in state.checks:
            if check.kind == "period" and self._is_paced(task, check.owner):
                self._measure(check, woken_ns - before, at_ns, f"in task {task.name}")

    def _is_paced(self, task: Task, app: str) -> bool:
        named = next(each.task for each, _ in self._apps if each.app == app)
        return named is not None or task.number == task.owner.main_task_id

    def _timer_of(self, task: Task) -> int | None:
        """Return the time limit of a task's wait."""
        timers = self._kernel.timers
        return next((when for when, sequence, each in timers if each is task and sequence == task.timer), None)

    def _state_of(self, task: Task) -> TaskState | None:
        if task in self._tasks:
            return self._tasks[task]
        name = None if task.owner is None else task.owner.name
        checks: list[Check] = []
        for deadline, each in self._apps:
            if deadline.app == name and deadline.task in (None, task.name):
                checks += each.values()
        state = self._tasks[task] = TaskState(checks) if checks else None
        return state

    # -- topics ------------------------------------------------------------------------------------------------------

    def on_send(self, sent: Sent, packet: bytes | bytearray) -> None:
        """A message starts."""
        self._find_late(sent.at_ns)
        if self._measures and packet[2] & FIRST_SEGMENT:
            self._comes(sent.msg_id, sent.at_ns)

    def _take_unheard(self, link: Any, message: bytes) -> None:
        now_ns = self._kernel.now
        self._find_late(now_ns)
        if self._measures:
            self._comes(link.msg_id, now_ns)

    def _comes(self, msg_id: int, at_ns: int) -> None:
        """Check the interval since the previous message."""
        for state in self._states_of(msg_id):
            before, was_late = state.last_ns, state.is_late
            state.last_ns, state.is_late, self._next_due = at_ns, False, None
            if before is None:
                continue
            for kind in BETWEEN_MESSAGES:
                check = state.checks.get(kind)
                if check is not None and was_late and kind == "at_least_every":
                    check.saw(at_ns - before)  # it was reported when it was due
                elif check is not None:
                    self._measure(check, at_ns - before, at_ns, "from one message to the next")

    def on_receive(self, sent: Sent | None, pipe: Pipe, task: Task, at_ns: int) -> None:
        """A message arrives."""
        if sent is None or not self._measures_from(sent.at_ns):
            return
        for state in self._states_of(sent.msg_id):
            check = state.checks.get("latency")
            if check is not None:
                self._measure(check, at_ns - sent.at_ns, at_ns, f"on its way to task {task.name}")

    def _states_of(self, msg_id: int) -> list[TopicState]:
        found = self._by_msg_id.get(msg_id)
        if found is None:
            name = self._names[msg_id]
            found = [state for each, state in self._topics if each.name == name or each.msg_id == msg_id]
            self._by_msg_id[msg_id] = found
        return found

    def _find_late(self, now_ns: int) -> None:
        """Report messages that are overdue, at the first event after their limit."""
        if not self._topics or self._is_over or (self._next_due is not None and now_ns <= self._next_due):
            return
        booted = self._processor.booted
        if booted is None:
            return
        for _, state in self._topics:
            due = state.due_ns(booted)
            if due is not None and now_ns > due:
                state.is_late = True
                check = state.checks["at_least_every"]
                since = now_ns - (due - check.limit_ns)
                self._measure(check, since, now_ns, "and no message")
        left = [due for _, state in self._topics if (due := state.due_ns(booted)) is not None]
        self._next_due = min(left, default=1 << 62)

    # -- overruns ------------------------------------------------------------------------------------------------------

    def _measure(self, check: Check, measured_ns: int, at_ns: int, where: str) -> None:
        if check.measure(measured_ns):
            return
        check.overruns += 1
        if check.first_at_ns is None:
            check.first_at_ns = at_ns
        limit = time_text(check.limit_ns)
        if check.kind == "period":
            limit += f" +- {time_text(check.jitter_ns)}"
        text = f"{check.owner} {check.kind} {limit}: {time_text(measured_ns)} {where}"
        if check.overruns <= KEPT:
            self.mission.record.part(DeadlineRecord).overruns.append(Overrun(at_ns, check.owner, check.kind, text))
        self._tell(check, f"{PREFIX}{at_ns / NS_PER_S:.6f} {text}")

    def _tell(self, check: Check, line: str) -> None:
        """Write a line to the console, or only to the trace if there were many already."""
        if check.overruns > SHOWN:
            self.mission.trace.note(line)
        else:
            self.mission.console.write(line + (" (later ones are in the trace)" if check.overruns == SHOWN else ""))

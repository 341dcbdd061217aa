"""Liveness: ready tasks that do not run, and applications that run without progress.

A task *starves* if it is ready for longer than a limit while others have the processor. An application is in a
*livelock* if its tasks run repeatedly for longer than a limit, and none of them sends or takes a message. Both limits
are in virtual time, counted once the mission is OPERATIONAL. A task that runs without advancing virtual time is
reported by the stall watch.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from cfepy.mission import CORE_APPS, Processor
from cfepy.monitors.observer import Observer, Sent
from cfepy.rtos import Task
from cfepy.sb import Pipe
from cfepy.units import instant_text, time_text

RUNS = 100  # minimum number of runs of an application's tasks without a message that counts as a livelock


class Limits(NamedTuple):
    """Limits for ready tasks and for applications that run without a message, in ns; 0 for no limit."""

    starved_ns: int = 0
    livelock_ns: int = 0


class Lack(NamedTuple):
    """A task that starved, or an application in a livelock; `at_ns` is when the limit was reached."""

    is_livelock: bool
    app: str
    task: str
    at_ns: int
    text: str


@dataclass(slots=True)
class _Quiet:
    """An application since its last message: the time, and the number of runs of its tasks."""

    since_ns: int
    runs: int = 0


class LivenessWatch(Observer):
    """Looks for starving tasks and livelocks in a run.

    Args:
        limits: the limits.

    Attributes:
        found: the first finding of each task and each application.
    """

    def __init__(self, limits: Limits) -> None:
        super().__init__()
        self.found: list[Lack] = []
        self._limits = limits
        self._ready: dict[Task, int] = {}
        self._due: dict[Task, int] = {}  # tasks that wait with a time limit, and when it expires
        self._quiet: dict[str, _Quiet] = {}
        self._told: set[tuple[bool, str]] = set()
        self._before: Task | None = None  # the last task that ran
        self._processor: Processor

    def power_up(self, processor: Processor) -> None:
        """After a reset, drop all ready tasks."""
        super().power_up(processor)
        self._processor = processor
        self._ready.clear()
        self._due.clear()
        self._quiet.clear()

    def conclude(self) -> None:
        """Report tasks that are still ready and over the limit."""
        now_ns = self._kernel.now
        for task, due_ns in self._due.items():
            if due_ns < now_ns and not task.timer:
                self._ready.setdefault(task, due_ns)
        for task in list(self._ready):
            self._runs(task, now_ns)

    # -- starvation ----------------------------------------------------------------------------------------------------

    def on_ready(self, task: Task, at_ns: int) -> None:
        if _is_own(task):
            self._ready[task] = at_ns

    def on_leave(self, task: Task, at_ns: int, waits: bool) -> None:
        self._before = task
        if not _is_own(task):
            return
        if not waits:
            self._ready[task] = at_ns
        elif task.timer:
            timers = self._kernel.timers
            self._due[task] = next(when for when, number, each in timers if each is task and number == task.timer)

    def on_run(self, task: Task, at_ns: int) -> None:
        if not _is_own(task):
            return
        due_ns = self._due.pop(task, None)
        if due_ns is not None:
            self._ready.setdefault(task, min(due_ns, at_ns))
        self._runs(task, at_ns)
        if self._limits.livelock_ns:
            self._goes_on(task, at_ns)

    def _runs(self, task: Task, at_ns: int) -> None:
        since_ns, booted = self._ready.pop(task, None), self._processor.booted
        limit_ns = self._limits.starved_ns
        if since_ns is None or booted is None or not limit_ns or at_ns - max(since_ns, booted) <= limit_ns:
            return
        since_ns = max(since_ns, booted)
        other = "" if self._before in (None, task) else f"; {_told(self._before)} ran last"
        waited = f"ready for {time_text(at_ns - since_ns)} from {instant_text(since_ns)} on, and did not run"
        self._tell(Lack(False, task.owner.name, task.name, since_ns + limit_ns, f"{_told(task)} was {waited}{other}"))

    # -- livelocks ---------------------------------------------------------------------------------------------------

    def _goes_on(self, task: Task, at_ns: int) -> None:
        app, booted = task.owner.name, self._processor.booted
        if booted is None:
            return
        quiet = self._quiet.setdefault(app, _Quiet(booted))
        quiet.runs += 1
        if quiet.runs >= RUNS and at_ns - quiet.since_ns > self._limits.livelock_ns:
            text = f"ran {quiet.runs} times from {instant_text(quiet.since_ns)} on, and neither sent nor took a message"
            self._tell(Lack(True, app, task.name, at_ns, text))

    def on_send(self, sent: Sent, packet: bytes | bytearray) -> None:
        self._moves(sent.task, sent.at_ns)

    def on_receive(self, sent: Sent | None, pipe: Pipe, task: Task, at_ns: int) -> None:
        self._moves(task, at_ns)

    def _moves(self, task: Task, at_ns: int) -> None:
        if task.owner is not None:
            self._quiet[task.owner.name] = _Quiet(at_ns)

    def _tell(self, lack: Lack) -> None:
        key = lack.is_livelock, lack.app if lack.is_livelock else lack.task
        if key not in self._told:
            self._told.add(key)
            self.found.append(lack)


def _is_own(task: Task) -> bool:
    """Return whether an application belongs to the mission."""
    return task.owner is not None and task.owner.name not in CORE_APPS


def _told(task: Task | None) -> str:
    assert task is not None
    return f"{task.name} (priority {task.priority})"

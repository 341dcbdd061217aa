"""A run with an eye on a few tasks: where in its source each one was whenever another could have got in.

It looks on: the run is that of the schedule. May import everything to the left of cfepy.explore.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import PurePath
from types import FrameType
from typing import Any

from cfepy.attachment import Attachment
from cfepy.mission.determinism_look import Line, is_library, is_standard, stack_of
from cfepy.mission.dictionary import dictionary_of
from cfepy.mission.message_watch import Heard, MessageWatch
from cfepy.mission.mission import Mission
from cfepy.mission.processor import CORE_APPS
from cfepy.mission.spec import MissionSpec
from cfepy.mission.topics import plain
from cfepy.mission.values import line_of
from cfepy.rtos import Task
from cfepy.rtos.policy import HOLD, Decision, Policy
from cfepy.sb import SoftwareBus

AT, WAITS, SENDS, PREEMPTED, ORDERED = "at", "waits", "sends", "preempted", "ordered"


@dataclass(frozen=True, slots=True)
class Row:
    """Something that a task did.

    Attributes:
        at_ns: virtual time.
        task: its name.
        kind: AT a line of source, WAITS for something, SENDS a message, is PREEMPTED by `text`, or `text` is ORDERED
            before it.
        text: what.
    """

    at_ns: int
    task: str
    kind: str
    text: str


class TaskLook(Attachment):
    """Keeps what the tasks of a mission's applications do, up to a failure.

    Args:
        spec: the mission.
        first: from this decision on.
        is_over: whether the failure has been seen, and nothing is kept any more.

    Attributes:
        rows: in the order in which it happened.
    """

    def __init__(self, spec: MissionSpec, first: int = 0, is_over: Callable[[], bool] = lambda: False) -> None:
        self.rows: list[Row] = []
        self.is_on = first <= 0
        self._first = first
        self._is_over = is_over
        self._closed = False
        packets = dictionary_of(spec)
        names = (*packets.commands, *(name for name in packets.telemetry if not name.startswith("/")))
        self._messages = MessageWatch(spec, self._take_message, ("*",), names)
        self._mission: Mission | None = None

    def bus(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
        """See `Attachment.bus`."""
        return self._messages.bus(base)

    def begin(self, mission: Mission) -> None:
        """See `Attachment.begin`; every wait goes through the kernel's `block`, which is looked up anew each time."""
        self._mission = mission
        self._messages.begin(mission)
        mission.kernel.block = self._blocking(mission.kernel.block)  # type: ignore[method-assign]

    def policy(self, inner: Policy) -> Policy:
        """A policy that decides as another does, and looks at who is where when it is asked."""
        return _LookingPolicy(inner, self)

    def reached(self, decision: int) -> None:
        """So many decisions are behind."""
        self.is_on = self.is_on or decision >= self._first

    def add(self, task: str, kind: str, text: str) -> None:
        """Keep something, until the failure has been seen."""
        if self._goes_on():
            self._keep(task, kind, text)

    def look(self, frame: FrameType | None) -> None:
        """Keep where the running task is."""
        task = self._watched()
        if task is not None and self._goes_on():
            self._keep_place(task, frame)

    def _goes_on(self) -> bool:
        self._closed = self._closed or self._is_over()
        return not self._closed

    def _watched(self) -> Task | None:
        """The running task, if it is one of the mission's applications, and its deeds are kept by now."""
        if not self.is_on or self._mission is None:
            return None
        task = self._mission.kernel.current
        return None if task.owner is None or task.owner.name in CORE_APPS else task

    def _keep_place(self, task: Task, frame: FrameType | None) -> None:
        text = place_text(frame)
        if text:
            self._keep(task.name, AT, text)

    def _keep(self, task: str, kind: str, text: str) -> None:
        assert self._mission is not None
        row = Row(self._mission.kernel.now, task, kind, text)
        if not self.rows or (self.rows[-1].task, self.rows[-1].kind, self.rows[-1].text) != (task, kind, text):
            self.rows.append(row)

    def _blocking(self, block: Callable[[], Any]) -> Callable[[], Any]:
        def wait() -> Any:
            task = self._watched()
            if task is not None:
                self.look(sys._getframe(1))
                what = "sleeps" if task.waits is None else f"waits for {task.waits.what}"
                self.add(task.name, WAITS, what)
            return block()

        return wait

    def _take_message(self, heard: Heard) -> None:
        """The message may be the failure itself, so it is kept when that has just been seen."""
        task = self._watched()
        if task is None or self._closed:
            return
        try:
            values = plain(heard.msg)
        except Exception as error:  # the type of its messages is not known
            values = {"?": str(error)}
        self._keep_place(task, sys._getframe(1))
        self._keep(task.name, SENDS, f"sends {heard.topic}: {line_of(values) if isinstance(values, dict) else values}")


class _LookingPolicy(Policy):
    def __init__(self, inner: Policy, look: TaskLook) -> None:
        super().__init__(inner.any_priority, inner.hold_ns)
        self._inner = inner
        self._look = look

    def choose(self, decision: Decision) -> int:
        """See `Policy.choose`. It is asked in the task that gives the processor away."""
        choice = self._inner.choose(decision)
        self._look.reached(decision.number)
        self._look.look(sys._getframe(1))
        if choice:
            first = decision.tasks[0].name
            chosen = decision.tasks[choice].name if choice < len(decision.tasks) else HOLD
            self._look.add(first, PREEMPTED if decision.running else ORDERED, chosen)
        return choice


def place_text(frame: FrameType | None) -> str:
    """The innermost line of the mission's own code in a stack: `arm.py:12: self.count += 1`.

    In a thread that a library has for itself it is that library's, and where only Python's own code runs, empty.
    """
    shown: list[Line] = [line for line in stack_of(frame) if not is_standard(line.file)]
    lines = [line for line in shown if not is_library(line.file)] or shown
    if not lines:
        return ""
    source = " ".join(lines[-1].source.partition("  #")[0].split())
    return f"{PurePath(lines[-1].file).name}:{lines[-1].number}: {source}"

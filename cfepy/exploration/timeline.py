"""A failing run as a timeline: a column for each task that matters, from the first preemption to the failure.

The run is flown once more with a `TaskLook`, which notes where in its source each task was whenever another could have
got in; it changes nothing, so the run is that of the schedule. What it noted is drawn as plain text of 100 columns.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from textwrap import wrap
from types import FrameType
from typing import Any

from cfepy.attachment import Attachment
from cfepy.exploration.failures import FailureWatch
from cfepy.exploration.moves import Move
from cfepy.exploration.trial import Trial
from cfepy.exploration.verdict import INVARIANT, Failure, Verdict
from cfepy.ground import dictionary_of, line_of, plain
from cfepy.mission import CORE_APPS, Mission, MissionSpec
from cfepy.monitors import Heard, MessageWatch
from cfepy.pilot.determinism_look import place_text
from cfepy.rtos import HOLD, AskingPolicy, Decision, Policy, Task
from cfepy.sb import SoftwareBus
from cfepy.units import NS_PER_S

WIDTH = 100
TIME_WIDTH = 12
MOST_COLUMNS = 3
AROUND = 5  # rows that are shown before and after each move
LAST = 10  # rows that are shown before the failure
BEFORE = 50  # decisions before the first move, from which on rows are kept
GAP = 2
AT, WAITS, SENDS, PREEMPTED, ORDERED, ANSWERS = "at", "waits", "sends", "preempted", "ordered", "answers"


def timeline_of(trial: Trial, verdict: Verdict, failure: Failure, moves: Sequence[Move]) -> list[str]:
    """The lines of it; the run is flown once more.

    Args:
        trial: what is flown.
        verdict: of the shrunk schedule.
        failure: the one that it is about.
        moves: what the schedule does.
    """
    schedule = verdict.schedule
    first = min((decision for decision, _ in schedule.deviations), default=0)
    watch = FailureWatch(trial.events)
    look = TaskLook(trial.plan.spec(), first - BEFORE, lambda: watch.saw(failure.group))
    trial.fly(schedule, [watch, look], look.policy(schedule.policy() or Policy()))
    end_ns = verdict.end_ns if failure.at_ns is None else failure.at_ns
    rows = [row for row in look.rows if row.at_ns <= end_ns]
    sender = rows[-1].task if rows and failure.kind == INVARIANT and rows[-1].kind == SENDS else ""
    culprit = failure.task or sender
    return [*drawn(rows, columns(rows, moves, culprit)), *_last_lines(failure, culprit)]


def columns(rows: Sequence[Row], moves: Sequence[Move], culprit: str = "") -> tuple[str, ...]:
    """The tasks that have a column, in the order in which they appear.

    These are the one in which the failure showed, those of the last moves, and those that connect. When these are not
    two, or a task was held up and others ran in the meantime, it is also who did something last.

    Args:
        rows: what all tasks did.
        moves: what the schedule does.
        culprit: the task in which the failure showed; empty when that is not known.
    """
    moved = [name for move in moves if not move.question for name in (move.task, move.chosen)]
    moved += [row.task for row in rows if row.kind == ANSWERS]
    wanted = list(dict.fromkeys([culprit, *reversed(moved)]))
    at_least = MOST_COLUMNS if HOLD in moved else 2
    wanted = [name for name in wanted if name not in ("", HOLD)]
    for row in reversed(rows):
        if len(wanted) >= at_least:
            break
        if row.task not in wanted:
            wanted.append(row.task)
    chosen = wanted[:MOST_COLUMNS]
    return tuple(name for name in dict.fromkeys([*moved, *(row.task for row in rows), *chosen]) if name in chosen)


def drawn(rows: Sequence[Row], tasks: Sequence[str]) -> list[str]:
    """A line a row, in the column of its task; rows that are far from every move and from the end are left out."""
    if not tasks:
        return []
    rows = [row for row in rows if row.task in tasks]
    file, rows = _without_file(rows)
    width = (WIDTH - TIME_WIDTH) // len(tasks) - GAP
    lines = [f"lines of {file}", ""] if file else []
    lines += [_line("time, s", tasks, width).rstrip(), _line("", ["-" * width] * len(tasks), width)]
    before = -1
    for at in _shown(rows):
        if at != before + 1:
            lines.append(_line("...", [], width))
        before = at
        row = rows[at]
        cells = [_text(row, width) if row.task == task else "" for task in tasks]
        time = f"{row.at_ns / NS_PER_S:.6f}"
        lines.append(_line(time, [_cut(cell, width) for cell in cells], width))
    return lines


def _without_file(rows: Sequence[Row]) -> tuple[str, Sequence[Row]]:
    """The name of the file that all places are in, and the rows without it; "" when there are several, or none."""
    files = {row.text.partition(":")[0] for row in rows if row.kind == AT}
    if len(files) != 1:
        return "", rows
    file = files.pop()
    return file, [replace(row, text=row.text[len(file) + 1 :]) if row.kind == AT else row for row in rows]


def _shown(rows: Sequence[Row]) -> list[int]:
    """The rows that are shown."""
    moves = [at for at, row in enumerate(rows) if row.kind in (PREEMPTED, ORDERED, ANSWERS)]
    near = {each for at in moves for each in range(at - AROUND, at + AROUND + 1)}
    return [at for at in range(len(rows)) if at in near or at >= len(rows) - LAST]


def _text(row: Row, width: int) -> str:
    if row.kind == ANSWERS:
        return f"=== {row.text} ==="
    if row.kind not in (PREEMPTED, ORDERED):
        return row.text
    if row.text == HOLD:
        return "=== HELD UP ==="
    short, whole = ("PREEMPTED", "PREEMPTED by") if row.kind == PREEMPTED else ("NOT FIRST", "AFTER")
    forms = (f"=== {whole} {row.text} ===", f"{whole} {row.text}")
    return next((text for text in forms if len(text) <= width), f"=== {short} ===")


def _line(time: str, cells: Sequence[str], width: int) -> str:
    return (time.ljust(TIME_WIDTH) + (" " * GAP).join(cell.ljust(width) for cell in cells)).rstrip()


def _cut(text: str, width: int) -> str:
    return text if len(text) <= width else f"{text[: width - 3]}..."


def _last_lines(failure: Failure, culprit: str) -> list[str]:
    at = "at the end" if failure.at_ns is None else f"{failure.at_ns / NS_PER_S:.6f}"
    where = f" in {culprit}:" if culprit else ""
    lines = wrap(f"FAILURE{where} {failure.title}", WIDTH - TIME_WIDTH)
    return [(at if not number else "").ljust(TIME_WIDTH) + line for number, line in enumerate(lines)]


@dataclass(frozen=True, slots=True)
class Row:
    """Something that a task did.

    Attributes:
        at_ns: virtual time.
        task: its name.
        kind: AT a line of source, WAITS for something, SENDS a message, is PREEMPTED by `text`, or `text` is ORDERED
            before it, or it ANSWERS a question as the schedule has it.
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
        """A policy that decides as another does, and notes the place of each task when it is asked."""
        return _LookingPolicy(inner, self)

    def reached(self, decision: int) -> None:
        """So many decisions are behind."""
        self.is_on = self.is_on or decision >= self._first

    def add(self, task: str, kind: str, text: str) -> None:
        """Keep something, until the failure has been seen."""
        if self._goes_on():
            self._keep(task, kind, text)

    def answers(self, text: str) -> None:
        """Keep what became of a question; the running task may be of a node that only just begins."""
        if self._mission is not None:
            self.add(self._mission.kernel.current.name, ANSWERS, text)

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


class _LookingPolicy(AskingPolicy):
    def __init__(self, inner: Policy, look: TaskLook) -> None:
        super().__init__(inner)
        self._look = look

    def choose(self, decision: Decision) -> int:
        """See `Policy.choose`. It is asked in the task that gives the processor away."""
        choice = self._inner.choose(decision)
        self._look.reached(decision.number)
        self._look.look(sys._getframe(1))
        if choice and decision.question is not None:
            self._look.answers(decision.question.told.format(decision.answers[choice]))
        elif choice:
            kind = PREEMPTED if decision.running else ORDERED
            self._look.add(decision.subject, kind, decision.answers[choice])
        return choice

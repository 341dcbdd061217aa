"""A failing run as a timeline: a column for each task that matters, from the first preemption to the failure.

Plain text of 100 columns. May import everything to the left of cfepy.explore.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from textwrap import wrap

from cfepy.explore.failures import FailureWatch
from cfepy.explore.moves import Move
from cfepy.explore.recording import AT, ORDERED, PREEMPTED, SENDS, Row, TaskLook
from cfepy.explore.trial import Trial
from cfepy.explore.verdict import INVARIANT, Failure, Verdict
from cfepy.rtos.policy import HOLD, Policy
from cfepy.rtos.schedule import Schedule
from cfepy.rtos.units import NS_PER_S

WIDTH = 100
TIME_WIDTH = 12
MOST_COLUMNS = 3
AROUND = 5  # rows that are shown before and after each move
LAST = 10  # rows that are shown before the failure
BEFORE = 50  # decisions before the first move, from which on rows are kept
GAP = 2


def timeline(trial: Trial, verdict: Verdict, failure: Failure, moves: Sequence[Move]) -> list[str]:
    """The lines of it; the run is flown once more.

    Args:
        trial: what is flown.
        verdict: of the shrunk schedule.
        failure: the one that it is about.
        moves: what the schedule does.
    """
    schedule = Schedule.parse(verdict.schedule)
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

    These are the one in which the failure showed and those of the last moves. When these are not two, or a task was
    held up and others ran in the meantime, it is also who did something last.

    Args:
        rows: what all tasks did.
        moves: what the schedule does.
        culprit: the task in which the failure showed; empty when that is not known.
    """
    moved = [name for move in moves for name in (move.task, move.chosen)]
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
    moves = [at for at, row in enumerate(rows) if row.kind in (PREEMPTED, ORDERED)]
    near = {each for at in moves for each in range(at - AROUND, at + AROUND + 1)}
    return [at for at in range(len(rows)) if at in near or at >= len(rows) - LAST]


def _text(row: Row, width: int) -> str:
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

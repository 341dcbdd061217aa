"""A failing run as a timeline: a column for each task that matters, from the first preemption to the failure.

Plain text of 100 columns. May import everything to the left of cfepy.explore.
"""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import wrap

from cfepy.explore.moves import Move
from cfepy.explore.recording import ORDERED, PREEMPTED, Row, TaskLook
from cfepy.explore.trial import Trial
from cfepy.explore.verdict import Failure, Verdict
from cfepy.rtos.policy import HOLD, Policy
from cfepy.rtos.schedule import Schedule
from cfepy.rtos.units import NS_PER_S

WIDTH = 100
TIME_WIDTH = 12
MOST_COLUMNS = 3
AROUND = 5  # rows that are shown before and after each move
LAST = 10  # rows that are shown before the failure
GAP = 2


def timeline(trial: Trial, verdict: Verdict, failure: Failure, moves: Sequence[Move]) -> list[str]:
    """The lines of it; the run is flown once more.

    Args:
        trial: what is flown.
        verdict: of the shrunk schedule.
        failure: the one that it is about.
        moves: what the schedule does.
    """
    tasks = tasks_of(moves)
    look = TaskLook(trial.plan.spec(), tasks)
    schedule = Schedule.parse(verdict.schedule)
    trial.fly(schedule, [look], look.policy(schedule.policy() or Policy()))
    end_ns = verdict.end_ns if failure.at_ns is None else failure.at_ns
    rows = [row for row in look.rows if row.at_ns <= end_ns]
    return [*drawn(rows, tasks), *_last_lines(failure)]


def tasks_of(moves: Sequence[Move]) -> tuple[str, ...]:
    """The tasks that the moves are about, in the order in which they appear; those of the last moves when too many."""
    names = [name for move in moves for name in (move.task, move.chosen) if name != HOLD]
    last = list(dict.fromkeys(reversed(names)))[:MOST_COLUMNS]
    return tuple(name for name in dict.fromkeys(names) if name in last)


def drawn(rows: Sequence[Row], tasks: Sequence[str]) -> list[str]:
    """A line a row, in the column of its task; rows that are far from every move and from the end are left out."""
    if not tasks:
        return []
    width = (WIDTH - TIME_WIDTH) // len(tasks) - GAP
    lines = [_line("time, s", tasks, width).rstrip(), _line("", ["-" * width] * len(tasks), width)]
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
    text = f"=== {whole} {row.text} ==="
    return text if len(text) <= width else f"=== {short} ==="


def _line(time: str, cells: Sequence[str], width: int) -> str:
    return (time.ljust(TIME_WIDTH) + (" " * GAP).join(cell.ljust(width) for cell in cells)).rstrip()


def _cut(text: str, width: int) -> str:
    return text if len(text) <= width else f"{text[: width - 3]}..."


def _last_lines(failure: Failure) -> list[str]:
    at = "at the end" if failure.at_ns is None else f"{failure.at_ns / NS_PER_S:.6f}"
    lines = wrap(f"FAILURE {failure.title}", WIDTH - TIME_WIDTH)
    return [(at if not number else "").ljust(TIME_WIDTH) + line for number, line in enumerate(lines)]

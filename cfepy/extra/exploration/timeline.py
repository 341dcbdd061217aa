"""The story of a failing run: its cause in a sentence, and a column for each task that matters, up to the failure.

The run is flown once more with a `TaskLook`. It records the place of each task in its source at every preemption point,
and its operations on locks, messages and similar. The run under fifo is recorded too, for comparison. The records are
drawn as plain text.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from textwrap import wrap
from typing import Protocol

from cfepy.attachment import Attachment
from cfepy.extra.exploration.cause import NO_CAUSE, Evidence, cause_of, deadlock_of
from cfepy.extra.exploration.failure_kinds import FailureWatch
from cfepy.extra.exploration.made_moves import MadeMove, MoveNotingPolicy
from cfepy.extra.exploration.mission_transfer import PlanElsewhere
from cfepy.extra.exploration.run_times import RunTimes
from cfepy.extra.exploration.task_look import (
    ANSWERS,
    AT,
    DOES,
    ORDERED,
    PREEMPTED,
    SENDS,
    TOUCHES,
    WAITS,
    Row,
    TaskLook,
)
from cfepy.extra.exploration.trial import Trial, Tried
from cfepy.extra.exploration.verdict import INVARIANT, LONGEST, Failure, Verdict
from cfepy.pilot import RunPlan
from cfepy.rtos import HOLD, Policy
from cfepy.schedules import Schedule
from cfepy.units import NS_PER_S

WIDTH = 100
"""Width of a story in a file or a pipe: always the same, so that stories can be compared."""
LEAST_WIDTH = 60
"""Width of a story in a terminal that is narrower than this."""

TIME_WIDTH = 12
LEAST_COLUMN = 26  # characters: there are as many columns as fit
AROUND = 5  # rows that are shown before and after each move
LAST = 10  # rows that are shown before the failure
BEFORE = 50  # decisions before the first move, from which on rows are kept
GAP = 2
MOST_ROWS = 16  # rows of a group
FEW = 2  # rows: a group of this size is folded only when it comes three times
BETWEEN = " ... "  # between the first and the last of merged messages
CAUSE = "cause: "
MOST_OF_A_PAGE = 6  # tasks on a page of any width, and in a story that is too narrow for columns
MOVES = (PREEMPTED, ORDERED, ANSWERS)
_Kind = tuple[str, str, str]  # of a row; rows of a kind are merged
_MADE_AT = re.compile(r" \((?:line |[\w.]+:)\d+\)")  # after the name of a lock; left out first without room


@dataclass(frozen=True, slots=True)
class Story:
    """The events of a run, to be drawn.

    Attributes:
        rows: the events of the tasks.
        tasks: the tasks that matter, the most important first.
        cause: of the failure, a sentence; empty if it is not known.
        end: the failure, a line; empty for none.
        end_ns: virtual time of the failure; None for the end of the run.
    """

    rows: tuple[Row, ...] = ()
    tasks: tuple[str, ...] = ()
    cause: str = ""
    end: str = ""
    end_ns: int | None = None

    def lines(self, width: int = WIDTH) -> list[str]:
        """Return the story as text: a column for each task, or a list if the columns would be too narrow.

        Args:
            width: characters of a line.
        """
        of_cause = {row.task for row in self.rows if row.is_of_cause}
        most = (width - TIME_WIDTH) // (LEAST_COLUMN + GAP)
        is_wide = most >= min(len(self.tasks), max(2, len(of_cause)))
        tasks = self._tasks(most if is_wide else max(MOST_OF_A_PAGE, len(of_cause)))
        events = drawn(self.rows, tasks, width) if is_wide else listed(self.rows, tasks, width)
        cause = (
            wrap(CAUSE + self.cause, width, subsequent_indent=" " * len(CAUSE), break_on_hyphens=False)
            if self.cause
            else []
        )
        return [*cause, *([""] if cause else []), *events, *self._last_lines(width)]

    def table(self) -> tuple[tuple[str, ...], list[tuple[int | None, str, str, bool]]]:
        """Return the story as a table: the tasks that have a column, and the rows.

        A row has its virtual time in ns, its task, its text, and whether it is a move of the schedule. Time and task
        are None and empty if the row stands for others.
        """
        of_cause = {row.task for row in self.rows if row.is_of_cause}
        tasks = self._tasks(max(MOST_OF_A_PAGE, len(of_cause)))
        groups = _folded(_moving([row for row in self.rows if row.task in tasks]))
        rows: list[tuple[int | None, str, str, bool]] = []
        before = -1
        for at in _shown(groups):
            rows += [] if at == before + 1 else [(None, "", "...", False)]
            before = at
            rows += [(row.at_ns, row.task, _forms(row)[0], row.kind in MOVES) for row in groups[at].rows]
            rows += [] if groups[at].times == 1 else [(None, "", f"x {groups[at].times}: {_until(groups[at])}", False)]
        return tasks, rows

    def _tasks(self, most: int) -> tuple[str, ...]:
        """Return the tasks that have a column, in the order in which they appear."""
        chosen = set(self.tasks[:most])
        named = (row.task for row in self.rows if row.task in chosen)
        return tuple(dict.fromkeys([*named, *(task for task in self.tasks if task in chosen)]))

    def _last_lines(self, width: int) -> list[str]:
        if not self.end:
            return []
        at = "at the end" if self.end_ns is None else f"{self.end_ns / NS_PER_S:.6f}"
        lines = wrap(self.end, width - TIME_WIDTH, break_on_hyphens=False)
        return [(at if not number else "").ljust(TIME_WIDTH) + line for number, line in enumerate(lines)]


class Retellable(Protocol):
    """An experiment whose runs have a story, such as a `Trial`."""

    @property
    def plan(self) -> RunPlan:
        """The run."""

    @property
    def events(self) -> str:
        """The events that are failures, as for `FailureWatch`."""

    def fly(self, schedule: Schedule, attachments: Sequence[Attachment] = (), policy: Policy | None = None) -> Tried:
        """Fly it, as `Trial.fly` does."""


def story_of(trial: Retellable, verdict: Verdict, failure: Failure, moves: Sequence[MadeMove]) -> Story:
    """Fly the run once more, and the run under fifo. Returns the story of the failure.

    If fifo fails in this way already, only a circle of waiting tasks is a cause, since there is no run to compare with.

    Args:
        trial: the trial.
        verdict: of the shrunk schedule, or of fifo.
        failure: the failure.
        moves: moves of the schedule.
    """
    schedule = verdict.schedule
    first = min((decision for decision, _ in verdict.deviations), default=0)
    watch = FailureWatch(trial.events)
    look = TaskLook(trial.plan.spec(), first - BEFORE, lambda: watch.saw(failure.group))
    times, usual_times = RunTimes(), RunTimes()
    timed = failure.span_ns is not None
    trial.fly(schedule, [watch, look, *([times] if timed else [])], look.policy(schedule.policy() or Policy()))
    fifo, usual = schedule.at({}), TaskLook(trial.plan.spec())
    watching = [usual, *([usual_times] if timed else [])]
    known = trial.fly(fifo, watching, usual.policy(fifo.policy() or Policy())).verdict.failure(failure.group)
    end_ns = verdict.end_ns if failure.at_ns is None else failure.at_ns
    rows = tuple(row for row in look.rows if row.at_ns <= end_ns)
    sender = rows[-1].task if rows and failure.kind == INVARIANT and rows[-1].kind == SENDS else ""
    culprit = failure.task or sender
    ran, usually_ran = (each.between(end_ns - (failure.span_ns or 0), end_ns) for each in (times, usual_times))
    evidence = Evidence(failure, moves, rows, look.deeds, usual.deeds, look.names, ran, usually_ran)
    cause = NO_CAUSE if failure.kind == LONGEST else deadlock_of(evidence) if known is not None else cause_of(evidence)
    rows = tuple(row for row in look.rows_with(cause.deeds) if row.at_ns <= end_ns)
    touched = {deed.thing for deed in look.deeds if deed.ident and deed.thing in cause.text}
    rows = tuple(_without_touches(rows, touched))
    title, text = (_named(each, look.names) for each in (failure.title, failure.text))
    what, title = ("LONGEST", f"{failure.who} {text}") if failure.kind == LONGEST else ("FAILURE", title)
    end = f"{what}{f' in {culprit}:' if culprit else ''} {title}"
    tasks = important(rows, moves, culprit, f"{cause.text} {text}")
    return Story(rows, tasks, cause.text, end, failure.at_ns)


def story_width(is_terminal: bool, indent: int = 0) -> int:
    """Return the width of a story's lines: the terminal's width without the indent; always the same elsewhere."""
    return max(LEAST_WIDTH, shutil.get_terminal_size().columns - indent) if is_terminal else WIDTH


def story_of_run(plan: RunPlan, root: str = "") -> Story | None:
    """Return the story of a run under a schedule with some deviations from fifo.

    Args:
        plan: the run; it is flown again, and the run under fifo.
        root: folder that stands for the root of its files; empty for none.

    Returns:
        The story of the first failure that the run under fifo does not have; None if there is none.
    """
    if root:
        plan = PlanElsewhere.of(plan, root)
    fifo = Trial(plan).fly(plan.schedule.at({}))
    trial = Trial(plan).against(fifo.results)
    noting = MoveNotingPolicy(plan.schedule.policy() or Policy())
    verdict = trial.fly(plan.schedule, policy=noting).verdict
    failure = next((each for each in verdict.failures if each.group not in fifo.verdict.groups), None)
    return None if failure is None else story_of(trial, verdict, failure, noting.made)


def _named(text: str, names: Mapping[str, str]) -> str:
    """Return a text with the names of locks instead of their numbers."""
    for told, name in names.items():
        text = text.replace(told, name)
    return text


def important(rows: Sequence[Row], moves: Sequence[MadeMove], culprit: str = "", text: str = "") -> tuple[str, ...]:
    """Return the tasks that may have a column, the most important first.

    These are the tasks whose operations the cause names, then the task of the failure, the tasks of the moves (the last
    move first), and the tasks of questions. Tasks that the failure and its cause name also count. If these are fewer
    than two, or a task was delayed and others ran in the meantime, the last active tasks are added.

    Args:
        rows: the events of all tasks.
        moves: moves of the schedule.
        culprit: the task in which the failure showed; empty if it is not known.
        text: of the failure and its cause.
    """
    words = set(text.replace(",", " ").replace(";", " ").replace("'", " ").split())
    moved = [name for move in moves if not move.question for name in (move.task, move.chosen)]
    moved += [row.task for row in rows if row.kind == ANSWERS]
    acting = list(dict.fromkeys(row.task for row in reversed(rows)))
    of_cause = [row.task for row in rows if row.is_of_cause]
    wanted = dict.fromkeys(
        [*of_cause, culprit, *reversed(moved), *(task for task in reversed(acting) if task in words)]
    )
    for no_task in ("", HOLD):
        wanted.pop(no_task, None)
    at_least = 3 if HOLD in moved else 2
    return (*wanted, *[task for task in acting if task not in wanted][: max(0, at_least - len(wanted))])


def drawn(rows: Sequence[Row], tasks: Sequence[str], width: int = WIDTH) -> list[str]:
    """Return a line for each row, in its task's column.

    Rows far from every move, from the end, and from the operations of the cause are left out. A file that has all lines
    of a task is named once, above its column.
    """
    if not tasks:
        return []
    rows = _moving([row for row in rows if row.task in tasks])
    files = {task: _only_file(row for row in rows if row.task == task) for task in tasks}
    common = _only_file(rows)
    groups = _folded([_short(row, common or files[row.task]) for row in rows])
    heads = ["" if common or not files[task] else f"lines of {files[task]}" for task in tasks]
    shown = [groups[at] for at in _shown(groups)]
    needs = [max(_need(task, shown), len(head)) for task, head in zip(tasks, heads, strict=True)]
    widths = _widths(needs, width - TIME_WIDTH)
    lines = [f"lines of {common}", ""] if common else []
    lines.append(_line("time, s", tasks, widths))
    lines += [_line("", heads, widths)] if any(heads) else []
    lines.append(_line("", ["-" * each for each in widths], widths))
    return [*lines, *_events(groups, lambda row: _row_line(row, tasks, widths))]


def listed(rows: Sequence[Row], tasks: Sequence[str], width: int) -> list[str]:
    """Return a line for each row that `drawn` shows, with the name of its task, for a terminal without room."""
    if not tasks:
        return []
    rows = _moving([row for row in rows if row.task in tasks])
    file = _only_file(rows)
    names = max(map(len, ("task", *tasks)))
    widths = [names, width - TIME_WIDTH - GAP - names]
    lines = [f"lines of {file}", ""] if file else []
    lines += [_line("time, s", ["task", "operation"], widths), _line("", ["-" * each for each in widths], widths)]

    def line(row: Row) -> str:
        return _line(f"{row.at_ns / NS_PER_S:.6f}", [row.task, _cell(row, widths[1])], widths)

    return [*lines, *_events(_folded([_short(row, file) for row in rows]), line)]


def _events(groups: Sequence[_Group], line: Callable[[Row], str]) -> Iterator[str]:
    """Yield the lines of the groups that are shown, with "..." in place of the others."""
    before = -1
    for at in _shown(groups):
        if at != before + 1:
            yield "..."
        before = at
        yield from map(line, groups[at].rows)
        if groups[at].times > 1:
            until = _until(groups[at])
            yield _line(f"x {groups[at].times}", [until], [len(until)])


def _without_touches(rows: Sequence[Row], but: Collection[str]) -> Iterator[Row]:
    """Yield the rows without accesses to variables, except accesses to the given ones."""
    for row in rows:
        place, _, text = row.text.partition("\n")
        if row.kind != TOUCHES:
            yield row
        elif row.is_of_cause or text.partition(" ")[2] in but:
            yield replace(row, kind=AT, text=place)
            yield replace(row, kind=DOES, text=text)


def _until(group: _Group) -> str:
    what = "row" if len(group.rows) == 1 else f"{len(group.rows)} rows"
    return f"the {what} above, until {group.until_ns / NS_PER_S:.6f}"


def _moving(rows: Sequence[Row]) -> list[Row]:
    """Return the rows without repeated places of a task that only performs operations of other rows there."""
    kept: list[Row] = []
    at: dict[str, str] = {}
    for row in rows:
        if kept and kept[-1].task != row.task:
            at.clear()
        if row.kind != AT or at.get(row.task) != row.text:
            kept.append(row)
        if row.kind == AT:
            at[row.task] = row.text
    return kept


def _only_file(rows: Iterable[Row]) -> str:
    """Return the file of all places; "" if there are several files, or none."""
    files = {row.text.partition(":")[0] for row in rows if row.kind == AT}
    return files.pop() if len(files) == 1 else ""


def _short(row: Row, file: str) -> Row:
    """Return a row without the name of the file of all places, if there is one."""
    if not file or row.kind not in (AT, DOES, WAITS):
        return row
    text = row.text[len(file) + 1 :] if row.kind == AT else row.text.replace(f" ({file}:", " (line ")
    return replace(row, text=text)


def _shown(groups: Sequence[_Group]) -> list[int]:
    """Return the groups of rows that are shown: those near a move and the end, and all that the cause names."""
    moves = [at for at, group in enumerate(groups) if any(row.kind in MOVES for row in group.rows)]
    shown = {each for at in moves for each in range(at - AROUND, at + AROUND + 1)}
    places: dict[str, int] = {}  # by task, the group with its last line of source
    for at, group in enumerate(groups):
        for row in group.rows:
            if row.kind == AT:
                places[row.task] = at
            elif row.is_of_cause:
                shown |= {at, places.get(row.task, at)}
    return [at for at in range(len(groups)) if at in shown or at >= len(groups) - LAST]


def _need(task: str, groups: Sequence[_Group]) -> int:
    """Return the width of a column that fits all its texts."""
    texts = (_forms(row)[0] for group in groups for row in group.rows if row.task == task)
    return max(len(task), *map(len, texts), LEAST_COLUMN)


def _widths(needs: Sequence[int], width: int) -> list[int]:
    """Return the column widths: the needed width while there is room; the rest is shared evenly among the others."""
    widths = [0] * len(needs)
    left = width - GAP * len(needs)
    for place, at in enumerate(sorted(range(len(needs)), key=lambda at: needs[at])):
        widths[at] = min(needs[at], left // (len(needs) - place))
        left -= widths[at]
    return widths


def _row_line(row: Row, tasks: Sequence[str], widths: Sequence[int]) -> str:
    cells = ["" if row.task != task else _cell(row, width) for task, width in zip(tasks, widths, strict=True)]
    return _line(f"{row.at_ns / NS_PER_S:.6f}", cells, widths)


def _cell(row: Row, width: int) -> str:
    forms = _forms(row)
    return next((text for text in forms if len(text) <= width), _cut(forms[-1], width))


def _forms(row: Row) -> tuple[str, ...]:
    """Return the texts of a row, the longest form first."""
    if row.kind == ANSWERS:
        return (f"=== {row.text} ===",)
    if row.kind not in (PREEMPTED, ORDERED):
        return row.text, _MADE_AT.sub("", row.text)
    if row.text == HOLD:
        return ("=== DELAYED ===",)
    short, whole = ("PREEMPTED", "PREEMPTED by") if row.kind == PREEMPTED else ("NOT FIRST", "AFTER")
    return f"=== {whole} {row.text} ===", f"{whole} {row.text}", f"=== {short} ==="


def _line(time: str, cells: Sequence[str], widths: Sequence[int]) -> str:
    texts = (_cut(cell, width).ljust(width) for cell, width in zip(cells, widths, strict=True))
    return (time.ljust(TIME_WIDTH) + (" " * GAP).join(texts)).rstrip()


def _cut(text: str, width: int) -> str:
    return text if len(text) <= width else f"{text[: width - 3]}..."


@dataclass(frozen=True, slots=True)
class _Group:
    """A group of successive rows.

    Attributes:
        rows: the rows of the first time.
        times: number of repetitions.
        until_ns: virtual time at which they were over.
    """

    rows: tuple[Row, ...]
    times: int
    until_ns: int


def _folded(rows: Sequence[Row]) -> list[_Group]:
    """Return the rows in groups, with immediate repetitions merged. Most groups are a single row."""
    groups: list[_Group] = []
    kinds = [_kind(row) for row in rows]
    at = 0
    while at < len(rows):
        length, times = max(((each, _times(kinds, at, each)) for each in range(1, MOST_ROWS + 1)), key=_saved)
        if _saved((length, times)) == 0:
            length, times = 1, 1
        end = at + length * times
        merged = tuple(_merged(rows[first:end:length]) for first in range(at, at + length))
        groups.append(_Group(merged, times, rows[end - 1].at_ns))
        at = end
    return groups


def _kind(row: Row) -> _Kind:
    """Return the key by which rows are merged: everything except the time.

    For messages it is the topic, unless the cause names the message: then its values are shown.
    """
    text = row.text.partition(":")[0] if row.kind == SENDS and not row.is_of_cause else row.text
    return row.task, row.kind, text


def _times(kinds: Sequence[_Kind], at: int, length: int) -> int:
    """Return how often a group of rows repeats."""
    group, times = kinds[at : at + length], 1
    while len(group) == length and kinds[at + times * length : at + (times + 1) * length] == group:
        times += 1
    return times


def _saved(folding: tuple[int, int]) -> int:
    """Return the number of rows that folding saves; 0 if that is not worth a line about it."""
    length, times = folding
    return length * (times - 1) if times > 2 or (times == 2 and length > FEW) else 0


def _merged(rows: Sequence[Row]) -> Row:
    """Return the row that stands for its repetitions."""
    first, last = rows[0], rows[-1]
    text = first.text if first.text == last.text else first.text + BETWEEN + last.text.partition(": ")[2]
    return replace(first, text=text, is_of_cause=any(row.is_of_cause for row in rows))

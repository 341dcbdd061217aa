"""Deadlocks: the tasks that wait in a circle, and a report of every waiting task, what it waits for, and the holder."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

from cfepy.rtos.task import Task


class Wait(NamedTuple):
    """A task that waits, without a limit in time, for something that another one holds.

    Attributes:
        task: the one that waits.
        what: for what, such as "mutex BUS".
        holder: the task that has it.
    """

    task: Task
    what: str
    holder: Task

    def __str__(self) -> str:
        gone = ", which has ended" if self.holder.done else ""
        return f"{self.task.name} waits for {self.what}, held by {self.holder.name}{gone}"


def deadlocks(tasks: Sequence[Task]) -> list[tuple[Wait, ...]]:
    """The circles of tasks that wait for each other, and the tasks that wait for one that has ended.

    Each comes once, the oldest task of a circle in front.
    """
    waits = {task: wait for task in tasks if (wait := _wait_of(task)) is not None}
    found: list[tuple[Wait, ...]] = []
    seen: set[Task] = set()
    for task in tasks:
        path: dict[Task, Wait] = {}
        here = task
        while here in waits and here not in seen:
            seen.add(here)
            path[here] = waits[here]
            here = waits[here].holder
        if here in path:
            circle = list(path)
            found.append(tuple(waits[each] for each in circle[circle.index(here) :]))
        elif path and here.done:
            found.append((list(path.values())[-1],))
    return found


def _wait_of(task: Task) -> Wait | None:
    if task.waits is None or task.waits.owner is None or task.timer:
        return None
    holder = task.waits.owner()
    return None if holder is None else Wait(task, task.waits.what, holder)


def waiting_report(tasks: Iterable[Task], timers: Iterable[tuple[int, int, Task]]) -> str:
    """One line a task: name, priority, what it waits for, until when, and the task that could end the wait."""
    deadlines = {task: when for when, sequence, task in timers if task.timer == sequence}
    return "\n".join(_line(task, deadlines.get(task)) for task in tasks)


def _line(task: Task, deadline: int | None) -> str:
    text = f"{task.name} (task {task.ident}, priority {task.priority})"
    if task.waits is None:
        return f"{text} sleeps until {deadline / 1e9:.9f} s" if deadline is not None else f"{text} is ready"
    text += f" waits for {task.waits.what}"
    holder = task.waits.owner() if task.waits.owner is not None else None
    if holder is not None:
        text += f", held by {holder.name}"
    if deadline is not None:
        text += f", until {deadline / 1e9:.9f} s"
    return text

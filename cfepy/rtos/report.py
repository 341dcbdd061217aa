"""The deadlock report: every waiting task, what it waits for, and who holds that."""

from __future__ import annotations

from collections.abc import Iterable

from cfepy.rtos.task import Task


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

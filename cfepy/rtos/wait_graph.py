"""The wait-for graph: which tasks wait for which, which waits can never end, and a report of all waiting tasks.

A waiting task has either holders, all of which must let go first (the owner of a mutex, the readers of a lock), or
wakers, any one of which can wake it. A wait never ends if one of its holders has ended or waits forever itself, if no
task is left that could wake it, or if its object was deleted. A task whose wait has a time limit continues.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from typing import NamedTuple

from cfepy.rtos.task import Task
from cfepy.rtos.wait_list import WaitList

Wakers = Callable[[Task, Collection[Task]], bool]
"""Returns whether a task that may continue, or the outside world, could end the wait of a task without holders.

It gets the waiting task, and the tasks that are not known to be able to continue.
"""


class Wait(NamedTuple):
    """A task that waits, without a time limit, for an object that another task holds.

    Attributes:
        task: the waiting task.
        what: the object, such as "mutex BUS".
        holder: the task that holds it, or None if no task holds it and no task is left to give it.
    """

    task: Task
    what: str
    holder: Task | None = None

    def __str__(self) -> str:
        if self.holder is None:
            return f"{self.task.name} waits for {self.what}, and no remaining task can end this wait"
        gone = ", which has ended" if self.holder.done else ""
        return f"{self.task.name} waits for {self.what}, held by {self.holder.name}{gone}"


def _by_holders_only(task: Task, lost: Collection[Task]) -> bool:
    return True


def endless(tasks: Sequence[Task], could_end: Wakers = _by_holders_only) -> list[Wait]:
    """Return the waits that can never end, in the order of the tasks.

    Args:
        tasks: all tasks that have not ended.
        could_end: called for each task that waits for an object without holders.
    """
    awaits = {task: waits for task in tasks if (waits := awaited(task)) is not None}
    holders = {task: waits.holders() for task, waits in awaits.items()}
    lost = dict.fromkeys(holders)
    free: Task | None = None
    while True:  # the set shrinks until each task in it waits for another one in it
        for free in lost:
            if awaits[free].is_orphaned:
                continue
            if not _blocking(holders[free], lost) and (holders[free] or could_end(free, lost)):
                break
        else:
            return [_wait(task, _blocking(holders[task], lost)) for task in lost]
        del lost[free]


def _blocking(holders: Sequence[Task], lost: Collection[Task]) -> list[Task]:
    """Return the holders that will never let go."""
    return [holder for holder in holders if holder.done or holder in lost]


def awaited(task: Task) -> WaitList | None:
    """Return the list in which a task waits without a time limit, or None."""
    return task.awaits if task.awaits is not None else (None if task.timer else task.waits)


def _wait(task: Task, holders: list[Task]) -> Wait:
    waits = awaited(task)
    assert waits is not None
    return Wait(task, waits.what, holders[0] if holders else None)


def circles(waits: Sequence[Wait]) -> list[tuple[Wait, ...]]:
    """Return the cycles of tasks that wait for each other, and the tasks that wait for an ended task.

    Each cycle appears once, with its oldest task first.

    Args:
        waits: the waits that never end.
    """
    by_task = {wait.task: wait for wait in waits if wait.holder is not None}
    found: list[tuple[Wait, ...]] = []
    seen: set[Task] = set()
    for task in by_task:
        path: dict[Task, Wait] = {}
        here: Task | None = task
        while here in by_task and here not in seen:
            seen.add(here)
            path[here] = by_task[here]
            here = by_task[here].holder
        if here in path:
            circle = list(path)
            found.append(tuple(by_task[each] for each in circle[circle.index(here) :]))
        elif path and here is not None and here.done:
            found.append((list(path.values())[-1],))
    return found


def waiting_report(tasks: Iterable[Task], timers: Iterable[tuple[int, int, Task]]) -> str:
    """Return one line for each task: name, priority, the object it waits for, the deadline, and the task that could end
    the wait.
    """
    deadlines = {task: when for when, sequence, task in timers if task.timer == sequence}
    return "\n".join(_line(task, deadlines.get(task)) for task in tasks)


def _line(task: Task, deadline: int | None) -> str:
    text = f"{task.name} (task {task.ident}, priority {task.priority})"
    if task.waits is None:
        return f"{text} sleeps until {deadline / 1e9:.9f} s" if deadline is not None else f"{text} is ready"
    text += f" waits for {task.waits.what}"
    if holders := task.waits.holders():
        text += f", held by {' and '.join(holder.name for holder in holders)}"
    if deadline is not None:
        text += f", until {deadline / 1e9:.9f} s"
    return text

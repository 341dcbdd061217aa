"""Priority inversion: a task waits for a lock of a less urgent task while a task with a priority in between runs.

    BC_DIST (priority 40) waited 65.5 ms for semaphore SELECT held by ASI_MET (priority 120) while COMM (priority 80)
    ran for 65.5 ms

The wait is as long as the work of the third task, not of the lock's owner. Mutexes with priority inheritance, such as
OSAL's, prevent this (Sha, Rajkumar, Lehoczky: IEEE Transactions on Computers 39, 1990). A semaphore has no owner. It
counts as a lock of the task that took it last, if it was made full, or if this task has given it back before. A
semaphore that another task gives is a signal, not a lock.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from types import MethodType
from typing import Any

from cfepy.mission import Mission, Processor
from cfepy.monitors.observer import Observer
from cfepy.monitors.record import KEPT_INVERSIONS, Inversion, InversionRecord
from cfepy.osal import OsObject
from cfepy.rtos import Task
from cfepy.units import NS_PER_MS

SHORTEST_NS = NS_PER_MS  # minimum duration of reported inversions, by default
_TAKES = ("bin_sem_take", "bin_sem_timed_wait", "count_sem_take", "count_sem_timed_wait")
_GIVES = ("bin_sem_give", "count_sem_give")
_CREATES = ("bin_sem_create", "count_sem_create")


@dataclass(slots=True)
class _Wait:
    """A task that waits for a lock of another one, with the run times of other tasks meanwhile, in ns."""

    what: str
    holder: Task
    holder_priority: int
    since_ns: int
    others: dict[Task, int] = field(default_factory=dict)


class InversionWatch(Observer):
    """Finds the priority inversions of a run, and adds them to its record.

    Args:
        shortest_ns: inversions in which others ran for less are dropped.
    """

    def __init__(self, shortest_ns: int = SHORTEST_NS) -> None:
        super().__init__()
        self._shortest_ns = shortest_ns
        self._holders: dict[int, Task] = {}  # the task that took a semaphore last, by its id
        self._locks: set[tuple[int, Task]] = set()  # semaphores, with tasks that took them and gave them back
        self._full: set[int] = set()  # semaphores that were made full, and that only their takers have given
        self._waits: dict[Task, _Wait] = {}
        self._ran_from = 0
        self._held_up: list[_Wait] = []  # waits in which the running task is one of the others

    @property
    def found(self) -> InversionRecord:
        """Return the finished inversions of the run so far."""
        return self.mission.record.part(InversionRecord)

    def begin(self, mission: Mission) -> None:
        super().begin(mission)
        mission.record.part(InversionRecord).clear()

    def power_up(self, processor: Processor) -> None:
        """After a reset, drop all waits; the semaphores are new."""
        self._end_all()
        super().power_up(processor)
        self._holders.clear()
        self._locks.clear()
        self._full.clear()
        osal = processor.cfe.os
        for names, wrapped in ((_TAKES, self._taking), (_GIVES, self._giving), (_CREATES, self._creating)):
            for name in names:
                # other attachments wrap methods too
                setattr(osal, name, MethodType(wrapped(getattr(osal, name)), osal))

    def conclude(self) -> None:
        """Count unfinished waits until now."""
        self._end_all()

    # -- semaphores as locks -----------------------------------------------------------------------------------------

    def _creating(self, create: Callable[..., int]) -> Callable[..., int]:
        def call(_: object, name: str, initial_value: int, options: int = 0) -> int:
            made = create(name, initial_value, options)
            if initial_value:
                self._full.add(made)
            return made

        return call

    def _taking(self, take: Callable[..., Any]) -> Callable[..., Any]:
        def call(_: object, sem_id: int, *timeout: int) -> Any:
            taken = take(sem_id, *timeout)
            if taken is not False:
                self._holders[sem_id] = self._kernel.current
            return taken

        return call

    def _giving(self, give: Callable[[int], None]) -> Callable[[object, int], None]:
        def call(_: object, sem_id: int) -> None:
            task = self._kernel.current
            if self._holders.get(sem_id) is task:
                self._locks.add((sem_id, task))
                del self._holders[sem_id]
            else:
                self._full.discard(sem_id)
            give(sem_id)

        return call

    def _holder_of(self, task: Task) -> Task | None:
        """Return the less urgent task that holds the lock which a task is about to wait for, if there is
        exactly one.
        """
        waits = task.waits
        if waits is None:
            return None
        holders = list(waits.holders())
        if isinstance(waits.subject, OsObject):
            semaphore = waits.subject.id
            holder = self._holders.get(semaphore)
            is_lock = semaphore in self._full or (semaphore, holder) in self._locks
            holders += [holder] if holder is not None and is_lock else []
        return holders[0] if len(holders) == 1 and holders[0].base_priority > task.priority else None

    # -- waiting and running -------------------------------------------------------------------------------------------

    def on_leave(self, task: Task, at_ns: int, waits: bool) -> None:
        """Count the time that a task has run, and note if it starts to wait."""
        ran_ns = at_ns - self._ran_from
        if ran_ns:
            for each in self._held_up:
                each.others[task] = each.others.get(task, 0) + ran_ns
        self._held_up = []
        holder = self._holder_of(task) if waits else None
        if holder is not None:
            assert task.waits is not None
            self._waits[task] = _Wait(task.waits.what, holder, holder.base_priority, at_ns)

    def on_run(self, task: Task, at_ns: int) -> None:
        """Find the waits in which this task is one of the others."""
        if task in self._waits:
            self._end(task, at_ns)
        self._ran_from = at_ns
        self._held_up = [
            wait
            for victim, wait in self._waits.items()
            if task is not wait.holder
            and victim.priority < task.priority <= wait.holder.priority
            and not self._kernel.is_waiting(wait.holder)
        ]

    def on_ready(self, task: Task, at_ns: int) -> None:
        """A wait is over."""
        if task in self._waits:
            self._end(task, at_ns)

    def _end(self, task: Task, at_ns: int) -> None:
        wait = self._waits.pop(task)
        others = tuple((other.name, other.base_priority, ran_ns) for other, ran_ns in wait.others.items())
        found = Inversion(
            wait.since_ns,
            task.name,
            task.base_priority,
            wait.what,
            wait.holder.name,
            wait.holder_priority,
            at_ns - wait.since_ns,
            others,
        )
        if others and found.lost_ns >= self._shortest_ns and len(self.found) < KEPT_INVERSIONS:
            self.found.append(found)

    def _end_all(self) -> None:
        now_ns = self._kernel.now
        if self._running is not None:
            self.on_leave(self._running, now_ns, False)
        for task in list(self._waits):
            self._end(task, now_ns)

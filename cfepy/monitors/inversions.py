"""Priority inversion: a task waits for what a less urgent one holds, and a third one, of a priority between, runs.

    BC_DIST (priority 40) waited 65.5 ms for semaphore SELECT held by ASI_MET (priority 120) while COMM (priority 80)
    ran for 65.5 ms

That is bounded by what the third one has to do, not by the lock: it is what mutexes with priority inheritance, as
OSAL's are, keep from happening (Sha, Rajkumar, Lehoczky: IEEE Transactions on Computers 39, 1990). A semaphore has no
owner. It counts as a lock of the task that took it last, when this task has given it back before.
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

SHORTEST_NS = NS_PER_MS  # of those that are told, where nobody says otherwise
_TAKES = ("bin_sem_take", "bin_sem_timed_wait", "count_sem_take", "count_sem_timed_wait")
_GIVES = ("bin_sem_give", "count_sem_give")


@dataclass(slots=True)
class _Wait:
    """A task that waits for what another one holds, and who ran meanwhile, by task in ns."""

    what: str
    holder: Task
    holder_priority: int
    since_ns: int
    others: dict[Task, int] = field(default_factory=dict)


class InversionWatch(Observer):
    """Finds the priority inversions of a run, and keeps them in its record.

    Args:
        shortest_ns: those in which others ran for less are not kept.
    """

    def __init__(self, shortest_ns: int = SHORTEST_NS) -> None:
        super().__init__()
        self._shortest_ns = shortest_ns
        self._holders: dict[int, Task] = {}  # who took a semaphore last, by its id
        self._locks: set[tuple[int, Task]] = set()  # semaphores, with tasks that gave back what they took
        self._waits: dict[Task, _Wait] = {}
        self._ran_from = 0
        self._held_up: list[_Wait] = []  # those for whom the running task is one of the others

    @property
    def found(self) -> InversionRecord:
        """Those of the run so far that are over."""
        return self.mission.record.part(InversionRecord)

    def begin(self, mission: Mission) -> None:
        super().begin(mission)
        mission.record.part(InversionRecord).clear()

    def power_up(self, processor: Processor) -> None:
        """A reset: what waited does not wait any more, and there are other semaphores."""
        self._end_all()
        super().power_up(processor)
        self._holders.clear()
        self._locks.clear()
        osal = processor.cfe.os
        for names, wrapped in ((_TAKES, self._taking), (_GIVES, self._giving)):
            for name in names:
                setattr(osal, name, MethodType(wrapped(getattr(osal, name)), osal))  # others get in before methods

    def conclude(self) -> None:
        """Who waits still has waited until now."""
        self._end_all()

    # -- semaphores as locks -----------------------------------------------------------------------------------------

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
            give(sem_id)

        return call

    def _holder_of(self, task: Task) -> Task | None:
        """The less urgent task that has what a task is about to wait for, if there is exactly one."""
        waits = task.waits
        if waits is None:
            return None
        holders = list(waits.holders())
        if isinstance(waits.subject, OsObject):
            holder = self._holders.get(waits.subject.id)
            holders += [holder] if holder is not None and (waits.subject.id, holder) in self._locks else []
        return holders[0] if len(holders) == 1 and holders[0].base_priority > task.priority else None

    # -- who waits, and who runs -------------------------------------------------------------------------------------

    def on_leave(self, task: Task, at_ns: int, waits: bool) -> None:
        """A task has run for a while, and may begin to wait."""
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
        """Others may be held up by the task."""
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

"""The happens-before order of actions of tasks, and data races: vector clocks (Fidge 1988, Mattern 1989).

Each task has a clock that counts its releases. It also knows the clocks of other tasks, as of its last acquisition from
them. An action of a task happens before the present action of another task if that task knows the clock of the action.
"""

from __future__ import annotations

from collections.abc import Hashable
from typing import NamedTuple

from cfepy.rtos import Task
from cfepy.units import instant_text


class RaceSide(NamedTuple):
    """One access of a race.

    Attributes:
        place: its place in the source.
        is_write: whether it is a write.
        task: name of its task.
        calls: its call stack, the outermost call first.
        at_ns: virtual time in ns; None if it is not kept.
    """

    place: str
    is_write: bool
    task: str
    calls: tuple[str, ...] = ()
    at_ns: int | None = None

    def __str__(self) -> str:
        """Return a text such as `write in add (case.c:12) of ADDER`."""
        return f"{'write' if self.is_write else 'read'} in {self.place} of {self.task}"

    @property
    def stack(self) -> str:
        """The call stack as text, such as `ADDER: child (case.c:40) > add (case.c:12)`."""
        at = "" if self.at_ns is None else f", at {instant_text(self.at_ns)}"
        return f"{self.task}: {' > '.join((*self.calls, self.place))}{at}"


class Race(NamedTuple):
    """A data race: the variable, the access that found it, the earlier access, the running application and the time in
    virtual ns.
    """

    what: str
    before: RaceSide
    now: RaceSide
    who: str
    at_ns: int

    def __str__(self) -> str:
        """Return a one-line text, which does not depend on the order of the two accesses."""
        first, second = sorted((str(self.before), str(self.now)))
        return f"{self.what}: {first}, {second}: nothing orders them"

    def told(self) -> tuple[int, str, str, str, str]:
        """Return plain values: virtual ns, text, the order and the call stacks, application, task."""
        lines = (f"{self.before} came first, then {self.now}", self.before.stack, self.now.stack)
        return self.at_ns, str(self), "\n".join(lines), self.who, self.now.task


class VectorClocks:
    """The knowledge of each task about the clocks of the others."""

    def __init__(self) -> None:
        self._known: dict[Task, dict[Task, int]] = {}
        self._left: dict[Hashable, dict[Task, int]] = {}

    def of(self, task: Task) -> dict[Task, int]:
        """Return the clocks that a task knows: its own, from 1, and those of others as of its last acquisitions."""
        known = self._known.get(task)
        if known is None:
            known = self._known[task] = {task: 1}
        return known

    def let_go(self, task: Task, key: Hashable) -> None:
        """Release a key: a task that takes it later knows all earlier actions of this task."""
        known = self.of(task)
        _join(self._left.setdefault(key, {}), known)
        known[task] += 1

    def take(self, task: Task, key: Hashable) -> None:
        """Acquire a key: the task learns the actions of all tasks that have released it."""
        left = self._left.get(key)
        if left is not None:
            _join(self.of(task), left)

    def hand(self, task: Task, other: Task) -> None:
        """Pass the actions of a task on to another task, which is not running."""
        known = self.of(task)
        _join(self.of(other), known)
        known[task] += 1

    def send(self, task: Task) -> dict[Task, int]:
        """Return the clocks that a task knows now, for `receive` in another task."""
        known = self.of(task)
        sent = dict(known)
        known[task] += 1
        return sent

    def receive(self, task: Task, sent: dict[Task, int]) -> None:
        """Learn the actions that another task has sent."""
        _join(self.of(task), sent)

    def take_ended(self, task: Task) -> None:
        """Learn the actions of all tasks that have ended."""
        for other, known in list(self._known.items()):
            if other.done:
                _join(self.of(task), known)

    def forget(self, key: Hashable) -> None:
        """Drop a key that will not be acquired any more."""
        self._left.pop(key, None)


def _join(known: dict[Task, int], more: dict[Task, int]) -> None:
    for task, clock in more.items():
        if clock > known.get(task, 0):
            known[task] = clock

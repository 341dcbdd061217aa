"""Which of two things that tasks do is ordered, and what a race of them is: vector clocks (Fidge 1988, Mattern 1989).

Each task has a clock, which counts what it has handed on, and knows those of others as far as it has taken something
from them. What one task did is ordered before what another does now if that one knows the clock that it had then.
"""

from __future__ import annotations

from collections.abc import Hashable
from typing import NamedTuple

from cfepy.rtos import Task
from cfepy.units import NS_PER_S


class RaceSide(NamedTuple):
    """One side of a race.

    Attributes:
        place: where in the source it is.
        is_write: whether it writes.
        task: its name.
        calls: those that it was in, outermost first.
        at_ns: virtual time; None where that is not kept.
    """

    place: str
    is_write: bool
    task: str
    calls: tuple[str, ...] = ()
    at_ns: int | None = None

    def __str__(self) -> str:
        """`write in add (case.c:12) of ADDER`."""
        return f"{'write' if self.is_write else 'read'} in {self.place} of {self.task}"

    @property
    def stack(self) -> str:
        """`ADDER: child (case.c:40) > add (case.c:12)`."""
        at = "" if self.at_ns is None else f", at {self.at_ns / NS_PER_S:.6f} s"
        return f"{self.task}: {' > '.join((*self.calls, self.place))}{at}"


class Race(NamedTuple):
    """A data race: the variable, the access that found it, the one before, and who was running when, in virtual ns."""

    what: str
    before: RaceSide
    now: RaceSide
    who: str
    at_ns: int

    def __str__(self) -> str:
        """One line; the same whichever of the two came first."""
        first, second = sorted((str(self.before), str(self.now)))
        return f"{self.what}: {first}, {second}: nothing orders them"

    def told(self) -> tuple[int, str, str, str, str]:
        """Itself as plain values: virtual ns, text, which came first and by which calls, application, task."""
        lines = (f"{self.before} came first, then {self.now}", self.before.stack, self.now.stack)
        return self.at_ns, str(self), "\n".join(lines), self.who, self.now.task


class VectorClocks:
    """What each task knows of the others."""

    def __init__(self) -> None:
        self._known: dict[Task, dict[Task, int]] = {}
        self._left: dict[Hashable, dict[Task, int]] = {}

    def of(self, task: Task) -> dict[Task, int]:
        """What a task knows: of itself its own clock, from 1; of others the clocks that it has taken."""
        known = self._known.get(task)
        if known is None:
            known = self._known[task] = {task: 1}
        return known

    def let_go(self, task: Task, key: Hashable) -> None:
        """Who takes this key later knows what the task did so far."""
        known = self.of(task)
        _join(self._left.setdefault(key, {}), known)
        known[task] += 1

    def take(self, task: Task, key: Hashable) -> None:
        """A task knows what all have done that have let go of this key."""
        left = self._left.get(key)
        if left is not None:
            _join(self.of(task), left)

    def hand(self, task: Task, other: Task) -> None:
        """Another task, which does not run, knows what a task did so far."""
        known = self.of(task)
        _join(self.of(other), known)
        known[task] += 1

    def send(self, task: Task) -> dict[Task, int]:
        """What a task knows now, for one that `receive`s it."""
        known = self.of(task)
        sent = dict(known)
        known[task] += 1
        return sent

    def receive(self, task: Task, sent: dict[Task, int]) -> None:
        """A task knows what another has sent."""
        _join(self.of(task), sent)

    def take_ended(self, task: Task) -> None:
        """A task knows what all have done that have ended by now."""
        for other, known in list(self._known.items()):
            if other.done:
                _join(self.of(task), known)

    def forget(self, key: Hashable) -> None:
        """Nobody will take this key any more."""
        self._left.pop(key, None)


def _join(known: dict[Task, int], more: dict[Task, int]) -> None:
    for task, clock in more.items():
        if clock > known.get(task, 0):
            known[task] = clock

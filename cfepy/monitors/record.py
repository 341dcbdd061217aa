"""Monitors' part of a run's record: deadlines, violated invariants and priority inversions.

`RunRecord.part` keeps a `DeadlineRecord`, an `InvariantRecords` and an `InversionRecord` for each run, across all
resets of the processor.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

from cfepy.units import NS_PER_S, time_text

if TYPE_CHECKING:
    from cfepy.monitors.deadlines import Check, Overrun

KEPT_INVERSIONS = 1000


@dataclass(slots=True)
class DeadlineRecord:
    """Deadlines of a run: the checks as in the mission file, and the first overruns of each."""

    checks: list[Check] = field(default_factory=list)
    overruns: list[Overrun] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class Violation:
    """Violation of an invariant: text, virtual time in ns, sender, and message."""

    text: str
    at_ns: int
    sender: str
    detail: str = ""


@dataclass(slots=True)
class InvariantRecord:
    """Result of an invariant: `place` is `file:line`, `judged` and `violated` count messages."""

    name: str
    place: str
    judged: int = 0
    violated: int = 0
    first: Violation | None = None


class InvariantRecords(dict[str, InvariantRecord]):
    """Invariants of a run, by name, as in the mission file."""


class Inversion(NamedTuple):
    """One wait with a priority inversion. Times in virtual ns.

    Attributes:
        at_ns: start of the wait.
        victim: name of the task that waited.
        victim_priority: its priority.
        what: lock, such as "semaphore SELECT".
        holder: name of the task that had the lock when the wait began.
        holder_priority: its priority.
        waited_ns: duration of the wait.
        others: name, priority and time of each task that ran meanwhile without being more urgent than the victim.
    """

    at_ns: int
    victim: str
    victim_priority: int
    what: str
    holder: str
    holder_priority: int
    waited_ns: int
    others: tuple[tuple[str, int, int], ...]

    @property
    def group(self) -> tuple[str, str, str]:
        """Victim, lock and holder."""
        return self.victim, self.what, self.holder

    @property
    def lost_ns(self) -> int:
        """Time for which others ran during the wait."""
        return sum(time_ns for _, _, time_ns in self.others)

    @property
    def text(self) -> str:
        """Description in one sentence."""
        ran = " and ".join(f"{name} (priority {it}) ran for {time_text(ns)}" for name, it, ns in self.others)
        waited = f"{self.victim} (priority {self.victim_priority}) waited {time_text(self.waited_ns)} for {self.what}"
        return f"{waited} held by {self.holder} (priority {self.holder_priority}) while {ran}"


@dataclass(frozen=True, slots=True)
class InversionResult:
    """The worst priority inversion of a victim, and the number of all. Times in virtual s."""

    victim: str
    what: str
    holder: str
    times: int
    worst_s: float
    at_s: float
    text: str


class InversionRecord(list[Inversion]):
    """Priority inversions of a run, the first 1000, ordered by their end."""

    def results(self) -> list[InversionResult]:
        """Return the worst of each victim and lock, in order of first occurrence."""
        groups: dict[tuple[str, str, str], list[Inversion]] = {}
        for each in self:
            groups.setdefault(each.group, []).append(each)
        return [_result(group) for group in groups.values()]


def _result(group: list[Inversion]) -> InversionResult:
    worst = max(group, key=lambda each: each.lost_ns)
    lost_s, at_s = worst.lost_ns / NS_PER_S, worst.at_ns / NS_PER_S
    return InversionResult(worst.victim, worst.what, worst.holder, len(group), lost_s, at_s, worst.text)

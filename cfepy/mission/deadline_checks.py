"""What is measured against a deadline: how often, how often in vain, and the worst there was."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from cfepy.mission.deadlines import time_text
from cfepy.rtos.units import NS_PER_S


class Overrun(NamedTuple):
    """A deadline that was missed: when in virtual ns, whose, which, and what happened."""

    at_ns: int
    owner: str
    kind: str
    text: str


@dataclass(frozen=True, slots=True)
class DeadlineResult:
    """One deadline. Times in virtual s.

    Attributes:
        owner: an application, topic or packet.
        kind: as in the mission file, such as "response".
        limit_s: what it asks for; of a period, the period itself.
        jitter_s: of a period; 0 for others.
        checked: how many times it was measured.
        overruns: how many times it was missed.
        worst_s: the worst that was measured; None as long as nothing was.
        first_at_s: when it was first missed; None when it never was.
    """

    owner: str
    kind: str
    limit_s: float
    jitter_s: float
    checked: int
    overruns: int
    worst_s: float | None
    first_at_s: float | None

    @property
    def limit_text(self) -> str:
        """The limit as people write it: "10 ms +- 1 ms"."""
        limit = time_text(round(self.limit_s * NS_PER_S))
        return f"{limit} +- {time_text(round(self.jitter_s * NS_PER_S))}" if self.kind == "period" else limit

    @property
    def problem(self) -> str | None:
        """A line that says how it was missed; None when it was not."""
        if not self.overruns or self.worst_s is None or self.first_at_s is None:
            return None
        times = f"{self.overruns} time{'s' if self.overruns > 1 else ''}"
        worst = time_text(round(self.worst_s * NS_PER_S))
        at = f"first at {self.first_at_s:g} s"
        return f"{self.owner} missed its deadline {self.kind} {self.limit_text} {times}, at worst with {worst}, {at}"


@dataclass(slots=True)
class Check:
    """One limit, and how it was kept so far; times in ns."""

    owner: str
    kind: str
    limit_ns: int
    jitter_ns: int = 0
    checked: int = 0
    worst_ns: int | None = None
    overruns: int = 0
    first_at_ns: int | None = None

    def measure(self, measured_ns: int) -> bool:
        """Take one measurement; whether it is good."""
        self.checked += 1
        self.saw(measured_ns)
        if self.kind == "period":
            return abs(measured_ns - self.limit_ns) <= self.jitter_ns
        if self.kind == "at_most_every":
            return measured_ns >= self.limit_ns
        return measured_ns <= self.limit_ns

    def saw(self, measured_ns: int) -> None:
        """Keep the worst that there was."""
        if self.worst_ns is None or self._badness(measured_ns) > self._badness(self.worst_ns):
            self.worst_ns = measured_ns

    def _badness(self, measured_ns: int) -> int:
        if self.kind == "period":
            return abs(measured_ns - self.limit_ns)
        return -measured_ns if self.kind == "at_most_every" else measured_ns

    def result(self) -> DeadlineResult:
        """What came of it."""
        worst = None if self.worst_ns is None else self.worst_ns / NS_PER_S
        first = None if self.first_at_ns is None else self.first_at_ns / NS_PER_S
        limit, jitter = self.limit_ns / NS_PER_S, self.jitter_ns / NS_PER_S
        return DeadlineResult(self.owner, self.kind, limit, jitter, self.checked, self.overruns, worst, first)

"""What an exploration has found: each distinct failure once, with how often it came and where it came first.

The failures of a run follow from each other more often than not, so a run counts for the first of them that the
reference run does not have. Imports only the plain data of verdicts.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from statistics import median
from typing import Any

from cfepy.explore.verdict import Failure, Verdict


@dataclass(slots=True)
class Finding:
    """A failure.

    Attributes:
        failure: as it was the first time.
        number: of the first schedule that showed it, from 0; None for the reference run.
        verdict: on that.
        numbers: of all schedules that showed it.
        others: titles of the other failures in the first run.
        simplest: the verdict of the run that showed it with the fewest preemptions: the best one to shrink.
    """

    failure: Failure
    number: int | None
    verdict: Verdict
    numbers: list[int] = field(default_factory=list)
    others: tuple[str, ...] = ()
    simplest: Verdict = field(init=False)

    def __post_init__(self) -> None:
        self.simplest = self.verdict

    def again(self, number: int, verdict: Verdict) -> None:
        """Another run showed it."""
        self.numbers.append(number)
        self.simplest = min(self.simplest, verdict, key=_moves)

    @property
    def in_reference(self) -> bool:
        """Whether the default schedule shows it as well."""
        return self.number is None

    @property
    def median_schedules(self) -> float | None:
        """How many schedules it took to come, and to come again, in the median; None when none of them showed it."""
        starts = [-1, *self.numbers]
        return median(b - a for a, b in pairwise(starts)) if self.numbers else None

    def to_dict(self) -> dict[str, Any]:
        """Plain data; times in ns."""
        return {
            "kind": self.failure.kind,
            "who": self.failure.who,
            "text": self.failure.text,
            "at_ns": self.failure.at_ns,
            "detail": self.failure.detail,
            "others": list(self.others),
            "under_fifo": self.in_reference,
            "schedules": len(self.numbers),
            "first_number": self.number,
            "first_schedule": self.verdict.schedule,
            "median_schedules": self.median_schedules,
        }


def _moves(verdict: Verdict) -> tuple[int, int]:
    """How much a schedule differs from the default one."""
    return verdict.preemptions, len(verdict.deviations)


class Findings:
    """Collects findings.

    Args:
        reference: the verdict on the default schedule.

    Attributes:
        troubles: verdicts that ended in an error of cfepy.
    """

    def __init__(self, reference: Verdict) -> None:
        self.troubles: list[Verdict] = [reference] if reference.trouble else []
        self._found: dict[str, Finding] = {}
        self._expected = frozenset(reference.groups)
        for failure in reference.failures:
            self._found.setdefault(failure.group, Finding(failure, None, reference))

    def take(self, number: int, verdict: Verdict) -> bool:
        """Take a verdict; whether the mission failed in a way in which it does not fail by default."""
        if verdict.trouble:
            self.troubles.append(verdict)
        if not verdict.failures:
            return False
        new = [failure for failure in verdict.failures if failure.group not in self._expected]
        failure = (new or verdict.failures)[0]
        others = tuple(dict.fromkeys(each.title for each in new if each.group != failure.group))
        finding = self._found.setdefault(failure.group, Finding(failure, number, verdict, others=others))
        finding.again(number, verdict)
        return bool(new)

    def all(self) -> list[Finding]:
        """All of them: those of the reference run, then the others as they were found."""
        return list(self._found.values())

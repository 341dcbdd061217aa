"""The result of shrinking a schedule that shows a bug."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from cfepy.extra.exploration.exploration import DEFAULT_SEEDS
from cfepy.extra.exploration.shrink import Shrinker, budget_of
from cfepy.extra.exploration.verdict import Verdict
from dev.quality.bugs import Bug, reference_trial


@dataclass(frozen=True, slots=True)
class Shrunk:
    """The shortest schedule that was found.

    Attributes:
        preemptions: how often a runnable task loses the processor.
        others: how often a task other than the first waiting one continues.
        probes: number of runs that it took.
        schedule: the schedule.
    """

    preemptions: int
    others: int
    probes: int
    schedule: str

    def __str__(self) -> str:
        return f"{self.preemptions} + {self.others}" if self.others else str(self.preemptions)

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        return asdict(self)


def shrunk(bug: Bug, verdicts: list[Verdict]) -> Shrunk:
    """Shrink as `cfepy explore` does it.

    Args:
        bug: that it shows.
        verdicts: on failing schedules, the shortest first.
    """
    trial = reference_trial(bug.folder)
    schedules = [verdict.schedule for verdict in verdicts]
    found = Shrinker(trial, schedules, verdicts[0].groups[0], budget_of(DEFAULT_SEEDS)).run()
    assert found is not None, f"{schedules[0]} does not show {bug.name} again"
    preemptions = sum(move.preempts for move in found.moves)
    return Shrunk(preemptions, len(found.moves) - preemptions, found.probes, found.verdict.schedule.text())

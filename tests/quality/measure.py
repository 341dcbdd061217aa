"""How many schedules a policy needs to find a bug: the median over trials with seeds of their own.

The trials of a bug take turns, a schedule each, until more than half of them have found it: then the median is known,
and nobody has flown a schedule more than it takes. When too many were flown before that, all that can be said is that
the median is larger than what each trial has tried.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

from cfepy.explore.search import SeededSearch, SystematicSearch, make_search
from cfepy.explore.trial import Trial
from cfepy.explore.verdict import Verdict
from cfepy.rtos.schedule import Schedule

TRIALS = 25
LONGEST = 2000  # schedules of one trial
MOST = 3000  # schedules of all trials together

POLICIES = ("random", "pct 1", "pct 2", "pct 3", "dfs 2", "all")
"""A policy of `cfepy explore --policy`, with its depth where it has one."""


@dataclass(frozen=True, slots=True)
class Median:
    """What was measured.

    Attributes:
        schedules: the median, or what each trial has tried in vain.
        found: whether it is the median.
        trials: how many there were; a systematic search has no seeds, so one is all.
        schedule: the first one that found the bug, as deviations from fifo; empty when none did.
    """

    schedules: int
    found: bool
    trials: int
    schedule: str = ""

    def __str__(self) -> str:
        return str(self.schedules) if self.found else f"> {self.schedules}"

    def to_dict(self) -> dict[str, Any]:
        """Plain data."""
        return asdict(self)


class Hunt:
    """One trial: a search, until it has found the bug."""

    def __init__(self, trial: Trial, search: SeededSearch | SystematicSearch) -> None:
        self._trial = trial
        self._search = search
        self._count = 0
        self.over = False

    def step(self) -> Verdict | None:
        """Fly one more schedule; its verdict, or None when there are no more."""
        schedule = self._search.next()
        if schedule is None:
            return None
        verdict = self._trial.run(schedule)
        assert not verdict.trouble, verdict.trouble
        self._search.tell(self._count, verdict)
        self._count += 1
        self.over = verdict.failed
        return verdict


def search_for(trial: Trial, policy: str, first_seed: int) -> SeededSearch | SystematicSearch:
    """The search of `cfepy explore` by a policy.

    Args:
        trial: how many decisions its runs have is found by flying one.
        policy: one of POLICIES.
        first_seed: of the first schedule.
    """
    name, _, depth = policy.partition(" ")
    steps = trial.run("at:").decisions
    return make_search(name, int(depth) if depth else None, steps, Schedule(), first_seed)


def hunts(trial: Trial, policy: str, count: int) -> list[Hunt]:
    """Trials of a policy whose seeds have nothing in common."""
    return [Hunt(trial, search_for(trial, policy, number * LONGEST)) for number in range(count)]


def median(trial: Trial, policy: str, trials: int = TRIALS, most: int = MOST) -> Median:
    """Measure one policy on one bug.

    Args:
        trial: of the bug's mission.
        policy: one of POLICIES.
        trials: how many; a systematic search has one.
        most: schedules of all trials together, from which on it is given up.
    """
    count = 1 if policy.startswith("dfs") else trials
    longest = min(LONGEST, most // count)
    running = hunts(trial, policy, count)
    first = ""
    for schedules in range(1, longest + 1):
        for verdict in _round(running):
            first = first or Schedule("at", deviations=verdict.deviations).text()
        if sum(hunt.over for hunt in running) > count // 2:
            return Median(schedules, True, count, first)
    return Median(longest, False, count, first)


def _round(running: list[Hunt]) -> Iterator[Verdict]:
    """One schedule for each trial that is not over; the verdicts of those that now are."""
    for hunt in running:
        verdict = None if hunt.over else hunt.step()
        if verdict is not None and verdict.failed:
            yield verdict

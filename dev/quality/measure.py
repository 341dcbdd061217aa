"""How many schedules a policy needs to find a bug: the median over trials with different seeds.

The trials of a bug take turns, one schedule each, until more than half of them have found it. Then the median is known,
and no trial has flown more schedules than that. If the limit of schedules is reached before, the result is only that
the median is larger than the number that each trial has tried.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from typing import Any

from cfepy.extra.exploration.campaign import Search
from cfepy.extra.exploration.missing_points import openings_of
from cfepy.extra.exploration.schedule_kinds import NOTHING_FOUND
from cfepy.extra.exploration.search import make_search
from cfepy.extra.exploration.trial import Trial
from cfepy.extra.exploration.verdict import Findings, Verdict
from cfepy.schedules.schedule import Schedule

TRIALS = 25
LONGEST = 2000  # schedules of one trial
SHOWN = 50  # schedules after which a user with a failure looks at it
MOST = 3000  # schedules of all trials together

POLICIES = {
    "random": ("random", None, 0),
    "hold": ("random", None, 1_000_000),
    "pct 1": ("pct", 1, 0),
    "pct 2": ("pct", 2, 0),
    "pct 3": ("pct", 3, 0),
    "abreast": ("abreast", None, 0),
    "dfs 2": ("dfs", 2, 0),
    "all": ("all", None, 0),
}
"""What `cfepy explore` is given for them: `--policy`, `--depth`, and `--hold` in ns."""


@dataclass(frozen=True, slots=True)
class Median:
    """A measurement.

    Attributes:
        schedules: the median, or how many schedules each trial has tried without success.
        found: whether it is the median.
        trials: how many there were; a systematic search has no seeds, so one is enough.
        exhausted: the policy has no further schedules.
    """

    schedules: int
    found: bool
    trials: int
    exhausted: bool = False

    def __str__(self) -> str:
        return str(self.schedules) if self.found else f"> {self.schedules}"

    def could_go_on(self, most: int) -> bool:
        """Return whether it is worth measuring again with so many schedules."""
        return not (self.found or self.exhausted) and self.schedules < longest(most, self.trials)

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        return asdict(self)


def longest(most: int, trials: int) -> int:
    """Return the limit of schedules of each trial, given the limit of all trials together."""
    return min(LONGEST, most // trials)


class Hunt:
    """One trial: a search, until it has found the bug."""

    def __init__(self, trial: Trial, search: Search) -> None:
        self._trial = trial
        self._search = search
        self._count = 0
        self.over = False
        self.exhausted = False

    def step(self) -> Verdict | None:
        """Fly one more schedule. Returns its verdict, or None if there are no more."""
        schedule = self._search.next()
        if schedule is None:
            self.exhausted = True
            return None
        verdict = self._trial.run(schedule)
        assert not verdict.trouble, verdict.trouble
        self._search.tell(self._count, verdict)
        self._count += 1
        self.over = verdict.failed
        return verdict


def hunts(trial: Trial, policy: str, count: int) -> list[Hunt]:
    """Return trials of a policy whose seeds do not overlap.

    Args:
        trial: trial of the bug's mission; all use its schedule's options.
        policy: one of POLICIES.
        count: how many.
    """
    name, depth, hold_ns = POLICIES[policy]
    options = replace(trial.plan.schedule, kind="at", hold_ns=hold_ns)
    steps = trial.run(options).decisions
    openings = openings_of(trial, options) if name == "all" and not options.points else NOTHING_FOUND
    return [
        Hunt(trial, make_search(name, depth, steps, options, first_seed, openings=openings))
        for first_seed in range(0, count * LONGEST, LONGEST)
    ]


def median(trial: Trial, policy: str, trials: int = TRIALS, most: int = MOST) -> Median:
    """Measure one policy on one bug.

    Args:
        trial: trial of the bug's mission.
        policy: one of POLICIES.
        trials: how many; a systematic search has one.
        most: limit of schedules of all trials together.
    """
    count = 1 if policy.startswith("dfs") else trials
    running = hunts(trial, policy, count)
    schedules = 0
    while schedules < longest(most, count):
        for hunt in running:
            if not hunt.over:
                hunt.step()
        if any(hunt.exhausted for hunt in running):
            return Median(schedules, False, count, exhausted=True)
        schedules += 1
        if sum(hunt.over for hunt in running) > count // 2:
            return Median(schedules, True, count)
    return Median(schedules, False, count)


def find(trial: Trial, policy: str, most: int = LONGEST) -> Verdict | None:
    """Return a policy's first verdict that shows a failure, or None if there is none within the limit.

    Args:
        trial: trial of a mission.
        policy: one of POLICIES.
        most: limit of schedules.
    """
    (hunt,) = hunts(trial, policy, 1)
    for _ in range(most):
        verdict = hunt.step()
        if verdict is None or verdict.failed:
            return verdict
    return None


def simplest(trial: Trial, policy: str) -> list[Verdict]:
    """Of the runs that `cfepy explore` would have made, those that show the first failure with few preemptions."""
    (hunt,) = hunts(trial, policy, 1)
    findings = Findings(trial.run(Schedule()))
    for number in range(LONGEST):
        verdict = hunt.step()
        if verdict is None:
            break
        findings.take(number, verdict)
        if findings.all() and number >= SHOWN:
            break
    return findings.all()[0].simplest if findings.all() else []


def as_deviations(verdict: Verdict) -> Schedule:
    """Return a schedule that gives the same run by its deviations from fifo."""
    return verdict.schedule.at(dict(verdict.deviations))

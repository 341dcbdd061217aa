"""The search for the longest: schedules under which a measure (`cfepy.monitors.durations`) takes as long as possible.

    search = WorstSearch(make_search(...))
    campaign = Campaign(MeasuredTrial(plan, measure=Measure.parse("response:ARM")), search, 200, crew)

It is a search in generations, which begins with schedules from seeds. Each generation is made when the verdicts on all
earlier schedules are known, so it does not depend on the number of processes. A generation has three parts. Neighbours
of the longest run answer one decision differently. Changed schedules come from the longest runs. A few more schedules
come from seeds, so that the search does not stay near its start. Decisions after the longest value do not affect it, so
all changes are before its end.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from random import Random
from statistics import median_low
from typing import Any

from cfepy.attachment import Attachment
from cfepy.extra.exploration.search import SeededSearch
from cfepy.extra.exploration.shrink import Shrinker, Shrunk
from cfepy.extra.exploration.timeline import Story, story_of
from cfepy.extra.exploration.trial import Trial, Tried
from cfepy.extra.exploration.verdict import LONGEST, Failure, Verdict
from cfepy.mission import Mission
from cfepy.monitors import RESPONSE, WAIT, LongestWatch, Measure
from cfepy.pilot import SentNames, no_such_app
from cfepy.rtos import NotingPolicy, Policy
from cfepy.schedules import Schedule
from cfepy.units import time_text

FROM_SEEDS = 40  # schedules before the first generation
NEIGHBOURS, CHANGED, FRESH = 6, 10, 4
"""Schedules of each kind in a generation. The numbers do not depend on the number of processes."""
PARENTS = 8
MOST_CHANGES = 4
WINDOW = 12  # the last decisions before the end matter more often than others
NOTHING = Measure("", "")


@dataclass(frozen=True, slots=True)
class MeasuredTrial(Trial):
    """A trial whose verdicts include the longest value of a measure.

    Attributes:
        measure: the measure.
        limit_ns: a value of at least this counts as a failure of the kind LONGEST; 0 for no limit.
    """

    measure: Measure = NOTHING
    limit_ns: int = 0

    def fly(self, schedule: Schedule, attachments: Sequence[Attachment] = (), policy: Policy | None = None) -> Tried:
        noted = NotingPolicy(schedule.policy() if policy is None else policy)
        at: list[int] = [0]

        def note() -> None:
            at[0] = len(noted.choices)

        watch = LongestWatch(self.measure, note)
        tried = Trial.fly(self, schedule, [*attachments, watch], noted)
        longest, verdict = watch.longest, replace(tried.verdict, deviations=tuple(sorted(noted.deviations.items())))
        if longest is not None:
            verdict = replace(verdict, longest=(longest.time_ns, longest.at_ns, at[0]))
            if self.limit_ns and longest.time_ns >= self.limit_ns:
                text = f"took {time_text(longest.time_ns)} {longest.where}"
                found = Failure(LONGEST, self.measure.text, text, longest.at_ns, task=longest.task, cause=LONGEST)
                verdict = replace(verdict, failures=(*verdict.failures, found))
        if longest is None and tried.booted_ns is not None:
            text = f"no value of {self.measure.text} was measured"
            tried = tried._replace(notes=(*tried.notes, f"{text}{_why_nothing(self.measure, watch.mission)}"))
        return tried._replace(verdict=verdict)


def _why_nothing(measure: Measure, mission: Mission) -> str:
    """Return the end of a sentence that explains why a run had no value of a measure."""
    if measure.kind == RESPONSE:
        return no_such_app(mission, measure.name)
    return "" if measure.kind == WAIT else SentNames(mission).why_not(filter(None, (measure.name, measure.effect)))


class WorstSearch:
    """Schedules with ever longer runs; see the module.

    Args:
        seeded: source of the first schedules and some of the later ones.
        seed: seed of the changes.
    """

    def __init__(self, seeded: SeededSearch, seed: int = 0) -> None:
        self._random = Random(f"worst {seed}")
        self._seeded = seeded
        self._given = self._told = 0
        self._waiting: deque[Schedule] = deque()
        self._fresh = FROM_SEEDS  # schedules from seeds that are still missing in this generation
        self._tried: set[Schedule] = set()
        self._parents: list[tuple[int, Verdict]] = []  # the longest first; of equals the first one found

    def next(self) -> Schedule | None:
        """Return the next schedule. None while a generation waits for the verdicts on all schedules before it."""
        if not self._waiting and not self._fresh:
            if self._told < self._given:
                return None
            self._waiting.extend(self._generation())
            self._fresh = FRESH
        if self._waiting:
            self._given += 1
            return self._waiting.popleft()
        found = self._seeded.next()
        if found is not None:
            self._given += 1
            self._fresh -= 1
        return found

    def tell(self, number: int, verdict: Verdict) -> None:
        self._told += 1
        self._seeded.tell(number, verdict)
        self._learn(number, verdict)

    def _learn(self, number: int, verdict: Verdict) -> None:
        """Keep the run if it is among the longest ones."""
        known = (_with(parent, _before_the_end(parent)) for _, parent in self._parents)
        if verdict.longest and _with(verdict, _before_the_end(verdict)) not in known:
            self._parents.append((number, verdict))
            self._parents.sort(key=lambda each: (-each[1].longest[0], each[0]))
            del self._parents[PARENTS:]

    def _generation(self) -> list[Schedule]:
        """Return the next generation, without its schedules from seeds."""
        if not self._parents:
            return []
        made = [*self._untried(self._neighbours(), NEIGHBOURS)]
        return [*made, *self._untried((self._changed() for _ in range(CHANGED * 4)), CHANGED)]

    def _untried(self, candidates: Iterable[Schedule], count: int) -> Iterator[Schedule]:
        """Yield at most `count` schedules that were not tried yet."""
        for each in candidates:
            if not count:
                return
            if each not in self._tried:
                self._tried.add(each)
                count -= 1
                yield each

    def _neighbours(self) -> Iterator[Schedule]:
        """Yield schedules with one changed decision: of the longest run first, the last decisions first."""
        for _, parent in self._parents:
            answers = _before_the_end(parent)
            for decision in reversed(range(_end(parent))):
                for answer in range(abs(parent.widths[decision])):
                    if answer != answers.get(decision, 0):
                        yield _with(parent, {**answers, decision: answer})

    def _changed(self) -> Schedule:
        """Return a changed schedule of one of the longest runs."""
        random = self._random
        parent = self._parents[int(len(self._parents) * random.random() ** 2)][1]
        widths = parent.widths[: _end(parent)]
        return _with(parent, _changed(random, _before_the_end(parent), widths, self._answers_of_any))

    def _answers_of_any(self) -> dict[int, int]:
        return _before_the_end(self._random.choice(self._parents)[1])


def _changed(
    random: Random, answers: dict[int, int], widths: Sequence[int], other: Callable[[], dict[int, int]]
) -> dict[int, int]:
    """Return the answers of a run with some decisions changed, and perhaps with the beginning of another run.

    Args:
        random: makes the choices.
        answers: the answers that differ from fifo's, by decision.
        widths: number of answers of each decision, also as negative numbers; without the decisions after the last one
            that matters.
        other: gives the answers of another run.
    """
    end = len(widths)
    if not end:
        return {}
    how = random.random()
    if how < 0.25:
        first, last = sorted((random.randrange(end), random.randrange(end)))
        answers = {at: answer for at, answer in answers.items() if not first <= at <= last}
    elif how < 0.4:
        others, cut = other(), random.randrange(end)
        early = {at: answer for at, answer in others.items() if at < cut}
        answers = early | {at: answer for at, answer in answers.items() if at >= cut}
    else:
        answers = dict(answers)
    for _ in range(random.randint(1, MOST_CHANGES)):
        decision = random.randrange(max(0, end - WINDOW) if random.random() < 0.5 else 0, end)
        answers[decision] = random.randrange(abs(widths[decision]))
    return answers


def _end(verdict: Verdict) -> int:
    """Return the number of decisions before the end of the longest value."""
    return min(verdict.longest[2], len(verdict.widths)) if verdict.longest else 0


def _before_the_end(verdict: Verdict) -> dict[int, int]:
    end = _end(verdict)
    return {decision: answer for decision, answer in verdict.deviations if decision < end}


def _with(parent: Verdict, answers: dict[int, int]) -> Schedule:
    return parent.schedule.at({decision: answer for decision, answer in answers.items() if answer})


@dataclass(slots=True)
class Distribution:
    """The measured values of all runs; times in ns.

    Attributes:
        measure: the measure.
        times: the value of each run that has one, in order of the schedules, without fifo's.
        under_fifo: the value of the reference run; None if it has none.
        longest: the verdict on the longest run, which may be fifo's; of equals the first one.
        number: number of its schedule; None for fifo.
    """

    measure: Measure
    times: list[int]
    under_fifo: int | None = None
    longest: Verdict | None = None
    number: int | None = None

    @classmethod
    def of(cls, measure: Measure, reference: Verdict) -> Distribution:
        """Return the distribution of the reference run alone."""
        found = cls(measure, [], reference.longest[0] if reference.longest else None)
        found.longest = reference if reference.longest else None
        return found

    def take(self, number: int, verdict: Verdict) -> None:
        """Add a verdict."""
        if verdict.longest:
            self.times.append(verdict.longest[0])
            if self.longest is None or verdict.longest[0] > self.longest.longest[0]:
                self.longest, self.number = verdict, number

    def quantiles(self) -> dict[str, int]:
        """Return the shortest, the median, the 99 % quantile and the longest; empty when nothing was measured."""
        times = sorted(self.times)
        if not times:
            return {}
        least_99 = times[-(-99 * len(times) // 100) - 1]
        return {"min": times[0], "median": median_low(times), "p99": least_99, "max": times[-1]}


@dataclass(slots=True)
class Worst:
    """The longest value for the report.

    Attributes:
        distribution: the values of all runs.
        shrunk: the longest run's schedule with the fewest preemptions that take as long; None when fifo's is the
            longest, or it was not searched for.
        story: the course of the run under that schedule.
        inversions: the priority inversions in that run, a sentence each, the longest first.
    """

    distribution: Distribution
    shrunk: Shrunk[MeasuredTrial] | None = None
    story: Story = field(default_factory=Story)
    inversions: list[str] = field(default_factory=list)

    @property
    def schedule(self) -> Schedule | None:
        """A schedule with the longest run, the shrunk one if there is one; None when nothing was measured."""
        found = self.distribution.longest if self.shrunk is None else self.shrunk.verdict
        if found is None:
            return None
        return found.schedule if self.distribution.number is not None else Schedule()

    def to_dict(self) -> dict[str, Any]:
        """Return plain data; times in ns."""
        found, longest = self.distribution, self.distribution.longest
        return {
            "measure": found.measure.text,
            "longest": None if longest is None else longest.longest[0],
            "at": None if longest is None else longest.longest[1],
            "number": found.number,
            "schedule": None if self.schedule is None else self.schedule.text(),
            "under_fifo": found.under_fifo,
            "measured": len(found.times),
            "quantiles": found.quantiles(),
            "timeline": self.story.lines(),
            "inversions": self.inversions,
        }


def worst_of(trial: MeasuredTrial, distribution: Distribution, most_probes: int, most_s: float | None = None) -> Worst:
    """Return the longest run of a campaign, shrunk, and with its timeline.

    Args:
        trial: the trial that was flown.
        distribution: the measured values.
        most_probes: runs that shrinking may take; 0 leaves the schedule as it is.
        most_s: wall time that it may take; None for any.
    """
    worst, longest = Worst(distribution), distribution.longest
    if longest is None:
        return worst
    limited = replace(trial, limit_ns=max(longest.longest[0], 1))
    if distribution.number is not None and most_probes:
        group = Failure(LONGEST, trial.measure.text, "", cause=LONGEST).group
        worst.shrunk = Shrinker(limited, [longest.schedule], group, most_probes, most_s).run()
        if worst.shrunk is not None:
            failure = worst.shrunk.verdict.failure(group)
            if failure is not None:
                worst.story = story_of(worst.shrunk.trial, worst.shrunk.verdict, failure, worst.shrunk.moves)
    worst.inversions = trial.inversions_before(worst.schedule or Schedule(), longest.longest[1])
    return worst

"""Generations: schedules that are made from the verdicts on those before them, the same for any number of processes.

A search in generations begins with schedules from seeds. Then come generations, each made when the verdicts on all
schedules before it are known, and each with a few more from seeds, so that it does not stay where it began.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from random import Random

from cfepy.exploration.search import SeededSearch
from cfepy.exploration.verdict import Verdict
from cfepy.rtos import Schedule

MOST_CHANGES = 4
WINDOW = 12  # decisions before the one that matters, which matter more often than others


class Generations(ABC):
    """A search in generations; derived classes make them.

    Args:
        seeded: where the first ones and some of the later ones come from.
        random: makes all choices.
        from_seeds: schedules before the first generation.
        fresh: schedules from seeds in each generation.
        first: schedules before all others.
    """

    def __init__(
        self, seeded: SeededSearch, random: Random, from_seeds: int, fresh: int, first: Iterable[Schedule] = ()
    ) -> None:
        self.random = random
        self._seeded = seeded
        self._given = self._told = 0
        self._waiting = deque(first)
        self._before_seeds = len(self._waiting)
        self._fresh, self._fresh_of_each = from_seeds, fresh
        self._tried: set[Schedule] = set()

    def next(self) -> Schedule | None:
        """See `cfepy.exploration.campaign.Search`: a generation waits for the verdicts on all schedules before it."""
        if not self._waiting and not self._fresh:
            if self._told < self._given:
                return None
            self._waiting.extend(self.generation())
            self._fresh = self._fresh_of_each
        if self._waiting:
            self._given += 1
            return self._waiting.popleft()
        found = self._seeded.next()
        if found is not None:
            self._given += 1
            self._fresh -= 1
        return found

    def tell(self, number: int, verdict: Verdict) -> None:
        """See `cfepy.exploration.campaign.Search`."""
        self._told += 1
        if number >= self._before_seeds:
            self._seeded.tell(number - self._before_seeds, verdict)
        self.learn(number, verdict)

    @abstractmethod
    def learn(self, number: int, verdict: Verdict) -> None:
        """The verdict on the schedule of this number is known."""

    @abstractmethod
    def generation(self) -> list[Schedule]:
        """The next one, without what comes from seeds."""

    def untried(self, candidates: Iterable[Schedule], count: int) -> Iterator[Schedule]:
        """The first ones that were not tried yet, so many at most."""
        for each in candidates:
            if not count:
                return
            if each not in self._tried:
                self._tried.add(each)
                count -= 1
                yield each


def changed(
    random: Random, answers: dict[int, int], widths: Sequence[int], other: Callable[[], dict[int, int]]
) -> dict[int, int]:
    """The answers of a run with some decisions otherwise, and perhaps with the beginning of another one.

    Args:
        random: makes the choices.
        answers: that are not fifo's, by decision.
        widths: how many answers each decision had, also as negative numbers; those behind the last one that matters are
            left out.
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

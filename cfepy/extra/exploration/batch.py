"""A lot: many runs of another kind than schedules of one trial, flown by the same crews of processes.

A crew hands out subjects and brings back answers; what they are, it does not look at. So what flies a campaign's
schedules flies the points of a sweep as well, on this computer or on a cluster.
"""

from __future__ import annotations

import contextlib
from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from typing import Generic, TypeVar, cast

from cfepy.extra.exploration.campaign import Crew, Experiment, Take

S = TypeVar("S")
A = TypeVar("A")


class Lot(ABC, Generic[S, A]):
    """What is done with each subject; pickled for crews of other processes, as its subjects and answers are."""

    @abstractmethod
    def judge(self, subject: S) -> A:
        """The answer for a subject. An error of cfepy itself is told in it, so that the others are flown.

        Raises:
            UsageError: none of them can fly.
        """

    @abstractmethod
    def died(self, subject: S, fate: str, words: str) -> A:
        """The answer for a subject that ends the process in which it is flown.

        Args:
            subject: which one.
            fate: how the process ended.
            words: its last ones.
        """


def answers(lot: Lot[S, A], subjects: Sequence[S], crew: Crew) -> Iterator[tuple[int, A]]:
    """All answers, as they come; each with the number of its subject. The crew is closed at the end.

    Args:
        lot: what is flown.
        subjects: each is handed out once.
        crew: who flies.

    Raises:
        UsageError: no worker can fly them.
    """
    left = list(enumerate(subjects))

    def take(limit: int) -> list[tuple[int, S]]:
        taken = left[:limit]
        del left[:limit]
        return taken

    # A crew is typed for schedules and verdicts; it looks into neither.
    found = crew.run(cast(Experiment, lot), cast(Take, take))
    with contextlib.closing(crew), contextlib.closing(found):
        yield from cast("Iterator[tuple[int, A]]", found)

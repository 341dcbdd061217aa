"""A lot: many runs that are not schedules of one trial, flown by the same crews of processes.

A crew hands out subjects and brings back answers, and does not look into them. So the crews that fly a campaign's
schedules also fly the points of a sweep, on this computer or on a cluster.
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
    """The work on each subject. It is pickled for crews of other processes, and so are its subjects and answers."""

    @abstractmethod
    def judge(self, subject: S) -> A:
        """Return the answer for a subject. It includes an error of cfepy itself, so that the other subjects still fly.

        Raises:
            UsageError: no subject can fly.
        """

    @abstractmethod
    def died(self, subject: S, fate: str, words: str) -> A:
        """Return the answer for a subject that ended the process in which it was flown.

        Args:
            subject: the subject.
            fate: how the process ended.
            words: the last output of the process.
        """


def answers(lot: Lot[S, A], subjects: Sequence[S], crew: Crew) -> Iterator[tuple[int, A]]:
    """Fly all subjects and yield the answers as they arrive. Close the crew at the end.

    Args:
        lot: the work to do.
        subjects: each is handed out once.
        crew: the processes that fly them.

    Yields:
        The number of a subject, and its answer.

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

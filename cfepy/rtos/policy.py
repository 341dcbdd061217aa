"""Who runs next among ready tasks of the same, highest priority.

Without a policy the kernel takes the one that has been ready for longest. A policy is asked only when there is a
choice, and its answers make the run: replaying them replays it.
"""

from __future__ import annotations

from collections.abc import Sequence
from random import Random
from typing import Protocol

from cfepy.rtos.task import Task


class Policy(Protocol):
    """Chooses among equals."""

    def choose(self, candidates: Sequence[Task]) -> int:
        """Index of the task to run.

        Args:
            candidates: at least two ready tasks of one priority, the one that became ready first in front.
        """


class SeededRandom:
    """Any of the candidates, the same ones for the same seed."""

    def __init__(self, seed: int) -> None:
        self._random = Random(seed)

    def choose(self, candidates: Sequence[Task]) -> int:
        """See `Policy.choose`."""
        return self._random.randrange(len(candidates))


class Recorded:
    """Asks another policy, or takes the first, and keeps the answers in `choices`."""

    def __init__(self, inner: Policy | None = None) -> None:
        self._inner = inner
        self.choices: list[int] = []

    def choose(self, candidates: Sequence[Task]) -> int:
        """See `Policy.choose`."""
        choice = self._inner.choose(candidates) if self._inner is not None else 0
        self.choices.append(choice)
        return choice


class Replay:
    """Gives recorded choices again, then takes the first.

    Args:
        choices: as `Recorded.choices` kept them.
    """

    def __init__(self, choices: Sequence[int]) -> None:
        self._choices = list(reversed(choices))

    def choose(self, candidates: Sequence[Task]) -> int:
        """See `Policy.choose`; a choice that is not possible any more becomes the last candidate."""
        return min(self._choices.pop(), len(candidates) - 1) if self._choices else 0

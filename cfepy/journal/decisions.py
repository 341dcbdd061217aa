"""The decisions of a run's policy: recorded during the run and repeated in its replay."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from cfepy.rtos import AskingPolicy, Decision, Policy


def settings_of(policy: Policy) -> dict[str, Any]:
    """Return the settings of a policy that the kernel reads apart from its answers, such as `any_priority`."""
    return {name: value for name, value in vars(policy).items() if not name.startswith("_")}


class JournalPolicy(AskingPolicy):
    """Asks another policy, and records answers that differ from fifo's.

    Args:
        inner: the policy that decides.

    Attributes:
        count: number of decisions.
    """

    def __init__(self, inner: Policy) -> None:
        super().__init__(inner)
        vars(self).update(settings_of(inner))
        self.count = 0
        self._last = -1
        self._pending: list[int] = []  # distance from one such decision to the next, and the answer, alternating

    def choose(self, decision: Decision) -> int:
        choice = self._inner.choose(decision)
        if choice:
            self._pending += (self.count - self._last, choice)
            self._last = self.count
        self.count += 1
        return choice

    def taken(self) -> list[int]:
        """Return the new entries since the last call: distances and answers, alternating."""
        pending, self._pending = self._pending, []
        self._last = self.count - 1
        return pending


class RetoldPolicy(AskingPolicy):
    """Repeats the recorded answers; asks the schedule's own policy for later ones.

    Args:
        answers: answers that differ from fifo's, by number of the decision.
        known: number of decisions that they cover.
        own: the schedule's own policy.
    """

    def __init__(self, answers: Mapping[int, int], known: int, own: Policy) -> None:
        super().__init__(own)
        vars(self).update(settings_of(own))
        self._answers = answers
        self._known = known
        self._count = -1

    def choose(self, decision: Decision) -> int:
        self._count += 1
        own = self._inner.choose(decision)
        if self._count >= self._known:
            return own
        return min(self._answers.get(self._count, 0), decision.width - 1)

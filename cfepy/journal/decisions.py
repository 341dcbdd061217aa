"""The decisions of a run's policy: noted while it runs, given again when it is replayed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from cfepy.rtos import AskingPolicy, Decision, Policy


def settings_of(policy: Policy) -> dict[str, Any]:
    """The settings of a policy that the kernel reads besides its answers, such as `any_priority`."""
    return {name: value for name, value in vars(policy).items() if not name.startswith("_")}


class JournalPolicy(AskingPolicy):
    """Asks another policy, and keeps what is not fifo's answer.

    Args:
        inner: the policy that decides.

    Attributes:
        count: how many decisions there were.
    """

    def __init__(self, inner: Policy) -> None:
        super().__init__(inner)
        vars(self).update(settings_of(inner))
        self.count = 0
        self._last = -1
        self._pending: list[int] = []  # the distance from one such decision to the next, and the answer, in turn

    def choose(self, decision: Decision) -> int:
        choice = self._inner.choose(decision)
        if choice:
            self._pending += (self.count - self._last, choice)
            self._last = self.count
        self.count += 1
        return choice

    def taken(self) -> list[int]:
        """What there is since the last call: gaps and answers, in turn."""
        pending, self._pending = self._pending, []
        self._last = self.count - 1
        return pending


class RetoldPolicy(AskingPolicy):
    """Gives the recorded answers again; asks the schedule's own policy for those that the journal does not have.

    Args:
        answers: those that were not fifo's, by number of the decision.
        known: how many decisions they cover.
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

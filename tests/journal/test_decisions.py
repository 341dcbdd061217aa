"""The recorded decisions of a run, and those after the end of the journal, are the decisions of the run."""

from __future__ import annotations

import pytest

from cfepy.journal.decisions import JournalPolicy, RetoldPolicy
from cfepy.rtos import Decision, Kernel, NotingPolicy, Policy
from cfepy.schedules import Schedule, make_kernel


def fly(policy: Policy) -> list[int]:
    """Return the decisions of three tasks that make five calls each."""
    recorded = NotingPolicy(policy)

    def work() -> None:
        for _ in range(5):
            kernel.charge(0)

    with make_kernel("greenlet", None, recorded) as made:
        kernel: Kernel = made
        for name in "abc":
            kernel.spawn(name, work)
        kernel.run(1_000_000)
    return recorded.choices


def own(text: str) -> Policy:
    policy = Schedule.parse(text).policy()
    assert policy is not None
    return policy


SCHEDULES = pytest.mark.parametrize("text", ["random:5", "pct:3:3:15", "at:2=1,7=2"])


@SCHEDULES
def test_run_continues_with_its_own_decisions_after_the_end_of_the_journal(text: str) -> None:
    choices = fly(own(text))
    assert len(choices) > 10
    assert any(choices)
    for known in range(len(choices) + 1):
        answers = {number: choice for number, choice in enumerate(choices[:known]) if choice}
        assert fly(RetoldPolicy(answers, known, own(text))) == choices


class Taking(Policy):
    """Takes the answers of a noted policy after every so many decisions, as the writer of a journal does."""

    def __init__(self, inner: Policy, every: int) -> None:
        super().__init__()
        self._noted = JournalPolicy(inner)
        self._every = every
        self._before = 0
        self.taken: dict[int, int] = {}

    def choose(self, decision: Decision) -> int:
        choice = self._noted.choose(decision)
        if self._noted.count % self._every == 0:
            self.take()
        return choice

    def take(self) -> None:
        pairs, at = self._noted.taken(), self._before - 1
        for gap, answer in zip(pairs[::2], pairs[1::2], strict=True):
            at += gap
            self.taken[at] = answer
        self._before = self._noted.count


@SCHEDULES
@pytest.mark.parametrize("every", [1, 2, 5, 100])
def test_recorded_parts_add_up_to_all_decisions(text: str, every: int) -> None:
    taking = Taking(own(text), every)
    choices = fly(taking)
    taking.take()
    assert choices == fly(own(text))
    assert taking.taken == {number: choice for number, choice in enumerate(choices) if choice}

"""A schedule as moves: "when this task would go on for the n-th time, that one runs instead".

The numbers of decisions in an `at:` schedule all change when one deviation is left out. Moves count for each task by
itself, so the others keep their meaning, which is what makes a schedule easy to shorten. May import cfepy.rtos.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from typing import NamedTuple

from cfepy.rtos.policy import HOLD, Decision, Policy


class Move(NamedTuple):
    """Not what fifo would do.

    Attributes:
        task: name of the task that fifo would run.
        number: how many decisions there were before in which it was that task.
        chosen: name of the task that runs, or HOLD.
        preempts: the task was running, and could have gone on.
    """

    task: str
    number: int
    chosen: str
    preempts: bool = True


class Choice(NamedTuple):
    """A decision that there was: when in virtual ns, the task of fifo, its number as of `Move`, who else could run."""

    now: int
    task: str
    number: int
    others: tuple[str, ...]
    preempts: bool


class MoveRecorder(Policy):
    """Asks another policy, and keeps its moves.

    Attributes:
        moves: those that it made.
        choices: all decisions that there were.
    """

    def __init__(self, inner: Policy) -> None:
        super().__init__(inner.any_priority, inner.hold_ns)
        self._inner = inner
        self._counts: Counter[str] = Counter()
        self.moves: list[Move] = []
        self.choices: list[Choice] = []

    def choose(self, decision: Decision) -> int:
        """See `Policy.choose`."""
        choice = self._inner.choose(decision)
        names = _names(decision)
        task = names[0]
        number = self._counts[task]
        self._counts[task] += 1
        self.choices.append(Choice(decision.now, task, number, tuple(names[1:]), decision.running))
        if choice:
            self.moves.append(Move(task, number, names[choice], decision.running))
        return choice


class MovePolicy(Policy):
    """Fifo but for some moves; one that is not possible is left out.

    Args:
        moves: which ones.
        any_priority: see `Policy`.
        hold_ns: see `Policy`.
    """

    def __init__(self, moves: Iterable[Move], any_priority: bool = False, hold_ns: int = 0) -> None:
        super().__init__(any_priority, hold_ns)
        self._chosen = {(move.task, move.number): move.chosen for move in moves}
        self._counts: Counter[str] = Counter()

    def choose(self, decision: Decision) -> int:
        """See `Policy.choose`."""
        names = _names(decision)
        key = (names[0], self._counts[names[0]])
        self._counts[names[0]] += 1
        chosen = self._chosen.get(key)
        return names.index(chosen) if chosen in names else 0


def _names(decision: Decision) -> list[str]:
    """The possible answers by name."""
    return [*(task.name for task in decision.tasks), *([HOLD] if decision.hold else [])]

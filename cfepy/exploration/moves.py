"""A schedule as moves: "when this task would go on for the n-th time, that one runs instead".

The numbers of decisions in an `at:` schedule all change when one deviation is left out. Moves count for each task by
itself, so the others keep their meaning, which is what makes a schedule easy to shorten.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import NamedTuple

from cfepy.rtos import Decision, Policy, Schedule
from cfepy.units import NS_PER_MS

DECISIONS_PER_MS = 1_000_000  # more than there ever are
_NUMBER = re.compile(r"\.\d+$")


class Move(NamedTuple):
    """Not what fifo would do.

    Attributes:
        task: name of the task that fifo would run, or of a question.
        number: which of the decisions in which it is that task; see `_Numbers`.
        chosen: name of the task that runs, or HOLD, or the answer.
        preempts: the task was running, and could have gone on.
        question: the kind of the question that it answers; empty for a change of turns.
    """

    task: str
    number: int
    chosen: str
    preempts: bool = True
    question: str = ""


class Choice(NamedTuple):
    """A decision of a run: when in virtual ns, and as of `Move`; `others` are the answers that are not fifo's."""

    now: int
    task: str
    number: int
    others: tuple[str, ...]
    preempts: bool
    question: str = ""

    def move(self, chosen: str) -> Move:
        """The move that another answer is."""
        return Move(self.task, self.number, chosen, self.preempts, self.question)


class MoveNotingPolicy(Policy):
    """Asks another policy, and keeps its moves.

    Attributes:
        moves: those that it made.
        choices: all decisions that there were.
    """

    def __init__(self, inner: Policy) -> None:
        super().__init__(*inner.settings)
        self._inner = inner
        self._numbers = _Numbers()
        self.moves: list[Move] = []
        self.choices: list[Choice] = []

    def choose(self, decision: Decision) -> int:
        """See `Policy.choose`."""
        choice = self._inner.choose(decision)
        answers, task = decision.answers, decision.subject
        number = self._numbers.next(decision.now, task)
        question = "" if decision.question is None else decision.question.kind
        made = Choice(decision.now, task, number, tuple(answers[1:]), decision.running, question)
        self.choices.append(made)
        if choice:
            self.moves.append(made.move(answers[choice]))
        return choice


class MovePolicy(Policy):
    """Fifo but for some moves; one that is not possible is left out.

    Args:
        moves: which ones.
        options: a schedule whose options it has.
    """

    def __init__(self, moves: Iterable[Move], options: Schedule) -> None:
        super().__init__(*options.settings)
        self._chosen = {(plain_name(move.task), move.number): move.chosen for move in moves}
        self._numbers = _Numbers()

    def choose(self, decision: Decision) -> int:
        """See `Policy.choose`."""
        task = decision.subject
        chosen = self._chosen.get((plain_name(task), self._numbers.next(decision.now, task)))
        return 0 if chosen is None else _index(decision.answers, chosen)


class _Numbers:
    """Numbers decisions, for each task by itself, anew in each millisecond of virtual time.

    So a move keeps its meaning when others are left out long before it.
    """

    def __init__(self) -> None:
        self._following: dict[str, int] = {}

    def next(self, now_ns: int, task: str) -> int:
        """The number of a decision; they only grow."""
        name = plain_name(task)
        number = max(self._following.get(name, 0), now_ns // NS_PER_MS * DECISIONS_PER_MS)
        self._following[name] = number + 1
        return number


def plain_name(name: str) -> str:
    """A task's name without the number that tasks of ROS nodes get in the order of their making."""
    return _NUMBER.sub("", name)


def _index(names: list[str], chosen: str) -> int:
    """Which of the answers is meant, 0 if none is."""
    if chosen in names:
        return names.index(chosen)
    return next((at for at, name in enumerate(names) if plain_name(name) == plain_name(chosen)), 0)

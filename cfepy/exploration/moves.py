"""A schedule as moves: "when this task would go on for the n-th time, that one runs instead".

The numbers of decisions in an `at:` schedule all change when one deviation is left out. Moves count for each task by
itself, so the others keep their meaning, which is what makes a schedule easy to shorten.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import NamedTuple

from cfepy.rtos import HOLD, Decision, Policy
from cfepy.units import NS_PER_MS

DECISIONS_PER_MS = 1_000_000  # more than there ever are
_NUMBER = re.compile(r"\.\d+$")


class Move(NamedTuple):
    """Not what fifo would do.

    Attributes:
        task: name of the task that fifo would run.
        number: which of the decisions in which it is that task; see `_Numbers`.
        chosen: name of the task that runs, or HOLD.
        preempts: the task was running, and could have gone on.
    """

    task: str
    number: int
    chosen: str
    preempts: bool = True


class Choice(NamedTuple):
    """A decision of a run: when in virtual ns, the task of fifo, its number as of `Move`, the other candidates."""

    now: int
    task: str
    number: int
    others: tuple[str, ...]
    preempts: bool


class MoveNotingPolicy(Policy):
    """Asks another policy, and keeps its moves.

    Attributes:
        moves: those that it made.
        choices: all decisions that there were.
    """

    def __init__(self, inner: Policy) -> None:
        super().__init__(inner.any_priority, inner.hold_ns)
        self._inner = inner
        self._numbers = _Numbers()
        self.moves: list[Move] = []
        self.choices: list[Choice] = []

    def choose(self, decision: Decision) -> int:
        """See `Policy.choose`."""
        choice = self._inner.choose(decision)
        names = _names(decision)
        task = names[0]
        number = self._numbers.next(decision.now, task)
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
        self._chosen = {(_plain(move.task), move.number): move.chosen for move in moves}
        self._numbers = _Numbers()

    def choose(self, decision: Decision) -> int:
        """See `Policy.choose`."""
        names = _names(decision)
        chosen = self._chosen.get((_plain(names[0]), self._numbers.next(decision.now, names[0])))
        return 0 if chosen is None else _index(names, chosen)


class _Numbers:
    """Numbers decisions, for each task by itself, anew in each millisecond of virtual time.

    So a move keeps its meaning when others are left out long before it.
    """

    def __init__(self) -> None:
        self._following: dict[str, int] = {}

    def next(self, now_ns: int, task: str) -> int:
        """The number of a decision; they only grow."""
        name = _plain(task)
        number = max(self._following.get(name, 0), now_ns // NS_PER_MS * DECISIONS_PER_MS)
        self._following[name] = number + 1
        return number


def _names(decision: Decision) -> list[str]:
    """The possible answers by name."""
    return [*(task.name for task in decision.tasks), *([HOLD] if decision.hold else [])]


def _plain(name: str) -> str:
    """A task's name without the number that tasks of ROS nodes get in the order of their making."""
    return _NUMBER.sub("", name)


def _index(names: list[str], chosen: str) -> int:
    """Which of the answers is meant, 0 if none is."""
    if chosen in names:
        return names.index(chosen)
    return next((at for at, name in enumerate(names) if _plain(name) == _plain(chosen)), 0)

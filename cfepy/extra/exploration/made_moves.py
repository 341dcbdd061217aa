"""The deviations of a run from fifo, and its alternatives, as moves; and the predictions that known runs allow.

The numbers of decisions in an `at:` schedule all change when one deviation is left out. Moves (`cfepy.schedules.moves`)
keep their meaning, which makes a schedule easy to shorten.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Generic, NamedTuple, Protocol, TypeVar

from cfepy.rtos import AskingPolicy, Decision, Policy
from cfepy.schedules import Move, MoveNumbers, MovesToMake


class MadeMove(NamedTuple):
    """A move that a run made.

    Attributes:
        move: the move.
        task: name of the task that fifo would have run, or of a question.
        chosen: name of the task that ran, or HOLD, or the answer.
        preempts: the task was running, and could have continued.
        question: the kind of the question that it answers; empty for a change of turns.
        decision: number of the decision in the run.
        choice: number of the answer.
    """

    move: Move
    task: str
    chosen: str
    preempts: bool
    question: str
    decision: int
    choice: int


class Choice(NamedTuple):
    """A decision of a run.

    Attributes:
        now: virtual ns.
        answers: by name, fifo's first.
        moves: the other answers as moves.
        taken: the number of the answer taken.
        subject: name of the task or question that it was about.
        preempts, question: see `MadeMove`.
    """

    now: int
    subject: str
    answers: tuple[str, ...]
    moves: tuple[Move, ...]
    taken: int
    preempts: bool
    question: str = ""


class MoveNotingPolicy(AskingPolicy):
    """Asks another policy, and keeps its moves.

    Attributes:
        choices: all decisions of the run.
    """

    def __init__(self, inner: Policy) -> None:
        super().__init__(inner)
        self._numbers = MoveNumbers()
        self.choices: list[Choice] = []

    def choose(self, decision: Decision) -> int:
        taken = self._inner.choose(decision)
        moves = self._numbers.moves(decision)
        question = "" if decision.question is None else decision.question.kind
        answers = tuple(decision.answers)
        subject = decision.subject
        self.choices.append(Choice(decision.now, subject, answers, moves, taken, decision.running, question))
        return taken

    @property
    def made(self) -> tuple[MadeMove, ...]:
        """The moves that it made."""
        return tuple(
            MadeMove(
                each.moves[each.taken - 1],
                each.subject,
                each.answers[each.taken],
                each.preempts,
                each.question,
                number,
                each.taken,
            )
            for number, each in enumerate(self.choices)
            if each.taken
        )


class NotedRun(Protocol):
    """A run that was flown."""

    @property
    def choices(self) -> Sequence[Choice]:
        """All its decisions."""


R = TypeVar("R", bound=NotedRun)


class _Node(Generic[R]):
    """All known runs that begin with the same deviations from fifo."""

    def __init__(self) -> None:
        self.following: dict[tuple[int, int], _Node[R]] = {}
        self.runs: list[tuple[int, R]] = []  # each with the decision at which it deviates next


class KnownRuns(Generic[R]):
    """Known runs of one mission, whose schedules have the same options. They predict the runs of other schedules.

    If two policies have given the same answers so far, the next decision is the same for both. So a schedule is
    followed along a known run. Where it decides differently, it is followed along another known run with that decision.
    This ends at the end of a run, or where no known run goes on.
    """

    def __init__(self) -> None:
        self._root: _Node[R] = _Node()

    def add(self, run: R) -> None:
        """Add a run."""
        node = self._root
        deviations = [(number, choice.taken) for number, choice in enumerate(run.choices) if choice.taken]
        for deviation in deviations:
            node.runs.append((deviation[0], run))
            node = node.following.setdefault(deviation, _Node())
        node.runs.append((len(run.choices), run))

    def find(self, moves: Iterable[Move]) -> R | None:
        """Return the run that these moves give, or None if it is not known."""
        to_make = MovesToMake(moves)
        node, number = self._root, 0
        while node.runs:
            until, run = max(node.runs, key=lambda each: each[0])
            for choice in run.choices[number:until]:
                answer = _answer(to_make, choice)
                number += 1
                if answer:
                    break
            else:
                if until == len(run.choices):
                    return run
                answer = _answer(to_make, run.choices[until])  # no known run goes on as fifo from there
                number = until + 1
                if not answer:
                    return None
            if (number - 1, answer) not in node.following:
                return None
            node = node.following[number - 1, answer]
        return None


def _answer(to_make: MovesToMake, choice: Choice) -> int:
    if not choice.moves or not to_make.concerns(choice.moves[0].subject, choice.now):
        return 0
    first = choice.moves[0]
    others = [move.chosen for move in choice.moves]
    return to_make.answer(first.subject, choice.now, others, lambda: first.place)

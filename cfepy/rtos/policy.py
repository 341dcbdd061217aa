"""What a policy is: it decides which task runs next, where there is a choice. The policies are in `policies`.

Without a policy the kernel goes on with the running task, or takes the one that has been ready for longest (fifo). A
policy is asked at every scheduling point of an `ExploringKernel` that has more than one candidate, and each `Question`
that is open, such as how long a connection between two nodes takes: these decisions, counted from 0, are what a
schedule is made of.
Giving the same answers again gives the same run.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from cfepy.rtos.task import Task

Settings = tuple[bool, int, int, str]
"""What the kernel reads of a policy besides its answers; see the arguments of `Policy`."""
HOLD = "hold"  # in place of a task's name: no task runs until the next timer


class Question(NamedTuple):
    """Something other than who runs that is open to the schedule: how long a connection takes, whether a fault strikes.

    Attributes:
        name: what it is called in moves and reports.
        kind: what another answer than the first is counted as, such as "slow connection".
        answers: those that there are, in words; the first one is as without a policy.
        told: what an answer makes of it, in words, with {} for the answer.
        is_rare: whether it is asked again and again, and seldom has another answer than the first.
    """

    name: str
    kind: str
    answers: tuple[str, ...]
    told: str
    is_rare: bool = False


@dataclass(slots=True)
class Decision:
    """What a policy is asked.

    Attributes:
        number: how many decisions there were before it in the run.
        now: virtual time in ns.
        tasks: those that could run, the one that fifo would take first.
        running: whether `tasks[0]` is the running task, which could go on: another answer than 0 preempts it.
        hold: whether there is one more answer, `len(tasks)`: the running task is held up until the next timer is due.
        left: the task that gave up its turn just now, as it yields or used the CPU for a whole time slice, or None.
        question: not who runs is asked, but this; None for all other decisions, and `tasks` are empty when there is
            one.
    """

    number: int
    now: int
    tasks: Sequence[Task]
    running: bool
    hold: bool
    left: Task | None
    question: Question | None = None

    @property
    def width(self) -> int:
        """The number of possible answers, 2 or more; 1 where a policy (`From`) leaves no choice."""
        return len(self.tasks) + self.hold if self.question is None else len(self.question.answers)

    @property
    def subject(self) -> str:
        """What it is about: the task that fifo would run, or the question."""
        return self.tasks[0].name if self.question is None else self.question.name

    @property
    def answers(self) -> list[str]:
        """The possible answers in words: tasks by name, `HOLD`, or those of the question, such as 25ms."""
        if self.question is not None:
            return list(self.question.answers)
        return [*(task.name for task in self.tasks), *([HOLD] if self.hold else [])]

    @property
    def alias(self) -> str:
        """As `subject`, by the name that a task has in moves."""
        return self.tasks[0].alias if self.question is None else self.question.name

    @property
    def alias_answers(self) -> list[str]:
        """As `answers`, tasks by their names in moves."""
        if self.question is not None:
            return list(self.question.answers)
        return [*(task.alias for task in self.tasks), *([HOLD] if self.hold else [])]


class Policy:
    """Goes on as fifo would; the base of the others.

    Args:
        any_priority: candidates are all ready tasks, not only those of the most urgent priority.
        hold_ns: a task may be held up until the next timer is due, if that is within so many ns; 0 for never.
        connect_ns: a connection between two nodes may take up to so many ns; 0 leaves it as the mission has it.
        points: where mission code lets others in besides calls (`cfepy.schedules.preemption_points`); empty for
            nowhere.
    """

    def __init__(self, any_priority: bool = False, hold_ns: int = 0, connect_ns: int = 0, points: str = "") -> None:
        self.any_priority = any_priority
        self.hold_ns = hold_ns
        self.connect_ns = connect_ns
        self.points = points

    @property
    def settings(self) -> Settings:
        """The arguments of this class, for a policy that asks this one."""
        return self.any_priority, self.hold_ns, self.connect_ns, self.points

    def choose(self, decision: Decision) -> int:
        """The answer, from 0 to below `decision.width`."""
        return 0

    @property
    def missed(self) -> tuple[str, ...]:
        """What of its schedule was not possible in the run until now, as text."""
        return ()

    @property
    def notes(self) -> tuple[str, ...]:
        """What the user of a run should know of its schedule when the run is over."""
        return ()


class AskingPolicy(Policy):
    """Answers as another policy does; the base of those that look on, or overrule it.

    Args:
        inner: the other one, whose options it has.
    """

    def __init__(self, inner: Policy) -> None:
        super().__init__(*inner.settings)
        self._inner = inner

    def choose(self, decision: Decision) -> int:
        return self._inner.choose(decision)

    @property
    def missed(self) -> tuple[str, ...]:
        return self._inner.missed

    @property
    def notes(self) -> tuple[str, ...]:
        return self._inner.notes


class Moment(NamedTuple):
    """A decision that was not fifo's.

    Attributes:
        decision: its number.
        choice: the answer.
        now: virtual ns.
        instead_of: name of the task that fifo would have run, or of the question.
        chosen: name of the task that ran, or `HOLD`, or the answer.
        preemption: whether the one that fifo would have run was running, and could have gone on.
        question: the kind of the question that it answers; empty for a change of turns.
    """

    decision: int
    choice: int
    now: int
    instead_of: str
    chosen: str
    preemption: bool
    question: str = ""

    @classmethod
    def of(cls, decision: Decision, choice: int) -> Moment:
        """What a decision and its answer were, which is not 0."""
        chosen = decision.answers[choice]
        question = "" if decision.question is None else decision.question.kind
        return cls(decision.number, choice, decision.now, decision.subject, chosen, decision.running, question)


class NotingPolicy(AskingPolicy):
    """Asks another policy, and keeps what was decided.

    Args:
        inner: the policy that decides; None is fifo.

    Attributes:
        choices: the answers, in order.
        widths: how many answers each decision had.
        running: for each decision, whether the running task could have gone on.
        moments: the decisions that were not fifo's.
    """

    def __init__(self, inner: Policy | None = None) -> None:
        super().__init__(inner or Policy())
        self.choices: list[int] = []
        self.widths: list[int] = []
        self.running: list[bool] = []
        self.moments: list[Moment] = []

    def choose(self, decision: Decision) -> int:
        choice = self._inner.choose(decision)
        if choice:
            self.moments.append(Moment.of(decision, choice))
        self.choices.append(choice)
        self.widths.append(decision.width)
        self.running.append(decision.running)
        return choice

    @property
    def deviations(self) -> dict[int, int]:
        """The answers that were not fifo's, by number of the decision: with `Deviations` they give the run again."""
        return {moment.decision: moment.choice for moment in self.moments}

    @property
    def decisions(self) -> int:
        """How many there were that left a choice."""
        return sum(width > 1 for width in self.widths)

    @property
    def preemptions(self) -> int:
        """How many of the deviations took the CPU from a task that could have gone on."""
        return sum(moment.preemption for moment in self.moments)

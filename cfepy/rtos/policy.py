"""The interface of scheduling policies, which decide which task runs next. The policies themselves are in `policies`.

Without a policy the kernel continues with the running task, or takes the task that has been ready longest (fifo). An
`ExploringKernel` asks its policy at every scheduling point with more than one candidate, and for each open `Question`,
such as the delay of a connection between two nodes. These decisions, counted from 0, form a schedule. The same answers
give the same run.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from cfepy.rtos.task import Task

Settings = tuple[bool, int, int, str, int]
"""The settings of a policy that the kernel reads; see the arguments of `Policy`."""
HOLD = "hold"  # in place of a task's name: no task runs until the next timer


class Question(NamedTuple):
    """A choice of the schedule other than the next task, such as the delay of a connection or whether a fault occurs.

    Attributes:
        name: its name in deviations and reports.
        kind: the name under which answers other than the first are counted, such as "slow connection".
        answers: the possible answers as text; the first is the one without a policy.
        told: the description of an answer, with {} for the answer.
        is_rare: whether it is asked very often and rarely has another answer than the first.
    """

    name: str
    kind: str
    answers: tuple[str, ...]
    told: str
    is_rare: bool = False


@dataclass(slots=True)
class Decision:
    """A decision that a policy makes.

    Attributes:
        number: number of decisions before it in the run.
        now: virtual time in ns.
        tasks: the candidates; fifo's choice comes first. Empty for a question.
        running: whether `tasks[0]` is the running task and could continue; any answer but 0 then preempts it.
        hold: whether there is one more answer, `len(tasks)`, which holds up `tasks[0]` until the next timer is due: the
            running task, or one that was made ready and begins late.
        left: the task that just gave up its turn, by yielding or by using a whole time slice, or None.
        question: the question to answer; None if the decision is about the next task.
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
        """The number of possible answers, 2 or more; 1 if a policy (`From`) leaves no choice."""
        return len(self.tasks) + self.hold if self.question is None else len(self.question.answers)

    @property
    def subject(self) -> str:
        """The task that fifo would run, or the question."""
        return self.tasks[0].name if self.question is None else self.question.name

    @property
    def answers(self) -> list[str]:
        """The possible answers as text: tasks by name and `HOLD`, or the answers of the question, such as 25ms."""
        if self.question is not None:
            return list(self.question.answers)
        return [*(task.name for task in self.tasks), *([HOLD] if self.hold else [])]

    @property
    def alias(self) -> str:
        """`subject`, with the name that the task has in deviations."""
        return self.tasks[0].alias if self.question is None else self.question.name

    @property
    def alias_answers(self) -> list[str]:
        """`answers`, with the names that the tasks have in deviations."""
        if self.question is not None:
            return list(self.question.answers)
        return [*(task.alias for task in self.tasks), *([HOLD] if self.hold else [])]


class Policy:
    """Continues as fifo would; the base class of policies.

    Args:
        any_priority: whether all ready tasks are candidates, not only those of the most urgent priority.
        hold_ns: a task may be held up until the next timer is due, if that is within this time in ns; 0 for never.
        connect_ns: longest delay of a connection between two nodes in ns; 0 keeps the mission's value.
        points: places besides calls where mission code can be preempted (`cfepy.schedules.preemption_points`); empty
            for none.
        late_ns: a task that was made ready may begin late, after the next timer, if that is within this time in ns; 0
            for never.
    """

    def __init__(
        self,
        any_priority: bool = False,
        hold_ns: int = 0,
        connect_ns: int = 0,
        points: str = "",
        late_ns: int = 0,
    ) -> None:
        self.any_priority = any_priority
        self.hold_ns = hold_ns
        self.connect_ns = connect_ns
        self.points = points
        self.late_ns = late_ns

    @property
    def settings(self) -> Settings:
        """The arguments of this class, for a policy that wraps this one."""
        return self.any_priority, self.hold_ns, self.connect_ns, self.points, self.late_ns

    def choose(self, decision: Decision) -> int:
        """Return the answer, from 0 to below `decision.width`."""
        return 0

    @property
    def missed(self) -> tuple[str, ...]:
        """The parts of its schedule that were not possible in the run so far, as text."""
        return ()

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes about its schedule for the user, after the run."""
        return ()


def missed_notes(parts: str, count: int, missed: Sequence[str]) -> tuple[str, ...]:
    """Return the notes about a schedule whose parts were not all possible; empty if they were.

    Args:
        parts: the name of its parts, such as "moves".
        count: number of all parts.
        missed: the parts that were not possible, as text.
    """
    if not missed:
        return ()
    made = f"{count - len(missed)} of {count} {parts} of the schedule were possible"
    return (f"{made}; not possible: {', '.join(missed)}",)


class AskingPolicy(Policy):
    """Answers as another policy does; the base class of policies that observe or overrule another one.

    Args:
        inner: the other policy, whose options it takes.
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
    """A decision that differs from fifo.

    Attributes:
        decision: its number.
        choice: the answer.
        now: virtual time in ns.
        instead_of: name of the task that fifo would have run, or of the question.
        chosen: name of the task that ran, or `HOLD`, or the answer.
        preemption: whether the task that fifo would have run was running and could have continued.
        question: kind of the question that it answers; empty for a choice of the next task.
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
        """Create the record of a decision and its answer, which is not 0."""
        chosen = decision.answers[choice]
        question = "" if decision.question is None else decision.question.kind
        return cls(decision.number, choice, decision.now, decision.subject, chosen, decision.running, question)


class NotingPolicy(AskingPolicy):
    """Asks another policy and records its decisions.

    Args:
        inner: the policy that decides; None is fifo.

    Attributes:
        choices: the answers, in order.
        widths: the number of possible answers of each decision.
        running: for each decision, whether the running task could have continued.
        moments: the decisions that differ from fifo.
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
        """The answers that differ from fifo, by decision number; `Deviations` repeats the run with them."""
        return {moment.decision: moment.choice for moment in self.moments}

    @property
    def decisions(self) -> int:
        """The number of decisions with a choice."""
        return sum(width > 1 for width in self.widths)

    @property
    def preemptions(self) -> int:
        """The number of deviations that took the CPU from a task that could have continued."""
        return sum(moment.preemption for moment in self.moments)

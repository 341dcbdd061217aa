"""Scheduling policies: seeded random, PCT, deviations from fifo, a given order, and policies that restrict another one.

A run without a schedule of its own needs none of them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from random import Random
from typing import Any

from cfepy.rtos.policy import AskingPolicy, Decision, Policy, Question, missed_notes
from cfepy.rtos.task import Task
from cfepy.rtos.task_starters import StartersFirst

LATE_ODDS = 4  # the same for a task that was made ready, which happens less often
HOLD_ODDS = 16  # take one in this many chances to hold a task up; otherwise time would pass faster than the work
STAY_ODDS = (0.0, 0.5, 0.7)  # probabilities that the running task continues, with preemption points between calls
STARTERS_ODDS = 3 / 4  # share of the schedules in which a task that starts others continues before them


class SeededRandom(Policy):
    """Chooses any candidate at random, always the same ones for the same seed. The other arguments are those of
    `Policy`.

    With preemption points between calls, a run has very many decisions, and a task would hardly advance while another
    one waits. So the running task continues with a probability drawn from the seed: some schedules have long stretches
    of one task, others short ones. In a long stretch, the tasks that it starts would meet no other task. So it usually
    starts all of them first.
    """

    def __init__(
        self,
        seed: int,
        any_priority: bool = False,
        hold_ns: int = 0,
        connect_ns: int = 0,
        points: str = "",
        late_ns: int = 0,
    ) -> None:
        super().__init__(any_priority, hold_ns, connect_ns, points, late_ns)
        random = Random(seed)
        self._random = random.random
        self._seldom = Seldom(self._random)
        self._stay = random.choice(STAY_ODDS) if points else 0.0
        self._starters = StartersFirst() if self._stay and random.random() < STARTERS_ODDS else None

    def choose(self, decision: Decision) -> int:
        if decision.question is not None and decision.question.is_rare:
            return self._seldom.choose(decision.question)
        width = decision.width - decision.hold
        if decision.hold and self._random() * (HOLD_ODDS if decision.running else LATE_ODDS) < 1:
            return width
        if self._stay and decision.question is None:
            return self._going_on(decision)
        return int(self._random() * width)

    def _going_on(self, decision: Decision) -> int:
        """Return the running task if it continues, otherwise any candidate."""
        tasks = decision.tasks
        if self._starters is not None:
            if decision.left is not None:
                self._starters.polls(decision.left)
            tasks = self._starters.free(tasks)
        if decision.running and tasks[0] is decision.tasks[0] and self._random() < self._stay:
            return 0
        return decision.tasks.index(tasks[int(self._random() * len(tasks))])


class Seldom:
    """Draws when a frequent question gets its second answer.

    The number of questions is unknown. So the number of the question is drawn from 1 to `MOST`, with every power of two
    equally likely. Early and late occasions both have a chance.
    """

    MOST = 1024

    def __init__(self, random: Callable[[], float]) -> None:
        self._random = random
        self._left: dict[str, int] = {}

    def choose(self, question: Question) -> int:
        """Return the answer, 0 or 1."""
        left = self._left.get(question.name)
        if left is None:
            left = int(self.MOST ** self._random()) - 1
        self._left[question.name] = left - 1
        if left:
            return 0
        del self._left[question.name]
        return 1


class PCT(Policy):
    """Probabilistic concurrency testing (Burckhardt, Kothari, Musuvathi, Nagarakatte: ASPLOS 2010).

    Every task draws a rank, and the candidate with the highest rank runs. At `depth - 1` of `steps` decisions, drawn in
    advance, the task that would run drops below all others. In half of the cases where it can be held up, it is held up
    instead. A bug that needs `depth` ordered events is found with a probability of at least 1 / (tasks * steps **
    (depth - 1)). A task that gives up its turn drops below all others too, such as a polling task at the end of each
    slice. The paper's guarantee assumes that no task waits for another by polling.

    Questions have no rank: each draws its answer.

    Args:
        seed: seed of the ranks and the decisions.
        depth: depth of the bugs to find, at least 1.
        steps: approximate number of decisions of a run.
        any_priority: see `Policy`.
        hold_ns: see `Policy`.
        connect_ns: see `Policy`.
        points: see `Policy`.
        late_ns: see `Policy`.
    """

    def __init__(
        self,
        seed: int,
        depth: int,
        steps: int,
        any_priority: bool = False,
        hold_ns: int = 0,
        connect_ns: int = 0,
        points: str = "",
        late_ns: int = 0,
    ) -> None:
        super().__init__(any_priority, hold_ns, connect_ns, points, late_ns)
        self._random = random = Random(seed)
        self._changes = frozenset(random.sample(range(steps), min(depth - 1, steps)))
        self._ranks: dict[Task, float] = {}
        self._lowest = 0
        self._count = -1
        self._seldom = Seldom(random.random)

    def choose(self, decision: Decision) -> int:
        self._count += 1
        if decision.question is not None:
            if decision.question.is_rare:
                return self._seldom.choose(decision.question)
            return int(self._random.random() * decision.width)
        if decision.left is not None:
            self._demote(decision.left)
        best = self._best(decision.tasks)
        if self._count in self._changes:
            if decision.hold and self._random.random() < 0.5:
                return len(decision.tasks)
            self._demote(decision.tasks[best])
            best = self._best(decision.tasks)
        return best

    def _best(self, tasks: Sequence[Task]) -> int:
        ranks = self._ranks
        for task in tasks:
            if task not in ranks:
                ranks[task] = self._random.random()
        return max(range(len(tasks)), key=lambda index: ranks[tasks[index]])

    def _demote(self, task: Task) -> None:
        self._lowest -= 1
        self._ranks[task] = self._lowest


class Deviations(Policy):
    """Fifo, except for some decisions.

    Args:
        choices: the answer for each decision number; an impossible answer becomes the last possible one.
        any_priority: see `Policy`.
        hold_ns: see `Policy`.
        connect_ns: see `Policy`.
        points: see `Policy`.
        late_ns: see `Policy`.
    """

    def __init__(
        self,
        choices: Mapping[int, int],
        any_priority: bool = False,
        hold_ns: int = 0,
        connect_ns: int = 0,
        points: str = "",
        late_ns: int = 0,
    ) -> None:
        super().__init__(any_priority, hold_ns, connect_ns, points, late_ns)
        self._count = len(choices)
        self._left = dict(choices)

    def choose(self, decision: Decision) -> int:
        return min(self._left.pop(decision.number, 0), decision.width - 1)

    @property
    def missed(self) -> tuple[str, ...]:
        """The deviations at decisions that did not come."""
        return tuple(f"{number}={choice}" for number, choice in self._left.items())

    @property
    def notes(self) -> tuple[str, ...]:
        return missed_notes("deviations", self._count, self.missed)


class InOrder(Policy):
    """Runs tasks in a given order as far as possible, then continues as fifo.

    Args:
        runs: pairs of a task's path and a number: the task runs until its `Task.passed` reaches the number.
        settings: the settings of `Policy`.
    """

    def __init__(self, runs: Iterable[tuple[str, int]], *settings: Any) -> None:
        super().__init__(*settings)
        self._runs = list(runs)

    def choose(self, decision: Decision) -> int:
        """Choose the next task of the order; a task that cannot run now keeps its turns for later."""
        candidates = {task.path: (at, task) for at, task in enumerate(decision.tasks)}
        runs = self._runs
        for place, (path, number) in enumerate(runs):
            if path in candidates:
                at, task = candidates[path]
                if task.passed < number:
                    return at
                runs[place] = "", 0
        self._runs = [run for run in runs if run[0]]
        return 0


class From(AskingPolicy):
    """Fifo until a given time, then another policy.

    Args:
        inner: the other policy.
        from_ns: the virtual time, in ns.
    """

    def __init__(self, inner: Policy, from_ns: int) -> None:
        super().__init__(inner)
        self._from_ns = from_ns

    def choose(self, decision: Decision) -> int:
        if decision.now >= self._from_ns:
            return self._inner.choose(decision)
        decision.tasks, decision.hold = decision.tasks[:1], False
        if decision.question is not None:
            decision.question = decision.question._replace(answers=decision.question.answers[:1])
        return 0


class Fair(AskingPolicy):
    """Another policy, with a limit on how often a task is passed over.

    Args:
        inner: the other policy.
        most: number of consecutive decisions in which a candidate may be passed over; then it runs. Of several such
            tasks, the one passed over most often runs.
    """

    def __init__(self, inner: Policy, most: int) -> None:
        super().__init__(inner)
        self._most = most
        self._passed: dict[Task, int] = {}

    def choose(self, decision: Decision) -> int:
        choice = self._inner.choose(decision)
        if decision.question is not None:
            return choice
        passed, tasks = self._passed, decision.tasks
        longest = max(range(len(tasks)), key=lambda index: passed.get(tasks[index], 0))
        if passed.get(tasks[longest], 0) >= self._most:
            choice = longest
        for index, task in enumerate(tasks):
            passed[task] = 0 if index == choice else passed.get(task, 0) + 1
        return choice

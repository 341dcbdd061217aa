"""The policies that schedules are made of: by a seed, PCT, deviations from fifo, an order, and what limits another one.

A run without a schedule of its own needs none of them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from random import Random
from typing import Any

from cfepy.rtos.policy import AskingPolicy, Decision, Policy, Question
from cfepy.rtos.task import Task
from cfepy.rtos.task_starters import StartersFirst

HOLD_ODDS = 16  # one in so many chances to hold a task up is taken: time would else run away from the work
STAY_ODDS = (0.0, 0.5, 0.7)  # that the running task stays, where there are points between calls
STARTERS_ODDS = 3 / 4  # of schedules in which who starts a task goes on before that


class SeededRandom(Policy):
    """Any of the candidates, the same ones for the same seed; the other arguments are those of `Policy`.

    With points between calls a run has so many decisions that no task would come far while another one waits. The
    running task then stays as often as the seed draws it, so that some schedules have long stretches and some have
    short ones. As those it starts would find nobody in a long stretch, it mostly starts all of them before.
    """

    def __init__(
        self, seed: int, any_priority: bool = False, hold_ns: int = 0, connect_ns: int = 0, points: str = ""
    ) -> None:
        super().__init__(any_priority, hold_ns, connect_ns, points)
        random = Random(seed)
        self._random = random.random
        self._seldom = Seldom(self._random)
        self._stay = random.choice(STAY_ODDS) if points else 0.0
        self._starters = StartersFirst() if self._stay and random.random() < STARTERS_ODDS else None

    def choose(self, decision: Decision) -> int:
        if decision.question is not None and decision.question.is_rare:
            return self._seldom.choose(decision.question)
        width = decision.width - decision.hold
        if decision.hold and self._random() * HOLD_ODDS < 1:
            return width
        if self._stay and decision.question is None:
            return self._going_on(decision)
        return int(self._random() * width)

    def _going_on(self, decision: Decision) -> int:
        """The running task where it stays, or any."""
        tasks = decision.tasks
        if self._starters is not None:
            if decision.left is not None:
                self._starters.polls(decision.left)
            tasks = self._starters.free(tasks)
        if decision.running and tasks[0] is decision.tasks[0] and self._random() < self._stay:
            return 0
        return decision.tasks.index(tasks[int(self._random() * len(tasks))])


class Seldom:
    """Draws when a question that is asked again and again has its second answer.

    How often it will be asked is not known. So the number is drawn from 1 to `MOST`, any power of two being as likely
    as the next: early and late occasions both have their chance.
    """

    MOST = 1024

    def __init__(self, random: Callable[[], float]) -> None:
        self._random = random
        self._left: dict[str, int] = {}

    def choose(self, question: Question) -> int:
        """The answer, 0 or 1."""
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

    Every task draws a rank; of the candidates the one of highest rank runs. At `depth - 1` of `steps` decisions, drawn
    beforehand, the task that would run falls below all others (or, where it can be, is held up instead, half of the
    times). A bug that needs `depth` ordered events is found with a probability of at least 1 / (tasks * steps **
    (depth - 1)). A task that gives up its turn, as one that polls does at the end of each slice, falls below all
    others too: the paper's guarantee assumes that no task waits for another by polling.

    Questions are no tasks: each draws its answer.

    Args:
        seed: of ranks and places.
        depth: of the bugs that are looked for, at least 1.
        steps: how many decisions a run has, about.
        any_priority: see `Policy`.
        hold_ns: see `Policy`.
        connect_ns: see `Policy`.
        points: see `Policy`.
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
    ) -> None:
        super().__init__(any_priority, hold_ns, connect_ns, points)
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
    """Fifo but for some decisions.

    Args:
        choices: the answer by number of the decision; one that is not possible becomes the last that is.
        any_priority: see `Policy`.
        hold_ns: see `Policy`.
        connect_ns: see `Policy`.
        points: see `Policy`.
    """

    def __init__(
        self,
        choices: Mapping[int, int],
        any_priority: bool = False,
        hold_ns: int = 0,
        connect_ns: int = 0,
        points: str = "",
    ) -> None:
        super().__init__(any_priority, hold_ns, connect_ns, points)
        self._choices = dict(choices)

    def choose(self, decision: Decision) -> int:
        return min(self._choices.get(decision.number, 0), decision.width - 1)


class InOrder(Policy):
    """Lets tasks run in a given order, as far as that is possible, and goes on as fifo then.

    Args:
        runs: pairs of a task's path and a number: that task runs until it has passed so many places (`Task.passed`).
        settings: those of the policy.
    """

    def __init__(self, runs: Iterable[tuple[str, int]], *settings: Any) -> None:
        super().__init__(*settings)
        self._runs = list(runs)

    def choose(self, decision: Decision) -> int:
        """A task that cannot run now keeps its turns for later."""
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
    """Fifo up to an instant, then another policy.

    Args:
        inner: the other one.
        from_ns: the instant, in virtual ns.
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
    """Another policy, but nobody is passed over for ever.

    Args:
        inner: the other one.
        most: decisions in which a task may be among the candidates and not run, one after the other; then it runs, of
            several the one that was passed over most often.
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

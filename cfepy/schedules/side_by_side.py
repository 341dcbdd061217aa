"""A policy that runs tasks side by side, all or a few of them, so that simultaneous actions of similar tasks collide.

Random choices bring many tasks to many different places, and PCT runs one task until a change. Under both it is rare
that six tasks have each done exactly one step, or that only the first and the last of twenty tasks overlap.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Sequence
from random import Random
from types import CodeType, FrameType

from cfepy.interpreter.own_code import is_own_code
from cfepy.rtos import HOLD_ODDS, STARTERS_ODDS, Decision, Policy, Seldom, StartersFirst, Task

GROUPS = (2, 2, 3, 0, 0, 0)  # number of tasks that take part; 0 for all
STRAY_ODDS = 2 / 3  # share of groups whose tasks take turns at random, not in order
MIX_ODDS = 1 / 2  # share of schedules whose groups put tasks with the same code after a task with different code
LOOKS = 3  # turns within which a task may reach the mission's own code, which identifies its work
SPREADS = (0, 0, 2, 6)  # turns by which a task may be later than the others


class Abreast(Policy):
    """Lets tasks take turns; the one with the fewest turns comes first, and the seed decides between equals.

    The seed draws further properties. A task that starts others may continue before them until it waits. All candidates
    take part, or only the first two or three of an order; the others run while these wait. These few take turns or run
    at random, and may have to run different code, such as a reader and one of many writers. Tasks may be later than
    similar ones by some turns. A task that uses the CPU for a whole time slice without starting another task, as a
    polling task does, goes to the end of the order.

    Args:
        seed: seed of all that is drawn.
        any_priority: see `Policy`.
        hold_ns: see `Policy`.
        connect_ns: see `Policy`.
        points: see `Policy`.
        late_ns: see `Policy`.
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
        self._random = random = Random(seed)
        self._seldom = Seldom(random.random)
        self._starters_first = random.random() < STARTERS_ODDS
        self._group = random.choice(GROUPS)
        self._strays = bool(self._group) and random.random() < STRAY_ODDS
        self._is_mixed = bool(self._group) and random.random() < MIX_ODDS
        self._spread = random.choice(SPREADS)
        self._code: dict[Task, CodeType | None] = {}  # the function of the mission's own code that a task executes
        self._looks: dict[Task, int] = {}
        self._turns: dict[Task, int] = {}
        self._ranks: dict[Task, float] = {}
        self._before: Sequence[Task] = ()
        self._lowest = 0
        self._starters = StartersFirst()

    def choose(self, decision: Decision) -> int:
        random = self._random.random
        if decision.question is not None:
            if decision.question.is_rare:
                return self._seldom.choose(decision.question)
            return int(random() * decision.width)
        if decision.hold and random() * HOLD_ODDS < 1:
            return len(decision.tasks)
        if decision.left is not None and self._starters.polls(decision.left):
            self._lowest -= 1
            self._ranks[decision.left] = self._lowest
        self._meet(decision.tasks)
        tasks = self._starters.free(decision.tasks) if self._starters_first else decision.tasks
        if self._is_mixed:
            if decision.running:
                self._look(decision.tasks[0], sys._getframe(1))
            tasks = [task for task in tasks if self._looks.get(task, 0) < LOOKS] or tasks
        tasks = self._of_group(tasks)
        if not self._strays:
            least = min(self._turns[task] for task in tasks)
            tasks = [task for task in tasks if self._turns[task] == least]
        chosen = tasks[int(random() * len(tasks))]
        self._turns[chosen] += chosen.started  # starting does not count as a turn
        return decision.tasks.index(chosen)

    def _meet(self, tasks: Sequence[Task]) -> None:
        """Give a task that is new or has waited at least as many turns as the others."""
        turns = self._turns
        known = [turns[task] for task in tasks if task in self._before] or [
            turns[task] for task in tasks if task in turns
        ]
        least = min(known, default=0)
        for task in tasks:
            if task not in turns:
                turns[task] = least + int(self._random.random() * (self._spread + 1))
                self._ranks.setdefault(task, self._random.random())
            elif task not in self._before:
                turns[task] = max(turns[task], least)
        self._before = tasks

    def _look(self, task: Task, frame: FrameType | None) -> None:
        """Determine the code of the running task, unless it is known or was looked for often enough."""
        looks = self._looks.get(task, 0)
        if looks < LOOKS:
            self._code[task] = code = _outermost_code(frame)
            self._looks[task] = LOOKS if code is not None else looks + 1

    def _of_group(self, tasks: Sequence[Task]) -> Sequence[Task]:
        if not self._group or self._group >= len(tasks):
            return tasks
        in_order = sorted(tasks, key=lambda task: -self._ranks[task])
        if self._is_mixed:
            equals = Counter[CodeType | None]()
            places: dict[Task, int] = {}
            for task in in_order:
                code = self._code.get(task)
                places[task] = equals[code] if self._ranks[task] >= 0 else len(in_order)
                equals[code] += 1
            in_order.sort(key=places.__getitem__)
        return in_order[: self._group]


def _outermost_code(frame: FrameType | None) -> CodeType | None:
    """Return the outermost function of the mission's own code in a task; None if there is none."""
    found = None
    while frame is not None:
        if is_own_code(frame.f_code.co_filename):
            found = frame.f_code
        frame = frame.f_back
    return found

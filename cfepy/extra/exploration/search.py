"""The choice of schedules: from seeds, one policy after the other, or systematically.

A search gives the same schedules in the same order for any number of processes. The systematic search lets the depth
grow by one deviation from fifo at a time. Every schedule is a list of deviations. Its children deviate once more, after
its last deviation, so no schedule comes twice. The number of choices of a decision is only known from a run, so the
next schedules are made from each run. The search bounds preemptions and not steps, which is the idea of CHESS
(Musuvathi, Qadeer: PLDI 2007).
"""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Iterator, Sequence
from dataclasses import replace

from cfepy.extra.exploration.missing_points import OpenPlaces
from cfepy.extra.exploration.partial_orders import OrderSearch
from cfepy.extra.exploration.schedule_kinds import NOTHING_FOUND, ScheduleKind, in_turn, seeded_kinds
from cfepy.extra.exploration.switch_kinds import SwitchKinds
from cfepy.extra.exploration.verdict import Verdict
from cfepy.mission import CORE_APPS
from cfepy.schedules import Schedule

SEEDED_POLICIES = ("all", "random", "pct", "abreast")
POLICIES = (*SEEDED_POLICIES, "dfs", "orders")
DFS_DEPTH = 2
TURNS = 5  # turns of each policy in a generation of a search for new switches


class SeededSearch:
    """Schedules from seeds, each with its own seed: of one kind, or of several in rounds.

    PCT needs an estimate of the number of decisions of a run. Fifo interrupts no task, so it has far fewer decisions
    than other schedules. So the search waits for the verdict on the first schedule, and uses its number.

    Args:
        kinds: the kinds of schedules.
        first_seed: of the first one.
    """

    def __init__(self, kinds: tuple[ScheduleKind, ...], first_seed: int = 0) -> None:
        self._kinds = tuple(each.schedule for each in kinds)
        self._round = in_turn([each.turns for each in kinds])
        self._number = 0
        self._first_seed = first_seed
        self._is_measured = False

    def next(self) -> Schedule | None:
        """Return the next schedule; see `cfepy.extra.exploration.campaign.Search`. It never ends."""
        number = self._number
        turn = self._turn(number)
        if turn is None or (number and self._kinds[turn].kind == "pct" and not self._is_measured):
            return None
        self._number += 1
        return self._kinds[turn].with_seed(self._first_seed + number)

    def _turn(self, number: int) -> int | None:
        """Return which kind a schedule has, by its number; None if earlier verdicts must come first."""
        return self._round[number % len(self._round)]

    def tell(self, number: int, verdict: Verdict) -> None:
        """Learn the length of a run from the first verdict; see `cfepy.extra.exploration.campaign.Search`."""
        if number == 0:
            self.reckon_with(verdict.decisions)

    def reckon_with(self, decisions: int) -> None:
        """Let PCT expect this number of decisions of a run, or more."""
        self._is_measured = True
        self._kinds = tuple(
            replace(each, steps=max(each.steps, decisions)) if each.kind == "pct" else each for each in self._kinds
        )


class NewSwitchSearch(SeededSearch):
    """Schedules from seeds, more of the kinds that have lately brought new switches.

    The shares of a generation follow from the verdicts up to the generation before the last one. So processes need not
    wait for each other, and their number does not change the schedules.

    Args:
        kinds: the kinds of schedules.
        first_seed: of the first one.

    Attributes:
        switches: the kinds so far.
    """

    def __init__(self, kinds: tuple[ScheduleKind, ...], first_seed: int = 0) -> None:
        super().__init__(kinds, first_seed)
        self.switches = SwitchKinds()
        self._size = TURNS * len(kinds)
        self._turns = list(range(len(kinds))) * TURNS * 2
        self._lately: list[tuple[Counter[int], Counter[int]]] = [(Counter(), Counter())]  # by generation: new, flown

    def _turn(self, number: int) -> int | None:
        generation = number // self._size
        if number == len(self._turns):
            if self.switches.done < (generation - 1) * self._size:
                return None
            self._turns += shares(*self._lately[generation - 2], len(self._kinds), self._size)
        return self._turns[number]

    def tell(self, number: int, verdict: Verdict) -> None:
        super().tell(number, verdict)
        new, flown = self._lately[-1]
        new[self._turns[number]] += self.switches.take(verdict)
        flown[self._turns[number]] += 1
        if self.switches.done % self._size == 0:
            self._lately.append((Counter(), Counter()))


def shares(new: Counter[int], flown: Counter[int], kinds: int, size: int) -> list[int]:
    """Return the turns of a generation: one for each kind, and the others by the new switches of its schedules.

    Args:
        new: new kinds of switches, by kind of schedule.
        flown: schedules, by kind.
        kinds: number of kinds.
        size: number of turns, at least one for each kind.
    """
    worth = [(new[kind] + 1) / (flown[kind] + 1) for kind in range(kinds)]
    left = [(size - kinds) * each / sum(worth) for each in worth]
    counts = [1 + int(each) for each in left]
    by_rest = sorted(range(kinds), key=lambda kind: (int(left[kind]) - left[kind], kind))
    for kind in by_rest[: size - sum(counts)]:
        counts[kind] += 1
    return in_turn(counts)


class SystematicSearch:
    """All schedules with few deviations from fifo, fewest first.

    Args:
        depth: the most preemptions, and the most other changes of order.
        options: a schedule with the options that all schedules have.
    """

    def __init__(self, depth: int, options: Schedule) -> None:
        self._tree = DepthFirst(depth, depth, options)

    def next(self) -> Schedule | None:
        return self._tree.next()

    def tell(self, number: int, verdict: Verdict) -> None:
        widths = [abs(width) for width in verdict.widths]
        self._tree.learn(verdict.schedule, widths, [width < 0 for width in verdict.widths])


AnySearch = SeededSearch | SystematicSearch | OrderSearch


def make_search(
    policy: str,
    depth: int | None,
    steps: int,
    options: Schedule,
    first_seed: int = 0,
    tick_ns: int = 0,
    *,
    holds: bool = True,
    new_switches: bool = False,
    openings: OpenPlaces = NOTHING_FOUND,
) -> AnySearch:
    """Return the search for the options of a command.

    Args:
        policy: one of POLICIES.
        depth: of the bugs that PCT looks for, and the most preemptions of a systematic search; None takes 3 and 2, and
            for `all` PCT of depths 1 to 3, with points of 3 alone. For a search of orders it is the number of steps
            that may come in another order.
        steps: decisions of a run, at least, from the reference run.
        options: a schedule with the options that all schedules have.
        first_seed: of the first schedule.
        tick_ns: of the board's clock; 0 for none.
        holds: in `all`, running tasks may also be delayed in some schedules if `options` do not set a delay.
        new_switches: prefer the policies that bring new kinds of switches.
        openings: of the mission; in `all`, some schedules have points at its shared data, and any priority.
    """
    if policy == "dfs":
        return SystematicSearch(DFS_DEPTH if depth is None else depth, options)
    if policy == "orders":
        return OrderSearch(options, CORE_APPS, depth)
    kinds = seeded_kinds(policy, depth, steps, options, tick_ns, holds=holds, openings=openings)
    return NewSwitchSearch(kinds, first_seed) if new_switches else SeededSearch(kinds, first_seed)


class DepthFirst:
    """All schedules with a limited number of deviations, fewest first.

    Args:
        preemptions: the most times in a run that a task that could continue is preempted or delayed.
        reorderings: the most times in a run that another waiting task than the first one continues.
        options: a schedule with the options (`any`, `hold`) that all schedules have.
    """

    def __init__(self, preemptions: int = 2, reorderings: int = 2, options: Schedule | None = None) -> None:
        self._preemptions = preemptions
        self._reorderings = reorderings
        self._first: Schedule | None = (options or Schedule()).at({})
        self._open: deque[Iterator[Schedule]] = deque()
        self._away: dict[Schedule, None] = {}

    @property
    def exhausted(self) -> bool:
        """Whether all schedules have been given out, and all their results are known."""
        return self._first is None and not self._open and not self._away

    def next(self) -> Schedule | None:
        """Return the next schedule; None when all schedules that follow from the known results have been given out."""
        first, self._first = self._first, None
        found = first or self._next_child()
        if found is not None:
            self._away[found] = None
        return found

    def _next_child(self) -> Schedule | None:
        while self._open:
            child = next(self._open[0], None)
            if child is not None:
                return child
            self._open.popleft()
        return None

    def learn(self, schedule: Schedule, widths: Sequence[int], running: Sequence[bool]) -> None:
        """Take the result of a schedule.

        Args:
            schedule: a schedule from `next`.
            widths: of the decisions in the run, as `NotingPolicy` keeps them.
            running: as `NotingPolicy` keeps it.
        """
        del self._away[schedule]
        if schedule.deviations and schedule.deviations[-1][0] >= len(widths):
            return  # the run was aborted, or its process died, before that decision
        preemptions = sum(running[decision] for decision, _ in schedule.deviations)
        reorderings = len(schedule.deviations) - preemptions
        may_preempt = preemptions < self._preemptions
        may_reorder = reorderings < self._reorderings
        if may_preempt or may_reorder:
            self._open.append(_children(schedule, widths, running, may_preempt, may_reorder))


def _children(
    parent: Schedule, widths: Sequence[int], running: Sequence[bool], may_preempt: bool, may_reorder: bool
) -> Iterator[Schedule]:
    """Yield the schedules that deviate once more, later."""
    made = dict(parent.deviations)
    start = parent.deviations[-1][0] + 1 if parent.deviations else 0
    for decision in range(start, len(widths)):
        if may_preempt if running[decision] else may_reorder:
            for choice in range(1, widths[decision]):
                yield parent.at({**made, decision: choice})

"""Which schedules are flown: from seeds, one policy after the other, or systematically, depth first.

A search gives the same schedules in the same order however many processes fly them. The systematic one lets the depth
grow by one deviation from fifo at a time: every schedule is a list of deviations, and its children deviate once more,
after its last deviation; so none comes twice. How many choices a decision has is only known from a run, so the
next schedules are made from each run. Bounding preemptions rather than steps is the idea of CHESS (Musuvathi, Qadeer:
PLDI 2007).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import replace

from cfepy.extra.exploration.partial_orders import OrderSearch
from cfepy.extra.exploration.verdict import Verdict
from cfepy.mission import CORE_APPS
from cfepy.schedules import Schedule

POLICIES = ("all", "random", "pct", "abreast", "dfs", "orders")
PCT_DEPTH, DFS_DEPTH = 3, 2
PORTFOLIO_DEPTHS = (2, 3, 1)
"""Of PCT in the policy `all`: most races need two ordered events, some three, and starvation one."""
PORTFOLIO_HOLD_NS = 1_000_000
"""In the policy `all`, for one schedule in six, with points for two, unless the board's tick is longer: a race with a
timer, or with a more urgent task that waits for one, is seen only when code takes time. More would break what a mission
rightly expects of its own sleeps; less than a tick would reach no timer."""


class SeededSearch:
    """Schedules from seeds, each with one of its own: of one kind, or of several by turns.

    PCT has to know about how many decisions a run has, and fifo, which interrupts no task, has far fewer of them than
    other schedules. So it waits for the verdict on the first schedule, and reckons with as many as that one had.

    Args:
        kinds: schedules whose seed is replaced.
        first_seed: of the first one.
    """

    def __init__(self, kinds: tuple[Schedule, ...], first_seed: int = 0) -> None:
        self._kinds = kinds
        self._number = 0
        self._first_seed = first_seed
        self._is_measured = False

    def next(self) -> Schedule | None:
        """See `cfepy.extra.exploration.campaign.Search`: without end, but for the one wait."""
        number = self._number
        kind = self._kinds[number % len(self._kinds)]
        if number and kind.kind == "pct" and not self._is_measured:
            return None
        self._number += 1
        return kind.with_seed(self._first_seed + number)

    def tell(self, number: int, verdict: Verdict) -> None:
        """See `cfepy.extra.exploration.campaign.Search`: from the first one it learns how long a run is."""
        if number == 0:
            self.reckon_with(verdict.decisions)

    def reckon_with(self, decisions: int) -> None:
        """PCT reckons with so many decisions of a run, or with more."""
        self._is_measured = True
        self._kinds = tuple(
            replace(each, steps=max(each.steps, decisions)) if each.kind == "pct" else each for each in self._kinds
        )


class SystematicSearch:
    """All schedules with few deviations from fifo, those with fewer first.

    Args:
        depth: how many preemptions, and how many other changes of order, there are at most.
        options: a schedule whose options all have.
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
) -> AnySearch:
    """The search that a command asks for.

    Args:
        policy: one of POLICIES.
        depth: of the bugs that PCT looks for, and the most preemptions of a systematic search; None takes 3 and 2,
            and for `all` PCT of depths 1 to 3, with points of 3 alone. Of a search of orders it is how many steps may
            come in another order.
        steps: decisions of a run, at least, as the reference run had them.
        options: a schedule whose options all have.
        first_seed: of the first schedule.
        tick_ns: of the board's clock; 0 for none.
        holds: in `all`, running tasks may also be held up in some schedules if `options` have nothing of it.
    """
    if policy == "dfs":
        return SystematicSearch(DFS_DEPTH if depth is None else depth, options)
    if policy == "orders":
        return OrderSearch(options, CORE_APPS, depth)
    return SeededSearch(seeded_kinds(policy, depth, steps, options, tick_ns, holds=holds), first_seed)


def seeded_kinds(
    policy: str, depth: int | None, steps: int, options: Schedule, tick_ns: int = 0, *, holds: bool = True
) -> tuple[Schedule, ...]:
    """The schedules of a policy that comes from seeds, which take turns; the arguments are those of `make_search`.

    With points between calls there are so many decisions that PCT hits those of a bug rarely: of 13 programs that need
    points random finds 10 more often than PCT of any of these depths, PCT of depth 3 two, and neither finds one in 200.
    So PCT has one turn in six there.
    """
    random, abreast = replace(options, kind="random"), replace(options, kind="abreast")
    is_mixed = policy == "all"
    depths = PORTFOLIO_DEPTHS if depth is None and is_mixed else (PCT_DEPTH if depth is None else depth,)
    pct = tuple(replace(options, kind="pct", depth=each, steps=max(steps, 1)) for each in depths)
    if not is_mixed:
        return {"random": (random,), "pct": pct, "abreast": (abreast,)}[policy]
    held = replace(random, hold_ns=options.hold_ns or max(PORTFOLIO_HOLD_NS, tick_ns))
    if not holds and not options.hold_ns:
        held = random
    if options.points:
        deepest = max(pct, key=lambda each: each.depth)
        return (random, deepest, abreast, held, random, held)
    return (random, pct[0], abreast, *([] if held is random else [held]), *pct[1:])


class DepthFirst:
    """All schedules of at most so many deviations, those with fewer first.

    Args:
        preemptions: how many times a task that could go on is taken off the CPU, or held up, in one run, at most.
        reorderings: how many times another than the first of the waiting tasks goes on, in one run, at most.
        options: a schedule whose options (`any`, `hold`) all have.
    """

    def __init__(self, preemptions: int = 2, reorderings: int = 2, options: Schedule | None = None) -> None:
        self._preemptions = preemptions
        self._reorderings = reorderings
        self._first: Schedule | None = (options or Schedule()).at({})
        self._open: deque[Iterator[Schedule]] = deque()
        self._away: dict[Schedule, None] = {}

    @property
    def exhausted(self) -> bool:
        """Whether all schedules have been given out, and the results of all of them are known."""
        return self._first is None and not self._open and not self._away

    def next(self) -> Schedule | None:
        """The next schedule to run; None when all have been given out, as far as results are known by now."""
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
        """A schedule was run.

        Args:
            schedule: as `next` gave it.
            widths: of the decisions in the run, as `NotingPolicy` keeps them.
            running: as `NotingPolicy` keeps it.
        """
        del self._away[schedule]
        if schedule.deviations and schedule.deviations[-1][0] >= len(widths):
            return  # the run was broken off, or its process died, before it came to that
        preemptions = sum(running[decision] for decision, _ in schedule.deviations)
        reorderings = len(schedule.deviations) - preemptions
        may_preempt = preemptions < self._preemptions
        may_reorder = reorderings < self._reorderings
        if may_preempt or may_reorder:
            self._open.append(_children(schedule, widths, running, may_preempt, may_reorder))


def _children(
    parent: Schedule, widths: Sequence[int], running: Sequence[bool], may_preempt: bool, may_reorder: bool
) -> Iterator[Schedule]:
    """The schedules that deviate once more, later."""
    made = dict(parent.deviations)
    start = parent.deviations[-1][0] + 1 if parent.deviations else 0
    for decision in range(start, len(widths)):
        if may_preempt if running[decision] else may_reorder:
            for choice in range(1, widths[decision]):
                yield parent.at({**made, decision: choice})

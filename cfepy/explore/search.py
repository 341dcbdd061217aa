"""Which schedules are flown: from seeds, one policy after the other, or systematically.

A search gives the same schedules in the same order however many processes fly them. May import cfepy.rtos.
"""

from __future__ import annotations

from dataclasses import replace

from cfepy.explore.verdict import Verdict
from cfepy.rtos.depth_first import DepthFirst
from cfepy.rtos.schedule import Schedule

POLICIES = ("all", "random", "pct", "dfs")
PCT_DEPTH, DFS_DEPTH = 3, 2
PORTFOLIO_DEPTHS = (2, 3, 1)
"""Of PCT in the policy `all`: most races need two ordered events, some three, and starvation one."""
PORTFOLIO_HOLD_NS = 1_000_000
"""In the policy `all`, for one schedule in five: a race with a timer, or with a more urgent task that waits for one, is
seen only when code takes time. More would break what a mission rightly expects of its own sleeps."""


class SeededSearch:
    """Schedules from seeds, each with one of its own: of one kind, or of several by turns.

    PCT has to know about how many decisions a run has, and fifo, which interrupts nobody, has far fewer of them than
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

    def next(self) -> str | None:
        """See `cfepy.explore.campaign.Search`: without end, but for the one wait."""
        number = self._number
        kind = self._kinds[number % len(self._kinds)]
        if number and kind.kind == "pct" and not self._is_measured:
            return None
        self._number += 1
        return kind.with_seed(self._first_seed + number).text()

    def tell(self, number: int, verdict: Verdict) -> None:
        """See `cfepy.explore.campaign.Search`: from the first one it learns how long a run is."""
        if number == 0:
            self._is_measured = True
            self._kinds = tuple(replace(each, steps=max(each.steps, verdict.decisions)) for each in self._kinds)


class SystematicSearch:
    """All schedules with few deviations from fifo, those with fewer first.

    Args:
        depth: how many preemptions, and how many other changes of order, there are at most.
        options: a schedule whose options all have.
    """

    def __init__(self, depth: int, options: Schedule) -> None:
        self._tree = DepthFirst(depth, depth, options)

    def next(self) -> str | None:
        """See `cfepy.explore.campaign.Search`."""
        schedule = self._tree.next()
        return None if schedule is None else schedule.text()

    def tell(self, number: int, verdict: Verdict) -> None:
        """See `cfepy.explore.campaign.Search`."""
        widths = [abs(width) for width in verdict.widths]
        self._tree.learn(Schedule.parse(verdict.schedule), widths, [width < 0 for width in verdict.widths])


def make_search(
    policy: str, depth: int | None, steps: int, options: Schedule, first_seed: int = 0
) -> SeededSearch | SystematicSearch:
    """The search that a command asks for.

    Args:
        policy: one of POLICIES.
        depth: of the bugs that PCT looks for, and the most preemptions of a systematic search; None takes 3 and 2,
            and for `all` PCT of depths 1 to 3.
        steps: decisions of a run, at least, as the reference run had them.
        options: a schedule whose options all have.
        first_seed: of the first schedule.
    """
    steps = max(steps, 1)
    if policy == "dfs":
        return SystematicSearch(DFS_DEPTH if depth is None else depth, options)
    random = replace(options, kind="random")
    depths = PORTFOLIO_DEPTHS if depth is None and policy == "all" else (PCT_DEPTH if depth is None else depth,)
    pct = [replace(options, kind="pct", depth=each, steps=steps) for each in depths]
    if policy == "random":
        return SeededSearch((random,), first_seed)
    if policy == "pct":
        return SeededSearch(tuple(pct), first_seed)
    held = replace(random, hold_ns=options.hold_ns or PORTFOLIO_HOLD_NS)
    return SeededSearch((random, pct[0], held, *pct[1:]), first_seed)

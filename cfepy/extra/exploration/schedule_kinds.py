"""The kinds of schedules of a search from seeds, and how many turns each has: one table.

A failing schedule is replayed by its text alone, because each kind is a schedule whose options are part of the text.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

from cfepy.extra.exploration.missing_points import OpenPlaces
from cfepy.schedules import SHARED, Points, Schedule

PCT_DEPTH = 3
PORTFOLIO_DEPTHS = (2, 3, 1)
"""Depths of PCT in the policy `all`: most races need two ordered events, some three, and starvation one."""
PORTFOLIO_HOLD_NS = 1_000_000
"""Delay in the policy `all`, for one schedule in six (with points: for two), unless the board's tick is longer.
A race with a timer, or with a more urgent task that waits for one, shows only when code takes time. A longer delay
would break a mission's justified assumptions about its own sleeps; less than a tick would reach no timer."""
USUAL_TURNS = 2  # of each other kind; so one schedule of four has points at shared data, and one of four any priority
NOTHING_FOUND = OpenPlaces()


class ScheduleKind(NamedTuple):
    """A kind of schedules.

    Attributes:
        schedule: the schedule, whose seed is replaced.
        turns: how many schedules of a round have this kind.
    """

    schedule: Schedule
    turns: int = 1


def seeded_kinds(
    policy: str,
    depth: int | None,
    steps: int,
    options: Schedule,
    tick_ns: int = 0,
    *,
    holds: bool = True,
    openings: OpenPlaces = NOTHING_FOUND,
) -> tuple[ScheduleKind, ...]:
    """Return the kinds of schedules of a policy. The arguments are the same as in `search.make_search`.

    With points between calls there are many decisions, so PCT rarely hits the ones of a bug. In 13 programs that need
    points, random finds 10 more often than PCT of any of these depths. PCT of depth 3 finds two more often, and neither
    finds one in 200 schedules. So PCT has one turn in six there.
    """
    random, abreast = replace(options, kind="random"), replace(options, kind="abreast")
    is_mixed = policy == "all"
    depths = PORTFOLIO_DEPTHS if depth is None and is_mixed else (PCT_DEPTH if depth is None else depth,)
    pct = tuple(replace(options, kind="pct", depth=each, steps=max(steps, 1)) for each in depths)
    if not is_mixed:
        return tuple(map(ScheduleKind, {"random": (random,), "pct": pct, "abreast": (abreast,)}[policy]))
    delay_ns = options.hold_ns or max(PORTFOLIO_HOLD_NS, tick_ns)
    held = [replace(random, hold_ns=delay_ns)] if holds or options.hold_ns else []
    deepest = max(pct, key=lambda each: each.depth)
    if options.points:
        often = held or [random]
        return tuple(map(ScheduleKind, (random, deepest, abreast, *often, random, *often)))
    late = [replace(each, late_ns=delay_ns) for each in held]
    rows = [ScheduleKind(each, USUAL_TURNS) for each in (random, pct[0], abreast, *late, *pct[1:])]
    if openings.shared:
        points = Points(SHARED, names=openings.shared).text()
        rows.append(ScheduleKind(random.with_points(points), 2))
        rows += [ScheduleKind(each.with_points(points)) for each in (deepest, *late)]
    if openings.overlaps and not options.any_priority:
        rows.append(ScheduleKind(replace(random, any_priority=True), 2))
        rows += [ScheduleKind(replace(each, any_priority=True)) for each in (pct[0], deepest)]
    return tuple(rows)


def in_turn(counts: Sequence[int]) -> list[int]:
    """Return each kind, by its number, repeated by its count, evenly mixed."""
    size = sum(counts)
    given = [0] * len(counts)
    turns = []
    for place in range(1, size + 1):
        kind = max(range(len(counts)), key=lambda each: (counts[each] * place - given[each] * size, -each))
        given[kind] += 1
        turns.append(kind)
    return turns

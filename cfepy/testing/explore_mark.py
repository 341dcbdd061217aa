"""`@explore`: which schedules a test is run under. What runs it comes from an add-on, and is loaded for such tests."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import pytest

from cfepy.schedules import Points, Schedule
from cfepy.status import UsageError
from cfepy.testing.missions import EXPLORE_MARK

POLICIES = ("all", "random", "pct", "abreast")
BASE = "at"  # a schedule that has options, and is fifo's otherwise


@dataclass(frozen=True, slots=True)
class Exploration:
    """Which schedules a test is run under; see `explore`.

    Attributes:
        seeds: how many.
        policies: where they come from, by turns.
        depth: of the bugs that PCT looks for; None for that of `cfepy explore`.
        steps: how many decisions PCT expects of a run, at least.
        options: a schedule whose options all have but fifo.
        shrink: runs that shrinking may take; None for as many as there were until then, 300 to 800.
        races: whether data races are failures.
    """

    seeds: int
    policies: tuple[str, ...]
    depth: int | None
    steps: int
    options: Schedule
    shrink: int | None
    races: bool = False


def explore(
    seeds: int = 200,
    policy: str | Sequence[str] = "all",
    *,
    depth: int | None = None,
    steps: int = 1,
    any_priority: bool = False,
    hold: str = "",
    connect: str = "",
    points: str = "",
    races: bool = False,
    start: str = "",
    shrink: int | None = None,
) -> pytest.MarkDecorator:
    """Run a test under many schedules, until it fails under one.

    Each schedule is a run of the whole test, with its function-scoped fixtures, `mission` and tmp_path made anew. The
    first schedule is fifo. When the test fails, the schedule is shrunk to the fewest deviations from fifo that still
    fail, and the failure shows these, and the command that does it again. Works on functions and classes.

    Args:
        seeds: how many schedules; --cfepy-schedules overrules it.
        policy: "random", "pct", "abreast", several of them, which take turns, or "all" as `cfepy explore` has it.
        depth: of the bugs that PCT looks for; None for 3, and for 1 to 3 in "all".
        steps: how many decisions PCT expects of a run, at least; they are counted.
        any_priority: tasks of less urgent priority may go before more urgent ones.
        hold: how long the running task may be held up, such as "500us"; empty for not at all.
        connect: how long a connection between two ROS nodes may take, such as "50ms"; empty for what the mission has.
        points: where others may get in besides calls: "lines", "attributes" or "calls", in some modules alone as
            "lines:arm,util"; empty for nowhere.
        races: accesses of Python code that nothing orders let it fail, too.
        start: virtual time from the boot until which all is as with fifo, such as "600ms"; empty for none.
        shrink: how many runs it may take to shrink a schedule; None for as many as there were until then, 300 to 800; 0
            leaves it as it is.

    Raises:
        UsageError: an argument that cannot be.
    """
    if not isinstance(seeds, int):
        raise UsageError("requires parentheses: write @explore(), or @explore(seeds=20)", field="@explore")
    policies = (policy,) if isinstance(policy, str) else tuple(policy)
    for each in policies:
        if each not in POLICIES:
            raise UsageError(f"unknown policy {each!r}; expected one of {', '.join(POLICIES)}", field="policy")
    if seeds < 1 or not policies:
        raise UsageError("must not be empty; give at least one", field="seeds" if policies else "policy")
    if depth is not None and depth < 1:
        raise UsageError(f"invalid depth {depth}; expected a whole number of at least 1", field="depth")
    words = [BASE, *(["any"] if any_priority else []), *([f"hold={hold}"] if hold else [])]
    words += [f"connect={connect}"] if connect else []
    words += [f"points={Points.parse(points, 'points').text()}"] if points else []
    words += [f"from={start}"] if start else []
    options = Schedule.parse(":".join(words))
    mark: pytest.MarkDecorator = getattr(pytest.mark, EXPLORE_MARK)
    return mark(Exploration(seeds, policies, depth, steps, options, shrink, races))

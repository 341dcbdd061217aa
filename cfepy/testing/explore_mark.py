"""`@explore`: the schedules of a test. Its implementation comes from an add-on, and is loaded only for such tests."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import pytest

from cfepy.reading.suggestions import expected
from cfepy.schedules import Points, Schedule
from cfepy.status import UsageError
from cfepy.testing.keywords import suggests_keywords
from cfepy.testing.missions import EXPLORE_MARK

POLICIES = ("all", "random", "pct", "abreast")
BASE = "at"  # a schedule that has options, and is otherwise fifo


@dataclass(frozen=True, slots=True)
class Exploration:
    """Schedules under which a test is run; see `explore`.

    Attributes:
        seeds: number of schedules.
        policies: their policies, in turn.
        depth: depth of the bugs that PCT looks for; None for the default of `cfepy explore`.
        steps: minimum number of decisions that PCT expects in a run.
        options: a schedule with the options of all except fifo.
        shrink: maximum number of runs for shrinking; None for as many as before, 300 to 800.
        shrink_time: maximum wall time for shrinking in s.
        races: whether data races are failures.
    """

    seeds: int
    policies: tuple[str, ...]
    depth: int | None
    steps: int
    options: Schedule
    shrink: int | None
    shrink_time: float
    races: bool = False


@suggests_keywords
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
    shrink_time: float = 60.0,
) -> pytest.MarkDecorator:
    """Run a test under many schedules, until it fails under one.

    Each schedule is a run of the whole test, with new function-scoped fixtures, including `mission` and tmp_path. The
    first schedule is fifo. When the test fails, the schedule is shrunk to the fewest deviations from fifo that still
    fail. The failure shows its cause if it is known, these deviations, and the command that repeats the run. You can
    mark functions and classes.

    Args:
        seeds: number of schedules; overridden by --cfepy-schedules.
        policy: "random", "pct", "abreast", several of them in turn, or "all" as in `cfepy explore`.
        depth: depth of the bugs that PCT looks for; None for 3, and for 1 to 3 in "all".
        steps: minimum number of decisions that PCT expects in a run; they are counted.
        any_priority: whether less urgent tasks may go before more urgent ones.
        hold: longest delay of the running task, such as "500us"; empty for none.
        connect: longest duration of a connection between two ROS nodes, such as "50ms"; empty for the mission's own.
        points: where other tasks may run in addition to calls: "lines", "attributes" or "calls", optionally only in
            some modules as in "lines:arm,util"; empty for nowhere.
        races: whether unordered accesses in Python code are failures too.
        start: virtual time from the boot until which everything is as with fifo, such as "600ms"; empty for none.
        shrink: maximum number of runs for shrinking a schedule; None for as many as before, 300 to 800; 0 for no
            shrinking.
        shrink_time: maximum wall time for shrinking in s; afterwards the shortest schedule so far is reported.

    Raises:
        UsageError: if an argument is invalid.
    """
    if not isinstance(seeds, int):
        raise UsageError("requires parentheses: write @explore(), or @explore(seeds=20)", field="@explore")
    policies = (policy,) if isinstance(policy, str) else tuple(policy)
    for each in policies:
        if each not in POLICIES:
            raise UsageError(f"unknown policy {each!r}; {expected(str(each), POLICIES)}", field="policy")
    if seeds < 1 or not policies:
        raise UsageError("must not be empty; give at least one", field="seeds" if policies else "policy")
    if depth is not None and depth < 1:
        raise UsageError(f"invalid depth {depth}; expected a whole number of at least 1", field="depth")
    if not shrink_time > 0:
        raise UsageError(f"invalid time {shrink_time}; expected more than 0 s", field="shrink_time")
    words = [BASE, *(["any"] if any_priority else []), *([f"hold={hold}"] if hold else [])]
    words += [f"connect={connect}"] if connect else []
    words += [f"points={Points.parse(points, 'points').text()}"] if points else []
    words += [f"from={start}"] if start else []
    options = Schedule.parse(":".join(words))
    mark: pytest.MarkDecorator = getattr(pytest.mark, EXPLORE_MARK)
    return mark(Exploration(seeds, policies, depth, steps, options, shrink, shrink_time, races))

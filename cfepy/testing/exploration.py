"""`@explore`: a test that is run under many schedules, which differ in who goes first. Imports pytest."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import pytest

from cfepy.rtos.schedule import DEPTH, STEPS, Schedule
from cfepy.status import UsageError
from cfepy.testing.plugin import EXPLORE_MARK

POLICIES = ("random", "pct")
MOST_PROBES = 200


@dataclass(frozen=True, slots=True)
class Exploration:
    """Which schedules a test is run under; see `explore`."""

    seeds: int
    policies: tuple[str, ...]
    depth: int
    steps: int
    options: str
    shrink: int

    def schedules(self, count: int | None = None) -> Iterator[Schedule]:
        """So many schedules; fifo comes first, then the policies take turns."""
        yield Schedule()
        for seed in range(1, self.seeds if count is None else count):
            policy = self.policies[(seed - 1) % len(self.policies)]
            depth = f":{self.depth}:{self.steps}" if policy == "pct" else ""
            yield Schedule.parse(f"{policy}:{seed}{depth}{self.options}")


def explore(
    seeds: int = 200,
    policy: str | Sequence[str] = "random",
    *,
    depth: int = DEPTH,
    steps: int = STEPS,
    any_priority: bool = False,
    hold: str = "",
    start: str = "",
    shrink: int = MOST_PROBES,
) -> pytest.MarkDecorator:
    """Run a test under many schedules, until it fails under one.

    Each schedule is a run of the whole test, with its function-scoped fixtures, `mission` and tmp_path made anew. The
    first schedule is fifo. When the test fails, the schedule is shrunk to the fewest deviations from fifo that still
    fail, and the failure shows these, and the command that does it again. Works on functions and classes.

    Args:
        seeds: how many schedules; --cfepy-schedules overrules it.
        policy: "random", "pct", or several of them, which take turns.
        depth: of the bugs that pct looks for.
        steps: how many decisions pct expects of a run.
        any_priority: tasks of less urgent priority may go before more urgent ones.
        hold: how long the running task may be held up, such as "500us"; empty for not at all.
        start: virtual time from the boot until which all is as with fifo, such as "600ms"; empty for none.
        shrink: how many runs it may take to shrink a schedule; 0 leaves it as it is.

    Raises:
        UsageError: an argument that cannot be.
    """
    if not isinstance(seeds, int):
        raise UsageError("needs parentheses: write @explore(), or @explore(seeds=20)", field="@explore")
    policies = (policy,) if isinstance(policy, str) else tuple(policy)
    for each in policies:
        if each not in POLICIES:
            raise UsageError(f"{each!r} is no policy; there are {', '.join(POLICIES)}", field="policy")
    if seeds < 1 or not policies:
        raise UsageError("there is nothing to run; give at least one", field="seeds" if policies else "policy")
    options = (":any" if any_priority else "") + (f":hold={hold}" if hold else "")
    options += f":from={start}" if start else ""
    found = Exploration(seeds, policies, depth, steps, options, shrink)
    list(found.schedules(min(seeds, 1 + len(policies))))  # a wrong `hold`, `start` or `depth` is told now
    mark: pytest.MarkDecorator = getattr(pytest.mark, EXPLORE_MARK)
    return mark(found)

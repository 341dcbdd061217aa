"""`explore`: a mission under many schedules, as `cfepy explore` does it, and what failed under some of them."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Unpack

from cfepy.flight.expectations import counted
from cfepy.flight.plans import MissionWords, RunOptions, plan_of
from cfepy.flight.run import Run
from cfepy.flight.start import fly_plan
from cfepy.pilot import RunPlan
from cfepy.plugins import Hook
from cfepy.schedules import Schedule
from cfepy.writing.markup import code, folded, headline, lines_of, trouble

DEFAULT_SEEDS = 100
EXPLORE: Hook[Callable[..., Explored]] = Hook("explore")
"""Explores a plan; the other arguments are those of `explore`, with their units in their names."""


@dataclass(frozen=True, repr=False, slots=True)
class FoundFailure:
    """A failure that some schedules show.

    Attributes:
        title: what failed, in a line.
        detail: more of it, such as a traceback.
        at: virtual time in s of the first run that showed it; None when it has none.
        schedules: how many of the schedules showed it.
        under_fifo: whether the default schedule shows it as well.
        schedule: the shortest schedule known that shows it.
        preemptions: of that schedule; None when it was not shrunk.
        cause: a sentence, where what was observed says it; empty otherwise.
        timeline: what happens under it, a line each, the cause above it; empty when it was not shrunk.
        plan: the shortest run that shows it.
    """

    title: str
    detail: str
    at: float | None
    schedules: int
    under_fifo: bool
    schedule: Schedule
    preemptions: int | None
    cause: str
    timeline: list[str]
    plan: RunPlan

    @property
    def command(self) -> str:
        """The command that shows it."""
        return self.plan.command_line()

    def replay(self) -> Run:
        """Fly the shortest run that shows it; its `problems` and `console` have the failure."""
        return fly_plan(self.plan)

    @property
    def about(self) -> str:
        """How many schedules show it, and the shortest."""
        default = ", the default one among them" if self.under_fifo else ""
        shortest = "" if self.preemptions is None else f", {counted(self.preemptions, 'preemption')}"
        return f"{counted(self.schedules, 'schedule')}{default}; the shortest is {self.schedule}{shortest}"

    def __repr__(self) -> str:
        return f"<{self.title}: {self.schedules} schedules, shortest {self.schedule}>"

    def _repr_html_(self) -> str:
        """What a notebook shows."""
        parts = [trouble(self.title), headline("shown by", self.about), code(self.command)]
        parts.append(folded("What happens", lines_of(self.timeline), is_open=True))
        parts.append(folded("More of it", lines_of(self.detail.splitlines())))
        return f"<div style='margin-top: 0.5em'>{''.join(parts)}</div>"


@dataclass(frozen=True, repr=False, slots=True)
class Explored:
    """What became of a mission under many schedules.

    Attributes:
        mission: what was explored, as it was given.
        failures: each failure once, those of the default schedule first.
        schedules: how many were flown.
        failed: how many of them failed.
        worst: the longest that was measured, and the schedule that gives it; None when nothing was to be.
        troubles: errors of cfepy itself, which are to be reported.
        notes: what its user should know.
        numbers: what `to_dict` gives.
    """

    mission: str
    failures: list[FoundFailure]
    schedules: int
    failed: int
    worst: Any
    troubles: list[str]
    notes: tuple[str, ...]
    numbers: Mapping[str, Any]

    def to_dict(self) -> dict[str, Any]:
        """Plain data, as `cfepy explore --json` writes it."""
        return dict(self.numbers)

    def __repr__(self) -> str:
        titles = "".join(f"\n  {failure.title}" for failure in self.failures)
        return f"<{self.schedules} schedules, {self.failed} failed{titles}>"

    def _repr_html_(self) -> str:
        """What a notebook shows."""
        failed = f"{self.failed} failed" if self.failed else "none failed"
        parts = [headline(self.mission, f"{counted(self.schedules, 'schedule')}, {failed}")]
        parts += [trouble(f"an error of cfepy itself: {each}") for each in self.troubles]
        parts += [headline("note", note) for note in self.notes]
        parts += [failure._repr_html_() for failure in self.failures]
        return f"<div>{''.join(parts)}</div>"


def explore(
    mission: MissionWords,
    *,
    seeds: int = DEFAULT_SEEDS,
    budget: float | None = None,
    policy: str = "all",
    depth: int | None = None,
    until_failure: bool = False,
    any_priority: bool = False,
    hold: float | None = None,
    connect: float | None = None,
    points: str = "",
    start: float | None = None,
    fair: int | None = None,
    events: str = "error",
    starved: float | None = None,
    livelock: float | None = None,
    stuck: bool = True,
    worst: str | None = None,
    jobs: int | None = None,
    results: str | os.PathLike[str] | None = None,
    shrink: int | None = None,
    **options: Unpack[RunOptions],
) -> Explored:
    """Fly a mission under many schedules, and find what fails under some of them.

        for failure in cfepy.explore("my_mission", seeds=200, seconds=2).failures:
            print(failure.title, failure.command)

    Args:
        mission: as of `run`.
        seeds: how many schedules.
        budget: wall time in s after which no further schedule is begun; None for no limit.
        policy: where they come from: "random", "pct", "abreast", "dfs", "orders", or "all".
        depth: of the bugs that PCT looks for; most preemptions of "dfs"; how many steps "orders" may differ in. None is
            1 to 3, 2 and all.
        until_failure: whether the first failure ends it.
        any_priority: less urgent tasks may run before more urgent ones.
        hold: how long the running task may be held up, in virtual s.
        connect: how long a connection between two ROS nodes may take, in virtual s.
        points: where others may get in besides calls: "lines", "attributes" or "calls", in some modules alone as
            "lines:arm,util"; empty for nowhere.
        start: virtual time in s until which all is as by default; 0 for that at which the mission is OPERATIONAL.
        fair: decisions in which a task that could run may be passed over; None for any number.
        events: which events of the mission's applications are failures: "error", "critical" or "none".
        starved: virtual time in s for which a task may be ready and not run; None for any time.
        livelock: virtual time in s for which an application may run on without a message; None for any time.
        stuck: whether a task that waits for ever, and does not by default, is a failure.
        worst: what is to take as long as it can, such as "latency:/topic"; None for nothing.
        jobs: processes; None is one on each CPU.
        results: file that keeps the verdicts, and that it goes on from.
        shrink: how many runs it may take to shrink a failure; None for as many as there were schedules, 300 to 800; 0
            leaves it as it is.
        options: `seconds`, `seed`, `board`, `script`, `faults` and so on, see `RunOptions`. A schedule is none of them.

    Raises:
        TypeError: there is no such option.
        UsageError: there is no such mission, something in it or in an option is wrong, or it cannot boot.
    """
    known = RunOptions.__annotations__.keys() - {"schedule"}
    if isinstance(options.get("faults"), Mapping):
        raise TypeError("faults must be the file of a plan or seed:N, because the runs are in other processes")
    plan = plan_of(mission, options, known)
    return EXPLORE.need("cfepy.explore")(
        plan,
        seeds=seeds,
        budget_s=budget,
        policy=policy,
        depth=depth,
        until_failure=until_failure,
        any_priority=any_priority,
        hold_s=hold,
        connect_s=connect,
        points=points,
        from_s=start,
        fair=fair,
        events=events,
        starved_s=starved,
        livelock_s=livelock,
        stuck=stuck,
        worst=worst,
        jobs=jobs,
        results=None if results is None else os.fspath(results),
        shrink=shrink,
    )

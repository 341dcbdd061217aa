"""`explore`: a mission under many schedules, like `cfepy explore`, and the failures under some of them."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal, Unpack

from cfepy.flight.expectations import counted
from cfepy.flight.plans import MissionWords, RunOptions, plan_of
from cfepy.flight.run import Run
from cfepy.flight.start import fly_plan
from cfepy.pilot import RunPlan
from cfepy.plugins import Hook
from cfepy.schedules import Schedule
from cfepy.writing.markup import code, folded, headline, lines_of, trouble

DEFAULT_SEEDS = 100
AUTO = "auto"
EXPLORE: Hook[Callable[..., Explored]] = Hook("explore")
"""Explores a plan; the other arguments are those of `explore`, with the unit in their names."""


@dataclass(frozen=True, repr=False, slots=True)
class FoundFailure:
    """A failure under some schedules.

    Attributes:
        title: a line about the failure.
        detail: more details, such as a traceback.
        at: virtual time in s in the first run that showed it; None if it has no time.
        schedules: number of schedules that showed it.
        under_fifo: whether the default schedule shows it too.
        schedule: the shortest known schedule that shows it.
        preemptions: number of preemptions of that schedule; None if it was not shrunk.
        cause: a sentence about the cause, if the observations show it; otherwise empty.
        timeline: the events under that schedule, one per line, after the cause; empty if it was not shrunk.
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
        """Fly the shortest run that shows the failure, which is in its `problems` and `console`."""
        return fly_plan(self.plan)

    @property
    def about(self) -> str:
        """The number of schedules that show it, and the shortest."""
        default = ", the default one among them" if self.under_fifo else ""
        shortest = "" if self.preemptions is None else f", {counted(self.preemptions, 'preemption')}"
        return f"{counted(self.schedules, 'schedule')}{default}; the shortest is {self.schedule}{shortest}"

    def __repr__(self) -> str:
        return f"<{self.title}: {self.schedules} schedules, shortest {self.schedule}>"

    def _repr_html_(self) -> str:
        """Return the HTML for a notebook."""
        parts = [trouble(self.title), headline("shown by", self.about), code(self.command)]
        parts.append(folded("What happens", lines_of(self.timeline), is_open=True))
        parts.append(folded("More of it", lines_of(self.detail.splitlines())))
        return f"<div style='margin-top: 0.5em'>{''.join(parts)}</div>"


@dataclass(frozen=True, repr=False, slots=True)
class Explored:
    """The results of a mission under many schedules.

    Attributes:
        mission: the explored mission, as given.
        failures: each failure once, those of the default schedule first.
        schedules: number of schedules flown.
        failed: number of failed ones.
        worst: the longest measured time and its schedule; None if nothing was measured.
        troubles: errors of cfepy itself, which you should report.
        notes: notes for the user.
        numbers: the data of `to_dict`.
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
        """Return plain data, as in the output of `cfepy explore --json`."""
        return dict(self.numbers)

    def __repr__(self) -> str:
        titles = "".join(f"\n  {failure.title}" for failure in self.failures)
        return f"<{self.schedules} schedules, {self.failed} failed{titles}>"

    def _repr_html_(self) -> str:
        """Return the HTML for a notebook."""
        failed = f"{self.failed} failed" if self.failed else "none failed"
        parts = [headline(self.mission, f"{counted(self.schedules, 'schedule')}, {failed}")]
        parts += [trouble(f"an error of cfepy itself: {each}") for each in self.troubles]
        parts += [headline("note", note) for note in self.notes]
        parts += [failure._repr_html_() for failure in self.failures]
        return f"<div>{''.join(parts)}</div>"


def explore(
    mission: MissionWords,
    *,
    seeds: int | Literal["auto"] = DEFAULT_SEEDS,
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
    """Fly a mission under many schedules, and find the failures under some of them.

        for failure in cfepy.explore("my_mission", seeds=200, seconds=2).failures:
            print(failure.title, failure.command)

    Args:
        mission: see `run`.
        seeds: number of schedules; "auto" goes on until schedules bring nothing new.
        budget: wall time in s after which no new schedule starts; None for no limit.
        policy: their source: "random", "pct", "abreast", "dfs", "orders", or "all".
        depth: depth of the bugs that PCT looks for; maximum number of preemptions of "dfs"; number of steps in which
            "orders" may differ. None means 1 to 3, 2 and all.
        until_failure: whether to stop at the first failure.
        any_priority: whether less urgent tasks may run before more urgent ones.
        hold: longest time to hold up the running task, in virtual s.
        connect: longest delay of a connection between two ROS nodes, in virtual s.
        points: preemption points besides calls: "lines", "attributes" or "calls", or only in some modules, as
            "lines:arm,util"; empty for none.
        start: virtual time in s until which the schedule is the default one; 0 means until the mission is OPERATIONAL.
        fair: number of decisions in which a ready task may be passed over; None for no limit.
        events: which events of the mission's applications are failures: "error", "critical" or "none".
        starved: virtual time in s after which a ready task that does not run is starved; None for no limit.
        livelock: virtual time in s after which an application that runs without a message is livelocked; None for no
            limit.
        stuck: whether a task that waits forever, but not under the default schedule, is a failure.
        worst: the time to maximize, such as "latency:/topic"; None for none.
        jobs: number of processes; None means one for each CPU.
        results: file that stores the verdicts, and from which the search resumes.
        shrink: maximum number of runs to shrink a failure; None means the number of schedules, within 300 to 800; 0
            does not shrink.
        options: `seconds`, `seed`, `board`, `script`, `faults` and so on, see `RunOptions`. `schedule` is not allowed.

    Raises:
        TypeError: if there is no such option.
        UsageError: if the mission does not exist, it or an option is wrong, or it cannot boot.
    """
    known = RunOptions.__annotations__.keys() - {"schedule"}
    if isinstance(options.get("faults"), Mapping):
        raise TypeError("faults must be the file of a plan or seed:N, because the runs are in other processes")
    plan = plan_of(mission, options, known)
    return EXPLORE.need("cfepy.explore")(
        plan,
        seeds=None if seeds == AUTO else seeds,
        until_known=seeds == AUTO,
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

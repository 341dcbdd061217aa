"""The extent of an exploration: preemption points, number of orders, and possible misses."""

from __future__ import annotations

import sys
from collections import Counter
from dataclasses import dataclass, field
from math import expm1, log1p
from types import FrameType

from cfepy.extra.exploration.partial_orders import OrdersSeen
from cfepy.extra.exploration.switch_kinds import SwitchKinds
from cfepy.extra.exploration.verdict import Verdict
from cfepy.reading.suggestions import listed
from cfepy.rtos import AskingPolicy, Decision, Policy
from cfepy.schedules import SHARED, Points, Schedule
from cfepy.units import time_word

_KINDS = {
    "cfepy.nodes.stdlib.locks": "locks",
    "cfepy.osal.locks": "locks",
    "cfepy.osal.semaphores": "semaphores",
    "cfepy.osal.queues": "queues",
    "cfepy.osal.timers": "timers",
    "cfepy.osal.tasks": "tasks",
    "cfepy.nodes.stdlib.thread_module": "tasks",
    "cfepy.nodes.stdlib.time_module": "clocks",
    "rospy_shim.client.rostime": "clocks",
    "cfepy.time": "clocks",
    "cfepy.osal.clock": "clocks",
    "cfepy.nodes.files": "files",
    "cfepy.osal.files": "files",
    "rospy_shim.client.timer": "timers",
    "rospy_shim.client.service": "services",
    "rospy_shim.client.service_proxy": "services",
    "rospy_shim.client.params": "parameters",
    "rospy_shim.client.shutdown": "waits of nodes",
    "rospy_shim.client": "messages",
    "cfepy.sb": "messages",
    "cfepy.tbl": "tables",
    "cfepy.evs": "events",
    "cfepy.es": "executive services",
    "cfepy.extra.c": "calls of C",
    "cfepy.nodes.accesses": "lines and accesses",
}
"""Kind of a point, by the module of the call; the longest matching name counts."""
_OF_THE_KERNEL = ("cfepy.rtos", "cfepy.schedules", "cfepy.mission.call_points", __name__)
OTHER = "other calls"


class PointCounter(AskingPolicy):
    """Asks another policy, and counts the decisions by the kinds of their calls.

    Args:
        inner: the policy that decides.

    Attributes:
        kinds: number of decisions of each kind.
    """

    def __init__(self, inner: Policy) -> None:
        super().__init__(inner)
        self.kinds: Counter[str] = Counter()

    def choose(self, decision: Decision) -> int:
        self.kinds["questions" if decision.question is not None else kind_of(sys._getframe(1))] += 1
        return self._inner.choose(decision)


def kind_of(frame: FrameType | None) -> str:
    """Return the kind of the innermost call above the kernel's."""
    while frame is not None:
        module = frame.f_globals.get("__name__", "")
        if not module.startswith(_OF_THE_KERNEL):
            return _kind_of_module(module)
        frame = frame.f_back
    return OTHER


def _kind_of_module(module: str) -> str:
    name = module
    while name:
        if name in _KINDS:
            return _KINDS[name]
        name = name.rpartition(".")[0]
    return OTHER


@dataclass(slots=True)
class Breadth:
    """The extent of an exploration.

    Attributes:
        points: decisions under the default schedule, by kind.
        tasks: number of tasks under it.
        orders: digests of the runs that differ from each other.
        pct: by depth, the number of PCT schedules for bugs of that depth.
        gaps: functions that access objects that other tasks also access, with no preemption point between; a line each.
        files: files that two tasks used, one of them to change it; a line each.
        seen: the extent of a search of orders.
        steps: the most decisions that a PCT run had, or was drawn for.
        switches: the kinds of switches of a search without a fixed number of schedules.
        options: a schedule with the options that all schedules have; None before there are any.
        shared: the number of schedules with points at shared data, and the names of the data.
        overlapping, held: numbers of schedules in which any priority could run, and in which tasks could be held up.
        hold_ns: the longest time of a hold.
    """

    points: dict[str, int] = field(default_factory=dict)
    tasks: int = 0
    orders: set[str] = field(default_factory=set)
    pct: Counter[int] = field(default_factory=Counter)
    steps: int = 1
    gaps: list[str] = field(default_factory=list)
    files: list[str] = field(default_factory=list)
    seen: OrdersSeen | None = None
    switches: SwitchKinds | None = None
    options: Schedule | None = None
    shared: Counter[tuple[str, ...]] = field(default_factory=Counter)
    overlapping: int = 0
    held: int = 0
    hold_ns: int = 0

    def take(self, verdict: Verdict) -> None:
        """Count another flown schedule."""
        if verdict.trace:
            self.orders.add(verdict.trace)
        schedule = verdict.schedule
        points = Points.parse(schedule.points)
        if points.kind == SHARED:
            self.shared[points.names] += 1
        self.overlapping += schedule.any_priority
        self.held += bool(schedule.hold_ns or schedule.late_ns)
        self.hold_ns = max(self.hold_ns, schedule.hold_ns, schedule.late_ns)
        if verdict.schedule.kind == "pct":
            self.pct[verdict.schedule.depth] += 1
            self.steps = max(self.steps, verdict.schedule.steps, verdict.decisions)

    def chance(self, depth: int) -> float:
        """Return PCT's lower bound for the chance that a bug of this depth (number of ordered events) has shown.

        A schedule of PCT shows it with a probability of 1 / (tasks * steps ** (depth - 1)) or more (Burckhardt and
        others, ASPLOS 2010). Schedules of other policies are not counted.
        """
        each = 1 / (max(self.tasks, 1) * self.steps ** (depth - 1))
        return 1.0 if each >= 1 else -expm1(self.pct[depth] * log1p(-each))

    def lines(self) -> list[str]:
        """Return a few lines of text."""
        if self.seen is None:
            found = ["1 order" if len(self.orders) == 1 else f"{len(self.orders)} different orders"]
        else:
            found = self.seen.lines(len(self.orders))
        if self.switches is not None:
            found.append(self.switches.line())
        kinds = sorted(self.points.items(), key=lambda each: -each[1])
        if kinds:
            listed = ", ".join(f"{count} at {kind}" for kind, count in kinds)
            found.append(f"under fifo others can get in at {sum(self.points.values())} points: {listed}")
        chances = [f"{self.chance(depth):.2g} at depth {depth}" for depth in sorted(self.pct)]
        if chances:
            bound = f"PCT's bound for {self.tasks} tasks and {self.steps} points"
            found.append(f"probability that a bug was found, at least: {', '.join(chances)} ({bound})")
        if self.options is not None:
            found.append(self._kinds_line(self.options))
        if self.gaps:
            found.append(
                "accesses without a call between them were one step; --points attributes adds points between them:"
            )
            found += [f"  {gap}" for gap in self.gaps]
        if self.files:
            found.append("files that more than one task used:")
            found += [f"  {file}" for file in self.files]
        return found

    def _kinds_line(self, options: Schedule) -> str:
        """Return a line about the kinds of schedules, and about the options that would add others."""
        parts = [f"{count} with points at {listed(names, 'and')}" for names, count in self.shared.items()]
        parts += [f"{self.overlapping} with any priority"] if self.overlapping else []
        parts += [f"{self.held} with tasks held up for up to {time_word(self.hold_ns)}"] if self.held else []
        more = [] if options.any_priority else ["--any-priority: any priority in all schedules"]
        more += [] if options.hold_ns else ["--hold TIME: longer holds, in all schedules"]
        more += [] if options.connect_ns else ["--connect TIME: connections of nodes that take time"]
        kinds = f"schedules of special kinds: {', '.join(parts) or 'none'}"
        return f"{kinds}; more with {', '.join(more)}" if more else kinds

    def to_dict(self) -> dict[str, object]:
        """Return plain data."""
        return {
            "at_shared": self.shared.total(),
            "any_priority": self.overlapping,
            "held": self.held,
            "orders": len(self.orders),
            "classes": None if self.seen is None else self.seen.orders,
            "complete": self.seen is not None and self.seen.is_complete,
            "astray": 0 if self.seen is None else self.seen.astray,
            "switches": None if self.switches is None else self.switches.to_dict(),
            "points": self.points,
            "tasks": self.tasks,
            "steps": self.steps,
            "gaps": self.gaps,
            "files": self.files,
            "chances": {depth: self.chance(depth) for depth in sorted(self.pct)},
        }

"""Gaps of an exploration: functions that access shared objects twice with no scheduling point between.

No schedule of an exploration at calls alone lets another task in there. One more run, of the default schedule, finds
them. It watches accesses as the race watch does. Two accesses of one function form a pair when its task has called
nothing between.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import PurePath
from types import CodeType
from typing import Any

from cfepy.extra.exploration.trial import Trial
from cfepy.monitors import RaceWatch
from cfepy.nodes import Touch
from cfepy.rtos import Task
from cfepy.schedules import CALLS, CallPointKernel, Schedule

MOST_TOLD = 5


def gaps_of(trial: Trial, options: Schedule) -> list[str]:
    """Fly the run once more. Returns the gaps of all schedules with these options, a line each.

    Args:
        trial: the trial.
        options: of the schedules.
    """
    watch = GapWatch()
    plain = replace(trial, plan=replace(trial.plan, races=False), waits=None, reference=None)
    plain.fly(options.at({}).with_points(CALLS), [watch])
    return watch.lines()


class GapWatch(RaceWatch):
    """Finds gaps in a run whose points are at calls."""

    def __init__(self) -> None:
        super().__init__()
        self._since: dict[Task, tuple[int, dict[tuple[int, str, CodeType], Touch]]] = {}
        self._gaps: dict[tuple[CodeType, str], tuple[tuple[int, str], Touch]] = {}

    def begin(self, mission: Any) -> None:
        super().begin(mission)
        self._kernel: CallPointKernel = mission.kernel
        mission.accesses.observers.append(self._pair)

    def _pair(self, touch: Touch) -> None:
        """Record a pair if the function accessed the same variable before, and no task could run since."""
        passed, touched = self._since.get(touch.task, (-1, {}))
        if passed != self._kernel.passed:
            touched = {}
            self._since[touch.task] = self._kernel.passed, touched
        first = touched.setdefault((touch.thing, touch.key, touch.code), touch)
        if first is not touch:
            self._gaps.setdefault((touch.code, touch.name), ((touch.thing, touch.key), first))

    def lines(self) -> list[str]:
        """Return a line for each function, with the variables that it accesses."""
        found: dict[str, list[str]] = {}
        for (code, name), (place, first) in self._gaps.items():
            if place in self.racing:
                where = f"{code.co_qualname} ({PurePath(code.co_filename).name}:{first.line})"
                found.setdefault(where, []).append(name)
        lines = [f"{where}: {' and '.join(names)}" for where, names in found.items()]
        more = [f"and {len(lines) - MOST_TOLD} more"] if len(lines) > MOST_TOLD else []
        return [*lines[:MOST_TOLD], *more]

"""A first look at a mission, before its exploration: unordered data, gaps between points, and files of two tasks.

One more run, of the default schedule, watches accesses as the race watch does. Part of the schedules get points at the
data that it finds unordered, and other priorities if that leads to other orders.

A gap is a function that accesses a shared object twice with no scheduling point between. No schedule of an exploration
at calls alone lets another task in there. Two accesses of one function form a pair when its task has called nothing
between.
"""

from __future__ import annotations

import sys
from collections import Counter
from dataclasses import replace
from pathlib import PurePath
from types import CodeType, FrameType
from typing import Any, NamedTuple

from cfepy.attachment import Attachment
from cfepy.extra.exploration.trial import Trial
from cfepy.mission import CORE_APPS, Mission
from cfepy.monitors import LOCKS_GIVEN, LOCKS_TAKEN, RaceWatch
from cfepy.nodes import WRITES_FILE, Accesses, FilePoints, Touch
from cfepy.reading.suggestions import did_you_mean, listed
from cfepy.rtos import AskingPolicy, Decision, Policy, Task
from cfepy.schedules import CALLS, CallPointKernel, Points, Schedule, name_of, source_names
from cfepy.status import UsageError
from cfepy.units import NS_PER_MS

MOST_TOLD = 5
LONG_NS = NS_PER_MS  # computations of this length decide which deadlines are met
_SERVICES = (*CORE_APPS, "ROS")  # applications of cFE, and the one of the parameter server and /rosout


class OpenPlaces(NamedTuple):
    """The places where further schedules could differ.

    Attributes:
        shared: names of attributes, variables and containers whose accesses by several tasks nothing orders, as
            `Points.names`.
        overlaps: whether tasks of the mission with different priorities were ready at once, and none computes for long.
            A long computation of one task would delay the other, which has a core of its own on a larger computer.
        gaps: functions that access shared objects twice with no point between; a line each.
        files: files that two tasks used, one of them to change it; a line each.
    """

    shared: tuple[str, ...] = ()
    overlaps: bool = False
    gaps: tuple[str, ...] = ()
    files: tuple[str, ...] = ()


def openings_of(trial: Trial, options: Schedule) -> OpenPlaces:
    """Fly the run once more. Returns the places that all schedules with these options leave open.

    Args:
        trial: the trial.
        options: of the schedules.
    """
    watch = GapWatch()
    plain = replace(trial, plan=replace(trial.plan, races=False), waits=None, reference=None)
    schedule = replace(options.at({}), any_priority=True).with_points(CALLS)
    overlaps = OverlapPolicy(schedule.policy() or Policy())
    plain.fly(schedule, [watch], policy=overlaps)
    return OpenPlaces(
        watch.shared(), overlaps.found and not watch.computes, tuple(watch.lines()), tuple(watch.files.lines())
    )


class OverlapPolicy(AskingPolicy):
    """Asks another policy, and notes whether any priority would offer other candidates.

    Args:
        inner: the policy that decides.

    Attributes:
        found: whether tasks of the mission could run that a more urgent one keeps from running.
    """

    def __init__(self, inner: Policy) -> None:
        super().__init__(inner)
        self.found = False

    def choose(self, decision: Decision) -> int:
        if not self.found and len(decision.tasks) > 1:
            first = decision.tasks[0]
            self.found = _is_of_mission(first) and any(
                task.priority != first.priority and _is_of_mission(task) for task in decision.tasks
            )
        return super().choose(decision)


def _is_of_mission(task: Task) -> bool:
    return task.owner is not None and getattr(task.owner, "name", "") not in _SERVICES


class SourceWatch(Attachment):
    """Knows the source files that a run has loaded, of which the points may name some."""

    def __init__(self) -> None:
        self._accesses: Accesses | None = None

    def begin(self, mission: Mission) -> None:
        self._accesses = mission.accesses

    def check(self, text: str) -> None:
        """Check the text of the option `--points`.

        Raises:
            UsageError: the mission has not loaded a module that the text names.
        """
        files = set() if self._accesses is None else self._accesses.seen
        unmatched = Points.parse(text).unmatched(files)
        if self._accesses is not None and unmatched:
            known = sorted({name for file in files for name in source_names(file)})
            hint = did_you_mean(unmatched[0], known, f"it has {listed(known)}", before="; ")
            raise UsageError(f"the mission loads no module {unmatched[0]!r}{hint}", field="--points")


class GapWatch(RaceWatch):
    """Finds gaps in a run whose points are at calls, and unordered data.

    That one task took a lock after another does not order their accesses outside of the lock: under another schedule
    they might come the other way round. So locks that the mission's own code makes order nothing here. Accesses of
    tasks that hold the same one are no race.
    """

    def __init__(self) -> None:
        super().__init__()
        self._since: dict[Task, tuple[int, dict[tuple[int, str, CodeType], Touch]]] = {}
        self._gaps: dict[tuple[CodeType, str], tuple[tuple[int, str], Touch]] = {}
        self._names: dict[tuple[int, str], dict[str, None]] = {}
        self._own: set[int] = set()  # numbers of locks that the mission's code has made
        self._held: dict[Task, Counter[int]] = {}

    def begin(self, mission: Any) -> None:
        super().begin(mission)
        self._kernel: CallPointKernel = mission.kernel
        mission.accesses.observers.append(self._pair)
        self.files = SharedFiles(mission.kernel)
        mission.kernel.watch(self.files)

    def _made(self, lock: Any) -> None:
        super()._made(lock)
        assert self._mission is not None
        frame: FrameType | None = sys._getframe(1)
        while frame is not None and frame.f_globals.get("__name__", "").startswith("cfepy."):
            frame = frame.f_back
        if frame is not None and frame.f_code.co_filename in self._mission.accesses.files:
            number = self._mission.accesses.number(lock)
            self._own.add(number)
            self._inner.add(number)

    def called(self, subject: Any, call: str, args: tuple[Any, ...]) -> None:
        super().called(subject, call, args)
        if call in LOCKS_GIVEN:
            self._count(subject, -1)

    def returned(self, subject: Any, call: str, args: tuple[Any, ...], result: Any) -> None:
        super().returned(subject, call, args, result)
        if call in LOCKS_TAKEN and result is not False:
            self._count(subject, 1)

    def _count(self, lock: Any, change: int) -> None:
        assert self._mission is not None
        number = self._mission.accesses.number(lock)
        if number in self._own:
            self._held.setdefault(self._task, Counter())[number] += change

    def _locks_of(self, task: Task) -> frozenset[int]:
        return frozenset(number for number, times in self._held.get(task, Counter()).items() if times > 0)

    def _pair(self, touch: Touch) -> None:
        """Record a pair if the function accessed the same variable before, and no task could run since."""
        self._names.setdefault((touch.thing, touch.key), {})[name_of(touch.name)] = None
        passed, touched = self._since.get(touch.task, (-1, {}))
        if passed != self._kernel.passed:
            touched = {}
            self._since[touch.task] = self._kernel.passed, touched
        first = touched.setdefault((touch.thing, touch.key, touch.code), touch)
        if first is not touch:
            self._gaps.setdefault((touch.code, touch.name), ((touch.thing, touch.key), first))

    @property
    def computes(self) -> bool:
        """Whether a task computed for long."""
        return self._kernel.longest_ns >= LONG_NS

    def shared(self) -> tuple[str, ...]:
        """Return the names under which unordered data is accessed, sorted."""
        return tuple(sorted({name for place in self.racing for name in self._names.get(place, ()) if name}))

    def lines(self) -> list[str]:
        """Return a line for each function, with the variables that it accesses."""
        found: dict[str, list[str]] = {}
        for (code, name), (place, first) in self._gaps.items():
            if place in self.racing:
                where = f"{code.co_qualname} ({PurePath(code.co_filename).name}:{first.line})"
                found.setdefault(where, []).append(name)
        return _cut([f"{where}: {' and '.join(names)}" for where, names in found.items()])


class SharedFiles:
    """An observer of calls that keeps which tasks use which files.

    Args:
        kernel: kernel of the mission.
    """

    def __init__(self, kernel: CallPointKernel) -> None:
        self._kernel = kernel
        self._users: dict[str, dict[str, bool]] = {}  # by path: names of tasks, and whether they change it

    def called(self, subject: Any, call: str, args: tuple[Any, ...]) -> None:
        """Keep an access; see `CallObserver.called`."""
        if isinstance(subject, FilePoints):
            users = self._users.setdefault(args[0], {})
            task = self._kernel.current.name
            users[task] = users.get(task, False) or call == WRITES_FILE

    def returned(self, subject: Any, call: str, args: tuple[Any, ...], result: Any) -> None:
        """Do nothing: an access counts when it begins."""

    def failed(self, subject: Any, call: str) -> None:
        """Do nothing."""

    def lines(self) -> list[str]:
        """Return a line for each file that two tasks used, one of them to change it."""
        found = []
        for path, users in self._users.items():
            writers = [task for task, changes in users.items() if changes]
            readers = [task for task, changes in users.items() if not changes]
            if writers and len(users) > 1:
                parts = [
                    f"{' and '.join(names)} {verb}"
                    for names, verb in ((writers, "changed"), (readers, "read"))
                    if names
                ]
                found.append(f"{path}: {', '.join(parts)} it")
        return _cut(found)


def _cut(lines: list[str]) -> list[str]:
    more = [f"and {len(lines) - MOST_TOLD} more"] if len(lines) > MOST_TOLD else []
    return [*lines[:MOST_TOLD], *more]

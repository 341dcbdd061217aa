"""The places that an exploration without a failure leaves open: gaps between points, and files of two tasks.

A gap is a function that accesses a shared object twice with no scheduling point between. No schedule of an exploration
at calls alone lets another task in there. One more run, of the default schedule, finds them. It watches accesses as the
race watch does. Two accesses of one function form a pair when its task has called nothing between.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import PurePath
from types import CodeType
from typing import Any, NamedTuple

from cfepy.attachment import Attachment
from cfepy.extra.exploration.trial import Trial
from cfepy.mission import Mission
from cfepy.monitors import RaceWatch
from cfepy.nodes import WRITES_FILE, Accesses, FilePoints, Touch
from cfepy.reading.suggestions import did_you_mean, listed
from cfepy.rtos import Task
from cfepy.schedules import CALLS, CallPointKernel, Points, Schedule, source_names
from cfepy.status import UsageError

MOST_TOLD = 5


class Unseen(NamedTuple):
    """The places that no schedule has tried.

    Attributes:
        gaps: functions that access shared objects twice with no point between; a line each.
        files: files that two tasks used, one of them to change it; a line each.
    """

    gaps: list[str]
    files: list[str]


def unseen_by(trial: Trial, options: Schedule) -> Unseen:
    """Fly the run once more. Returns the places that all schedules with these options leave open.

    Args:
        trial: the trial.
        options: of the schedules.
    """
    watch = GapWatch()
    plain = replace(trial, plan=replace(trial.plan, races=False), waits=None, reference=None)
    plain.fly(options.at({}).with_points(CALLS), [watch])
    return Unseen(watch.lines(), watch.files.lines())


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
    """Finds gaps in a run whose points are at calls."""

    def __init__(self) -> None:
        super().__init__()
        self._since: dict[Task, tuple[int, dict[tuple[int, str, CodeType], Touch]]] = {}
        self._gaps: dict[tuple[CodeType, str], tuple[tuple[int, str], Touch]] = {}

    def begin(self, mission: Any) -> None:
        super().begin(mission)
        self._kernel: CallPointKernel = mission.kernel
        mission.accesses.observers.append(self._pair)
        self.files = SharedFiles(mission.kernel)
        mission.kernel.watch(self.files)

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

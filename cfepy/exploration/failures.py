"""The failures of a run: collected while it flies, and read from its numbers when it is over.

What kills one thread of a node, or is swallowed by rospy after a callback, shows only as a traceback that the node
prints: a `TracebackReader` finds it on the console.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from pathlib import PurePath

from cfepy.attachment import Attachment
from cfepy.evs import CRITICAL, ERROR
from cfepy.exploration import verdict
from cfepy.exploration.verdict import RAISED, Failure
from cfepy.ground import EVENT_IDS, DecodedEvent
from cfepy.mission import (
    CORE_APPS,
    EndlessWait,
    EndlessWaits,
    Mission,
    PacketWatch,
    Seen,
    app_traceback,
    endless_waits,
    reason,
)
from cfepy.monitors.record import DeadlineRecord, InvariantRecords
from cfepy.own_code import is_own_code
from cfepy.pilot import end_of, ended_badly
from cfepy.rtos import DeadlockError, InjectedCrash, Kernel, Task, Wait, wrapping
from cfepy.sb import SoftwareBus
from cfepy.script import OVER, Outcome
from cfepy.units import NS_PER_S

EVENT_LEVELS = {"error": (ERROR, CRITICAL), "critical": (CRITICAL,), "none": ()}
"""Which events count as failures, by what `--events` of `cfepy explore` says."""
_LINE = re.compile(r"\[(?P<node>[^\]\s]+)\] ?(?P<text>.*)")
_FRAME = re.compile(r'\s+File "(?P<file>.+)", line (?P<line>\d+)')
_PLACE_AT_END = re.compile(r"\([^\s()]+:\d+\)$")
_BEGIN = "Traceback (most recent call last):"
_CHAINED = ("During handling of the above exception", "The above exception was the direct cause")


class FailureWatch(Attachment):
    """Collects what goes wrong in a run.

    Args:
        events: a key of EVENT_LEVELS.

    Attributes:
        trouble: errors of cfepy's own tasks, a traceback each; they say nothing about the mission.
        end_ns: virtual time at the end of the run.
    """

    def __init__(self, events: str = "error") -> None:
        self.trouble: list[str] = []
        self.end_ns = 0
        self._levels = EVENT_LEVELS[events]
        self._found: list[Failure] = []
        self._crashed: set[str] = set()  # applications that a fault lets crash: that is no failure, what follows may be
        self._endless = EndlessWaits([], [])
        self._tracebacks = TracebackReader()
        self._events = PacketWatch(self._take_event, EVENT_IDS.__contains__)
        self._mission: Mission | None = None

    def bus(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
        """See `Attachment.bus`."""
        return self._events.bus(base) if self._levels else base

    def kernel(self, base: type[Kernel]) -> type[Kernel]:
        """See `Attachment.kernel`."""
        return wrapping(base, {"interrupt": self._noting})

    def begin(self, mission: Mission) -> None:
        """See `Attachment.begin`."""
        self._mission = mission
        mission.kernel.on_task_error = self._watched(mission.kernel.on_task_error)
        mission.console.record = self._reading(mission.console.record)

    def conclude(self) -> None:
        """See `Attachment.conclude`: what waits for ever now has done so before the nodes are asked to end."""
        assert self._mission is not None
        self.end_ns = self._mission.kernel.now
        self._endless = endless_waits(self._mission)

    def saw(self, group: str) -> bool:
        """Whether there has been a failure of this group so far, of those that show while the mission runs."""
        assert self._mission is not None
        so_far = (*self._found, *self._tracebacks.found, *_violations(self._mission), *_of_compiled_code(self._mission))
        return any(failure.group == group for failure in so_far)

    def failures(self, outcome: Outcome | None) -> tuple[Failure, ...]:
        """All that there is to say, by time, of each group the first; what is true at the end comes last.

        Args:
            outcome: of the script that the run had.
        """
        assert self._mission is not None
        mission = self._mission
        found = [*self._found, *self._tracebacks.found, *_resets(mission), *_violations(mission), *_missed(outcome)]
        found += _of_compiled_code(mission)
        found += _overruns(mission)
        found.sort(key=lambda failure: failure.at_ns or 0)
        found += [*map(_circle, self._endless.circles), *_bad_ends(mission, found, self._crashed)]
        found += _alone(self._endless.alone, found)
        first: dict[str, Failure] = {}
        for failure in found:
            first.setdefault(failure.group, failure)
        return tuple(first.values())

    def _noting(self, interrupt: Callable[..., None]) -> Callable[..., None]:
        """What the fault plan calls to let an application crash, with a note of it."""

        def crash(kernel: Kernel, task: Task, error: BaseException) -> None:
            if isinstance(error, InjectedCrash) and task.owner is not None:
                self._crashed.add(task.owner.name)
            interrupt(kernel, task, error)

        return crash

    def _reading(self, record: Callable[[str], object] | None) -> Callable[[str], None]:
        """What the console gives its lines to, with a look at them."""

        def take(line: str) -> None:
            if record is not None:
                record(line)
            assert self._mission is not None
            self._tracebacks.take(line, self._mission.kernel.now, self._mission.kernel.current.name)

        return take

    def _watched(self, handle: Callable[[Task, BaseException], bool]) -> Callable[[Task, BaseException], bool]:
        """What the kernel calls for an exception that comes out of a task, with a look at it."""

        def on_task_error(task: Task, error: BaseException) -> bool:
            if task.owner is not None and not isinstance(error, InjectedCrash):
                self._take_death(task, error)
            return handle(task, error)

        return on_task_error

    def _take_death(self, task: Task, error: BaseException) -> None:
        assert self._mission is not None
        detail, now_ns = app_traceback(error), self._mission.kernel.now
        if task.owner.name in CORE_APPS:
            self.trouble.append(detail)
        elif isinstance(error, DeadlockError) and error.circle:
            where = detail.partition(f"\n{type(error).__module__}")[0]
            self._found.append(_deadlock(error.circle, now_ns, where, task.name))
        else:
            text = reason(error)
            cause = _cause(type(error).__name__, text)
            self._found.append(Failure(verdict.DIED, task.owner.name, text, now_ns, detail, task.name, cause))

    def _take_event(self, seen: Seen) -> None:
        event = DecodedEvent.of(seen)
        if event.event_type in self._levels and event.app not in CORE_APPS:
            assert self._mission is not None
            text = f"{event.type_name} event {event.event_id}: {event.text}"
            task = self._mission.kernel.current.name
            cause = f"event {event.event_id}"
            self._found.append(Failure(verdict.EVENT, event.app, text, seen.at_ns, task=task, cause=cause))


def _resets(mission: Mission) -> Iterator[Failure]:
    for reset in mission.record.resets:
        if reset.fault and InjectedCrash.__name__ not in reset.reason:
            yield Failure(verdict.RESET, "", reset.reason, reset.at_ns)


def _violations(mission: Mission) -> Iterator[Failure]:
    for each in mission.record.part(InvariantRecords).values():
        if each.first is not None:
            sender = f"sent by {each.first.sender}: " if each.first.sender else ""
            detail = f"{sender}{each.first.detail}"
            yield Failure(verdict.INVARIANT, each.name, each.first.text, each.first.at_ns, detail)


def _of_compiled_code(mission: Mission) -> Iterator[Failure]:
    """Accesses of compiled code that nothing orders, and memory that was written past."""
    for race in mission.record.data_races:
        yield Failure(verdict.RACE, race.app, race.text, race.at_ns, race.detail, race.task, race.cause)
    for each in mission.record.overwrites:
        yield Failure(verdict.OVERWRITE, each.app, each.text, each.at_ns)


def _missed(outcome: Outcome | None) -> Iterator[Failure]:
    """Steps of the script that did not go well; those that were never reached follow from the one before."""
    for each in () if outcome is None else outcome.verdicts:
        if not each.ok and each.detail != OVER:
            who = f"{outcome.file.rpartition('/')[2]}:{each.line}"  # type: ignore[union-attr]  # there are verdicts
            text = f"{each.step}: {each.detail}" if each.detail else each.step
            yield Failure(verdict.EXPECTATION, who, text, round(each.at_s * NS_PER_S), cause=each.step)


def _deadlock(circle: Sequence[Wait], at_ns: int, detail: str, task: str) -> Failure:
    """A circle that would have closed, if a mutex had not refused."""
    owners = dict.fromkeys(wait.task.owner.name for wait in circle if wait.task.owner is not None)
    return Failure(verdict.DEADLOCK, " and ".join(owners), "; ".join(map(str, circle)), at_ns, detail, task)


def _circle(circle: Sequence[EndlessWait]) -> Failure:
    """Tasks that wait for each other, or one that waits for another that has ended."""
    apps = " and ".join(dict.fromkeys(wait.app for wait in circle))
    text = "; ".join(f"{wait.task} waits for {wait.what}, held by {wait.holder}" for wait in circle)
    detail = "\n".join(wait.text for wait in circle)
    return Failure(verdict.DEADLOCK, apps, text, None, detail, circle[-1].task)


def _alone(waits: Sequence[EndlessWait], found: Sequence[Failure]) -> Iterator[Failure]:
    """Tasks that nobody is left to wake, unless something else took away who would have done it."""
    if not any(failure.kind in verdict.LEAVES_OTHERS_WAITING for failure in found):
        for wait in waits:
            yield Failure(verdict.STUCK, wait.app, wait.text, task=wait.task)


def _overruns(mission: Mission) -> Iterator[Failure]:
    for check in mission.record.part(DeadlineRecord).checks:
        result = check.result()
        if result.first_at_s is not None:
            text = f"{result.kind} {result.limit_text} was missed"
            at_ns, detail = round(result.first_at_s * NS_PER_S), result.problem or ""
            yield Failure(verdict.DEADLINE, result.owner, text, at_ns, detail, span_ns=check.limit_ns)


def _bad_ends(mission: Mission, found: list[Failure], crashed: set[str]) -> Iterator[Failure]:
    """Applications and nodes that ended themselves with an error, and did not die of an exception before."""
    dead = crashed | {failure.who for failure in found if failure.kind in (verdict.DIED, verdict.RAISED)}
    for name in ended_badly(mission):
        end = None if mission.ros is None else mission.ros.ended.get(name)
        if name not in dead and (end is None or end.name not in dead):
            yield Failure(verdict.ENDED, name, end_of(mission, name))


def _cause(kind: str, text: str) -> str:
    """What tells exceptions apart: the type, and the line where one came out, `KeyError (arm.py:12)`."""
    place = _PLACE_AT_END.search(text)
    return f"{kind} {place[0]}" if place is not None else ""


class _Reading:
    """The traceback that a node is printing."""

    def __init__(self) -> None:
        self.lines = [_BEGIN]
        self.place = ""


class TracebackReader:
    """Reads the console of a mission.

    Attributes:
        found: a failure for each traceback so far; of a chain of exceptions, the last.
    """

    def __init__(self) -> None:
        self.found: list[Failure] = []
        self._reading: dict[str, _Reading] = {}

    def take(self, line: str, now_ns: int, task: str = "") -> None:
        """Take a line of the console, the virtual time at which it was written, and the task that wrote it."""
        match = _LINE.fullmatch(line)
        if match is None:
            return
        node, text = match["node"], match["text"]
        if text.endswith(_BEGIN):
            self._reading[node] = _Reading()
        elif node in self._reading:
            self._go_on(node, text, now_ns, task)
        elif text.startswith(_CHAINED):
            self._forget_last(node)

    def _go_on(self, node: str, text: str, now_ns: int, task: str) -> None:
        reading = self._reading[node]
        reading.lines.append(text)
        frame = _FRAME.match(text)
        if frame is not None and reading.place and not is_own_code(frame["file"]):
            return
        if frame is not None:
            reading.place = f"{PurePath(frame['file']).name}:{frame['line']}"
        elif not text.startswith(" "):
            del self._reading[node]
            what = f"{text} ({reading.place})" if reading.place else text
            cause = _cause(text.partition(":")[0], what)
            self.found.append(Failure(RAISED, node, what, now_ns, "\n".join(reading.lines), task, cause))

    def _forget_last(self, node: str) -> None:
        """Drop the exception read last: its handler raised the one that follows, which is the error."""
        mine = [at for at, failure in enumerate(self.found) if failure.who == node]
        if mine:
            del self.found[mine[-1]]

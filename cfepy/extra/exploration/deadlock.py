"""Tasks that wait forever, although such a wait ends under fifo: a lost wake-up.

Only waits without a timeout count, for objects that other tasks release: locks, semaphores, conditions, a requested
message. An idle application waits for its pipe, so such waits do not count. A wait belongs to a place, the line of its
application's own source, so it does not matter which of several workers waits there.
"""

from __future__ import annotations

import re
import sys
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import PurePath
from types import FrameType
from typing import Any, NamedTuple

from cfepy.attachment import Attachment
from cfepy.extra.exploration.verdict import STUCK, Failure
from cfepy.interpreter.own_code import is_library, is_shown
from cfepy.mission import CORE_APPS, Mission
from cfepy.pilot import RunPlan, fly
from cfepy.rtos import Kernel, Policy, Task, wrapping
from cfepy.units import NS_PER_S

SHORTEST_NS = NS_PER_S // 10  # a shorter wait may have begun just before the end
FACTOR = 10  # a place is suspect when its idle time is this many times longer than ever under fifo
_AWAITED = re.compile(r"lock|semaphore|condition|mutex|readers of lock|writers of lock|a message on (?!pipe )")

WaitPlace = tuple[str, str]
"""Name of the application, and the object and place of the wait."""


class Left(NamedTuple):
    """A task that still waits at the end of the run.

    Attributes:
        place: the place where it waits.
        task: its name.
        since_ns: virtual time at which it began to wait.
        idle_ns: time since a task last continued from this place.
    """

    place: WaitPlace
    task: str
    since_ns: int
    idle_ns: int


@dataclass(frozen=True, slots=True)
class Waits:
    """The waits of a run.

    Attributes:
        longest_ns: by place, the longest time for which a task waited there and no task continued.
        left: the tasks that wait at the end.
    """

    longest_ns: Mapping[WaitPlace, int]
    left: tuple[Left, ...]


@dataclass(slots=True)
class _Account:
    """A place where tasks wait: the time since a task last continued while one waits, and the longest such time."""

    since_ns: int = 0
    longest_ns: int = 0
    begun: dict[Task, int] = field(default_factory=dict)


class WaitWatch(Attachment):
    """Records the waits of a run.

    Attributes:
        waits: the waits when the run's time is over; empty before.
    """

    def __init__(self) -> None:
        self.waits = Waits({}, ())
        self._accounts: dict[WaitPlace, _Account] = {}
        self._mission: Mission | None = None

    def kernel(self, base: type[Kernel]) -> type[Kernel]:
        """Wrap `block`, which every wait uses."""
        return wrapping(base, {"block": self._blocking})

    def begin(self, mission: Mission) -> None:
        self._mission = mission
        mission.kernel.frames_wanted = True

    def conclude(self) -> None:
        """Record the tasks that wait now."""
        assert self._mission is not None
        now = self._mission.kernel.now
        left: list[Left] = []
        for place, account in self._accounts.items():
            if account.begun:
                self._note(account, now)
                idle_ns = now - account.since_ns
                left += [Left(place, task.name, since_ns, idle_ns) for task, since_ns in account.begun.items()]
        self.waits = Waits({place: account.longest_ns for place, account in self._accounts.items()}, tuple(left))

    def _blocking(self, block: Callable[[Kernel], Any]) -> Callable[[Kernel], Any]:
        def wait(kernel: Kernel) -> Any:
            task = kernel.current
            waits = task.waits
            if waits is None or task.timer or not _AWAITED.match(waits.what) or _is_core(task):
                return block(kernel)
            place = (task.owner.name, place_of(sys._getframe(1), waits.what))
            account = self._accounts.setdefault(place, _Account())
            if not account.begun:
                account.since_ns = kernel.now
            account.begun[task] = kernel.now
            try:
                return block(kernel)
            finally:
                del account.begun[task]
                self._note(account, kernel.now)
                account.since_ns = kernel.now

        return wait

    @staticmethod
    def _note(account: _Account, now_ns: int) -> None:
        account.longest_ns = max(account.longest_ns, now_ns - account.since_ns)


def _is_core(task: Task) -> bool:
    return task.owner is None or task.owner.name in CORE_APPS


def place_of(frame: FrameType | None, what: str) -> str:
    """Return the awaited object without its number, and the innermost line of own source: `lock at arm.py:12`."""
    kind = what if what.startswith("a message") or "lock " not in what else "lock"
    last = ""
    while frame is not None:
        file = frame.f_code.co_filename
        if is_shown(file):
            line = f" at {PurePath(file).name}:{frame.f_lineno}"
            if not is_library(file):
                return kind + line
            last = last or line
        frame = frame.f_back
    return kind + last


def waits_of(plan: RunPlan, end_ns: int, policy: Policy | None) -> Waits:
    """Return the waits of a run that goes on for twice the time.

    Args:
        plan: the run.
        end_ns: virtual time at its end.
        policy: decides which task goes first.
    """
    watch = WaitWatch()
    fly(replace(plan, seconds=2 * end_ns / NS_PER_S), attachments=[watch], policy=policy)
    return watch.waits


def stuck(found: Waits, reference: Waits) -> tuple[Left, ...]:
    """Return the suspect waits at the end.

    A wait is suspect if two conditions hold. No task has continued from the place for much longer than ever in the
    reference. More tasks of the application are in such a wait than at the end of the reference.
    """
    usual = Counter(each.place[0] for each in _idle(reference))
    now = Counter(each.place[0] for each in _idle(found))
    return tuple(
        each
        for each in _idle(found)
        if now[each.place[0]] > usual[each.place[0]] and each.idle_ns > FACTOR * reference.longest_ns.get(each.place, 0)
    )


def _idle(waits: Waits) -> Iterator[Left]:
    return (each for each in waits.left if each.idle_ns >= SHORTEST_NS)


def stuck_for_good(
    found: Waits, reference: Waits, plan: RunPlan, end_ns: int, again: Callable[[], Policy | None]
) -> Iterator[Failure]:
    """Yield failures for tasks that are stuck, and are still stuck when the run goes on for as long again.

    Args:
        found: the waits of the run.
        reference: the waits under the default schedule, in twice the time (`waits_of`).
        plan: the run.
        end_ns: virtual time at its end.
        again: makes a policy that decides as in the run.
    """
    suspects = stuck(found, reference)
    if not suspects:
        return
    later = {(each.task, each.place, each.since_ns) for each in stuck(waits_of(plan, end_ns, again()), reference)}
    for each in suspects:
        if (each.task, each.place, each.since_ns) in later:
            yield _failure(each, reference.longest_ns.get(each.place))


def _failure(left: Left, usual_ns: int | None) -> Failure:
    app, what = left.place
    under_fifo = "it never waits there" if usual_ns is None else f"the longest wait there is {_s(usual_ns)} s"
    text = f"{left.task} waits forever for {what}, since {_s(left.since_ns)} s; under fifo {under_fifo}"
    return Failure(STUCK, app, text, task=left.task)


def _s(time_ns: int) -> str:
    return f"{time_ns / NS_PER_S:.6f}"

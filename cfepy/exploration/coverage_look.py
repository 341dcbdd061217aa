"""A look at a run for what it covers (`cfepy.exploration.coverage`); it changes nothing of the run."""

from __future__ import annotations

import sys
from collections import defaultdict
from collections.abc import Callable, Iterator
from types import FrameType

from cfepy.exploration import deeds as do
from cfepy.exploration.coverage import LINES, OUTCOMES, USES, Covered, ThingUse, number_of, number_of_line
from cfepy.exploration.deeds import Deed
from cfepy.exploration.result_watch import message_text
from cfepy.exploration.task_look import EVENT, TaskLook
from cfepy.mission import CORE_APPS, Mission, MissionSpec
from cfepy.monitors import Heard
from cfepy.nodes import WHOLE, Touch
from cfepy.own_code import is_own_code
from cfepy.rtos import Task, child_name

LOCKS, MESSAGES, VARIABLES = "locks", "messages", "variables"
_LOGS = ("/rosout", "/rosout_agg", EVENT)
"""Where all write, and what comes first matters to nobody."""
_KINDS = {
    **dict.fromkeys((do.HAS, do.SETS, do.CLEARS, do.NOTIFIES, do.AWAITS, do.WAKES, do.GIVES_UP), LOCKS),
    **dict.fromkeys((do.TAKES, do.GIVES), LOCKS),
    **dict.fromkeys((do.SENDS, do.GETS, do.LOSES, do.SUBSCRIBES, do.DELETES, do.RECEIVES), MESSAGES),
}
"""Kinds of pairs by what is done; parameters and counters, which are read and written, have kinds of their own."""
_ANY_KEY = "any"
_PIPE = "order of pipe "
_STAMPS = ("header.stamp", "header.seq")
_CORE_PACKETS = "CFE_"  # their names begin like this


_Seen = tuple[int, Task, str, str, int, bool]
"""A use of a thing, as it is seen: number of the use, who does what, file, line, whether it changes nothing."""


class _Thing:
    """A thing in a run: its last use, the last one that changed it, and the uses that were told."""

    __slots__ = ("changed", "last", "told")

    def __init__(self) -> None:
        self.last: _Seen | None = None
        self.changed: _Seen | None = None
        self.told: set[tuple[object, ...]] = set()


def _use_of(kind: str, thing: str, seen: _Seen) -> ThingUse:
    _, task, verb, file, line, is_read = seen
    return ThingUse(kind, thing, child_name(task), verb, file.rpartition("/")[2], line, is_read)


class CoverageLook(TaskLook):
    """Keeps what a run covers.

    Args:
        spec: the mission.
        decided: how many decisions there were until now.
    """

    def __init__(self, spec: MissionSpec, decided: Callable[[], int]) -> None:
        super().__init__(spec, sys.maxsize)  # no rows of a timeline
        self._decided = decided
        self._reached: set[str] = set()
        self._order = 0
        self._own: dict[Task, bool] = {}
        self._used: defaultdict[object, _Thing] = defaultdict(_Thing)
        self._pairs: dict[tuple[object, ...], Covered] = {}
        self._told: dict[ThingUse, int] = {}
        self._last: dict[str, Heard] = {}
        self._end: list[object] = []
        self.files: dict[str, bool] = {}

    def begin(self, mission: Mission) -> None:
        """See `Attachment.begin`."""
        super().begin(mission)
        mission.accesses.reached = self._reached
        self.files = mission.accesses.files

    def conclude(self) -> None:
        """See `Attachment.conclude`: what the shutdown of nodes does is no part of it."""
        super().conclude()
        assert self._mission is not None
        tasks = [task for task in self._mission.kernel.tasks if task.owner is not None]
        left = sorted(task.alias for task in tasks if task.owner.name not in CORE_APPS)
        messages = [(topic, message_text(heard, _STAMPS)) for topic, heard in sorted(self._last.items())]
        self._end = [left, messages]

    def covered(self, ended: object) -> Iterator[Covered]:
        """All that it covers.

        Args:
            ended: what else the outcome is made of.
        """
        decided = self._decided()
        yield Covered(OUTCOMES, number_of(ended, *self._end), decided)
        yield from self._pairs.values()
        yield from (Covered(USES, use.number, decision) for use, decision in self._told.items())
        for name in self._reached:
            file, _, line = name.rpartition(":")
            yield Covered(LINES, number_of_line(file, line), decided)

    @property
    def uses(self) -> tuple[ThingUse, ...]:
        """The uses of things, each once."""
        return tuple(self._told)

    # -- in place of what a timeline is made of ------------------------------------------------------------------------

    def _done(self, task: Task, verb: str, thing: str, frame: FrameType | None, note: str = "") -> Deed:
        """Something was done to a thing that has a name."""
        deed = Deed(0, task.name, "", verb, thing, "", note)
        if verb in (do.WANTS, do.RELEASES) or thing in _LOGS:
            return deed
        kind = _KINDS.get(verb) or f"{thing.partition(' ')[0]}s"
        said = f"{verb} {note}" if kind == LOCKS and note else verb
        file, line = _place_of(frame)
        self._follow(kind, thing, (self._next(), task, said, file, line, verb == do.READS), thing, (thing,))
        if verb == do.GETS:  # in which order messages of several kinds come out of one pipe
            pipe = f"{_PIPE}{note}"
            self._follow(kind, pipe, (self._next(), task, thing, file, line, False), pipe, (pipe,))
        return deed

    def _take_touch(self, touch: Touch) -> None:
        """A variable is accessed: there are many of these, so most of what is done here is done at once."""
        task, is_read, key = touch.task, not touch.is_write, touch.key
        is_own = self._own.get(task)
        if is_own is None:
            is_own = self._own[task] = task.owner is not None and task.owner.name not in CORE_APPS
        if not is_own or self._closed:
            return
        self._order = order = self._order + 1
        seen = (order, task, do.READS if is_read else do.WRITES, touch.code.co_filename, touch.line, is_read)
        if key == WHOLE:  # it is whatever is in it, too
            any_of_it = touch.thing, _ANY_KEY
            self._follow(VARIABLES, touch.name, seen, any_of_it, (any_of_it, (touch.thing, WHOLE)))
        elif key[0] == "[":  # an item
            own = touch.thing, key
            last = max(own, (touch.thing, WHOLE), key=lambda each: self._number(each, is_read))
            self._follow(VARIABLES, touch.name, seen, last, (own, (touch.thing, _ANY_KEY)))
        else:
            thing = self._used[touch.thing, key]
            before = thing.changed if is_read else thing.last
            thing.last = seen
            if not is_read:
                thing.changed = seen
            use = task, touch.line, is_read
            if use not in thing.told:
                thing.told.add(use)
                self._tell(VARIABLES, touch.name, seen)
            if before is not None and before[1] is not task:
                self._pair(VARIABLES, touch.name, before, seen)

    def _take_message(self, heard: Heard) -> None:
        task = self._watched()
        if task is None or self._closed or heard.topic in _LOGS:
            return
        self._done(task, do.SENDS, heard.topic, sys._getframe(1))
        if not heard.topic.startswith(_CORE_PACKETS):
            self._last[heard.topic] = heard

    # -- pairs ---------------------------------------------------------------------------------------------------------

    def _next(self) -> int:
        self._order += 1
        return self._order

    def _number(self, key: object, is_read: bool) -> int:
        """That of the use which another use follows."""
        thing = self._used[key]
        before = thing.changed if is_read else thing.last
        return -1 if before is None else before[0]

    def _follow(self, kind: str, name: str, seen: _Seen, looked: object, kept: tuple[object, ...]) -> None:
        """A use of a thing makes a pair with the one before, a mere look with the last change.

        Args:
            kind: of pairs.
            name: what the thing is called, in all runs.
            seen: what was done.
            looked: what it is in this run, by which it is found out who used it last.
            kept: what it is in this run, by which it is found later.
        """
        thing = self._used[looked]
        before = thing.changed if seen[5] else thing.last
        for each in kept:
            self._used[each].last = seen
            if not seen[5]:
                self._used[each].changed = seen
        if (name, *seen[1:]) not in thing.told:
            thing.told.add((name, *seen[1:]))
            self._tell(kind, name, seen)
        if before is not None and (before[1] is not seen[1] or name.startswith(_PIPE)):
            self._pair(kind, name, before, seen)

    def _tell(self, kind: str, name: str, seen: _Seen) -> None:
        self._told.setdefault(_use_of(kind, name, seen), self._decided())

    def _pair(self, kind: str, name: str, before: _Seen, seen: _Seen) -> None:
        pair = (kind, name, before[1:], seen[1:])
        if pair not in self._pairs:
            _, number = _use_of(kind, name, before).before(_use_of(kind, name, seen))
            self._pairs[pair] = Covered(kind, number, self._decided())


def _place_of(frame: FrameType | None) -> tuple[str, int]:
    """The innermost line of the mission's own code."""
    while frame is not None:
        if is_own_code(frame.f_code.co_filename):
            return frame.f_code.co_filename, frame.f_lineno
        frame = frame.f_back
    return "", 0

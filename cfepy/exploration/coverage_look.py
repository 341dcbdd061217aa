"""A look at a run for what it covers (`cfepy.exploration.coverage`); it changes nothing of the run."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from types import FrameType
from typing import NamedTuple

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


class _Seen(NamedTuple):
    """A use of a thing, as it is seen: who does what, in which line of which file."""

    order: int
    task: Task
    verb: str
    file: str
    line: int
    is_read: bool = False

    def told(self, kind: str, thing: str) -> ThingUse:
        return ThingUse(
            kind, thing, child_name(self.task), self.verb, self.file.rpartition("/")[2], self.line, self.is_read
        )


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
        self._latest: dict[object, _Seen] = {}
        self._changes: dict[object, _Seen] = {}
        self._pairs: dict[tuple[object, ...], Covered] = {}
        self._told: dict[tuple[object, ...], tuple[ThingUse, int]] = {}
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
        yield from (Covered(USES, use.number, decision) for use, decision in self._told.values())
        for name in self._reached:
            file, _, line = name.rpartition(":")
            yield Covered(LINES, number_of_line(file, line), decided)

    @property
    def uses(self) -> tuple[ThingUse, ...]:
        """The uses of things, each once."""
        return tuple(dict.fromkeys(use for use, _ in self._told.values()))

    # -- in place of what a timeline is made of ------------------------------------------------------------------------

    def _done(self, task: Task, verb: str, thing: str, frame: FrameType | None, note: str = "") -> Deed:
        """Something was done to a thing that has a name."""
        deed = Deed(0, task.name, "", verb, thing, "", note)
        if verb in (do.WANTS, do.RELEASES) or thing in _LOGS:
            return deed
        kind = _KINDS.get(verb) or f"{thing.partition(' ')[0]}s"
        said = f"{verb} {note}" if kind == LOCKS and note else verb
        use = self._use(task, said, *_place_of(frame), verb == do.READS)
        self._follow(kind, thing, use, [thing], [thing])
        if verb == do.GETS:  # in which order messages of several kinds come out of one pipe
            pipe = f"{_PIPE}{note}"
            self._follow(kind, pipe, use._replace(verb=thing), [pipe], [pipe])
        return deed

    def _take_touch(self, touch: Touch) -> None:
        task = self._watched()
        if task is None or not self._goes_on():
            return
        use = self._use(task, do.WRITES if touch.is_write else do.READS, touch.file, touch.line, not touch.is_write)
        key: object = (touch.thing, touch.key)
        all_of_it, any_of_it = (touch.thing, WHOLE), (touch.thing, _ANY_KEY)
        if touch.key == WHOLE:
            self._follow(VARIABLES, touch.name, use, [any_of_it], [all_of_it, any_of_it])
        elif touch.key.startswith("["):  # an item
            self._follow(VARIABLES, touch.name, use, [key, all_of_it], [key, any_of_it])
        else:
            self._follow(VARIABLES, touch.name, use, [key], [key])

    def _take_message(self, heard: Heard) -> None:
        task = self._watched()
        if task is None or self._closed or heard.topic in _LOGS:
            return
        self._done(task, do.SENDS, heard.topic, sys._getframe(1))
        if not heard.topic.startswith(_CORE_PACKETS):
            self._last[heard.topic] = heard

    # -- pairs ---------------------------------------------------------------------------------------------------------

    def _use(self, task: Task, verb: str, file: str, line: int, is_read: bool) -> _Seen:
        self._order += 1
        return _Seen(self._order, task, verb, file, line, is_read)

    def _follow(self, kind: str, name: str, use: _Seen, looked: Sequence[object], kept: Sequence[object]) -> None:
        """A use of a thing makes a pair with the one before, a mere look with the last change.

        Args:
            kind: of pairs.
            name: what the thing is called, in all runs.
            use: what was done.
            looked: what it is in this run, of which one is to be found out who used it last.
            kept: what it is in this run, by which it is found later.
        """
        if (kind, name, *use[1:]) not in self._told:
            self._told[kind, name, *use[1:]] = use.told(kind, name), self._decided()
        uses = self._changes if use.is_read else self._latest
        before = max((uses[each] for each in looked if each in uses), default=None)
        for each in kept:
            self._latest[each] = use
            if not use.is_read:
                self._changes[each] = use
        if before is None or (before.task is use.task and not name.startswith(_PIPE)):
            return
        pair = (kind, name, before[1:], use[1:])
        if pair not in self._pairs:
            _, number = before.told(kind, name).before(use.told(kind, name))
            self._pairs[pair] = Covered(kind, number, self._decided())


def _place_of(frame: FrameType | None) -> tuple[str, int]:
    """The innermost line of the mission's own code."""
    while frame is not None:
        if is_own_code(frame.f_code.co_filename):
            return frame.f_code.co_filename, frame.f_lineno
        frame = frame.f_back
    return "", 0

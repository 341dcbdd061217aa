"""`RaceWatch`: finds two unordered accesses of mission code to the same thing, at least one of them a write.

It observes one run with vector clocks (`cfepy.schedules.vector_clocks`). Tasks are ordered by passing something on: a
lock, a semaphore, a queue, a message, a table, the start of a task, the call of a waker. That one task happened to run
before another is not an order: on a computer with more cores, or with another load, they might run the other way round.
"""

from __future__ import annotations

import sys
from collections import deque
from collections.abc import Callable, Hashable
from pathlib import PurePath
from types import CodeType, FrameType
from typing import Any, NamedTuple

from cfepy.attachment import Attachment
from cfepy.mission import DataRace, Mission
from cfepy.nodes import WHOLE, Touch
from cfepy.rtos import Task
from cfepy.sb import Pipe, SoftwareBus, listened
from cfepy.schedules import ExploringKernel, Race, RaceSide, VectorClocks

Frames = tuple[tuple[CodeType, int], ...]
Key = Callable[[tuple[Any, ...]], Hashable]
"""Returns the objects by which a call orders tasks, from its arguments."""

_ANY_ITEM = "[*]"  # all items of a container


def _first(arguments: tuple[Any, ...]) -> Hashable:
    return "osal", arguments[0] if arguments else None


def _always(what: str) -> Key:
    return lambda arguments: what


_TABLES = ("get_address", "get_addresses", "release_address", "release_addresses", "load", "update", "manage")
LOCKS_GIVEN = ("release", "release_lock", "__exit__", "_release_save")
LOCKS_TAKEN = ("acquire", "acquire_lock", "__enter__", "_acquire_restore", "is_set")
_LETS_GO: dict[str, Key] = {
    **dict.fromkeys(
        (
            *("mut_sem_give", "bin_sem_give", "bin_sem_flush", "count_sem_give", "cond_var_unlock", "cond_var_signal"),
            *("cond_var_broadcast", "cond_var_wait", "cond_var_timed_wait", "rw_lock_read_give", "rw_lock_write_give"),
            "queue_put",
        ),
        _first,
    ),
    **dict.fromkeys(_TABLES, _always("tables")),
    **dict.fromkeys(("setParam", "deleteParam"), _always("parameters")),
    **dict.fromkeys(("run_loop", "wait_for_startup_sync", "wait_for_system_state"), _always("startup")),
}
"""Things passed on by service calls and calls of the parameter server: the receiver is ordered after the caller."""
_ASKING = ("getParam", "hasParam", "searchParam", "getParamNames")
_ENDING = ("delete_child_task", "task_delete")
_TAKES: dict[str, Key] = {
    **dict.fromkeys(
        (
            *("mut_sem_take", "bin_sem_take", "bin_sem_timed_wait", "count_sem_take", "count_sem_timed_wait"),
            *("cond_var_lock", "cond_var_wait", "cond_var_timed_wait", "rw_lock_read_take", "rw_lock_write_take"),
            "queue_get",
        ),
        _first,
    ),
    **dict.fromkeys(_TABLES, _always("tables")),
    **dict.fromkeys(("wait_for_startup_sync", "wait_for_system_state"), _always("startup")),
}
"""Things that returned calls have taken."""


class _Seen(NamedTuple):
    """Last access of a task: its clock, the access, the place, and the locks that make it exclude others."""

    clock: int
    touch: Touch
    frames: Frames
    at_ns: int
    locks: frozenset[int] = frozenset()


class _Place:
    """Accesses to one attribute, item or variable, by task: the last read and the last write."""

    __slots__ = ("reads", "writes")

    def __init__(self) -> None:
        self.reads: dict[Task, _Seen] = {}
        self.writes: dict[Task, _Seen] = {}


class RaceWatch(Attachment):
    """Finds the races of a run, and adds them to the mission's record. It needs a kernel that explores.

    Attributes:
        racing: numbers of the objects, and keys, with races.
    """

    def __init__(self) -> None:
        self.racing: set[tuple[int, str]] = set()
        self._clocks = VectorClocks()
        self._things: dict[int, dict[str, _Place]] = {}
        self._inner: set[int] = set()  # numbers of locks that do not order tasks
        self._told: set[str] = set()
        self._waiting: dict[Pipe, deque[tuple[bytes, dict[Task, int]]]] = {}
        self._mission: Mission | None = None
        self._is_over = False

    # -- what orders tasks ---------------------------------------------------------------------------------------------

    def bus(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
        made: type[SoftwareBus] = listened(base, self)
        return made

    def begin(self, mission: Mission) -> None:
        self._mission = mission
        kernel = mission.kernel
        assert isinstance(kernel, ExploringKernel)
        kernel.on_wake = self._woken
        kernel.watch(self)
        mission.accesses.observers.append(self._touched)
        mission.accesses.on_gone(self._gone)

    def conclude(self) -> None:
        """Stop: the shutdown of nodes is not checked."""
        self._is_over = True

    @property
    def _task(self) -> Task:
        assert self._mission is not None
        return self._mission.kernel.current

    def _woken(self, task: Task) -> None:
        """The running task wakes another one."""
        self._clocks.hand(self._task, task)

    def called(self, subject: Any, call: str, args: tuple[Any, ...]) -> None:
        if call == "__init__":
            self._made(subject)
        elif call in LOCKS_GIVEN:
            self._clocks.let_go(self._task, self._lock(subject))
        elif call == "is_done":
            self._clocks.take(self._task, self._lock(subject))
        elif call == "add_callback":
            self._clocks.let_go(self._task, ("began", self._task.owner))
        elif call in _ASKING:
            self._clocks.take(self._task, "parameters")
        elif call in _LETS_GO:
            self._clocks.let_go(self._task, _LETS_GO[call](args))

    def returned(self, subject: Any, call: str, args: tuple[Any, ...], result: Any) -> None:
        if call in LOCKS_TAKEN:
            if result is not False:
                self._clocks.take(self._task, self._lock(subject))
        elif call in _ENDING:
            self._clocks.take_ended(self._task)
        elif call in _TAKES and result is not False and (call != "queue_get" or result is not None):
            self._clocks.take(self._task, _TAKES[call](args))

    def failed(self, subject: Any, call: str) -> None:
        """The call has taken nothing, so it does not order tasks."""

    def _lock(self, lock: Any) -> Hashable:
        assert self._mission is not None
        number = self._mission.accesses.number(lock)
        return ("lock of its own", self._task) if number in self._inner else ("lock", number)

    def _made(self, lock: Any) -> None:
        """Python's own locks, for its lists of threads and log handlers, do not count as order."""
        assert self._mission is not None
        frame: FrameType | None = sys._getframe(2)
        while frame is not None and frame.f_globals.get("__name__", "").startswith("cfepy."):
            frame = frame.f_back
        module = "" if frame is None else frame.f_globals.get("__name__", "")
        while frame is not None and frame.f_back is not None and frame.f_back.f_globals.get("__name__") == module:
            frame = frame.f_back
        is_of_module = module == "threading" and frame is not None and frame.f_code.co_name == "<module>"
        if is_of_module or module.partition(".")[0] == "logging":
            self._inner.add(self._mission.accesses.number(lock))

    # -- messages: see `cfepy.sb.PacketListener` -----------------------------------------------------------------------

    def made(self, packet: bytes) -> None:
        """A packet was made."""

    def sent(self, packet: bytes) -> None:
        """A packet was sent."""

    def put(self, packet: bytes, pipe: Pipe) -> None:
        """A packet passes its sender's clock into a pipe."""
        self._waiting.setdefault(pipe, deque()).append((packet, self._clocks.send(self._task)))

    def dropped(self, packet: bytes, pipe: Pipe) -> None:
        """A packet is lost."""
        self._out(packet, pipe)

    def taken(self, packet: bytes, pipe: Pipe) -> None:
        """The running task took a packet; the callbacks it runs are those that were given to the node before."""
        task = self._task
        known = self._out(packet, pipe)
        if known is not None:
            self._clocks.receive(task, known)
        self._clocks.take(task, ("began", task.owner))

    def pipe_gone(self, pipe: Pipe, packets: list[bytes]) -> None:
        """A pipe was deleted."""
        self._waiting.pop(pipe, None)

    def _out(self, packet: bytes, pipe: Pipe) -> dict[Task, int] | None:
        """Return the clock that a packet in a pipe carries; for one changed by faults, the clock of the oldest."""
        waiting = self._waiting.get(pipe)
        if not waiting:
            return None
        for number, (each, known) in enumerate(waiting):
            if each is packet:
                del waiting[number]
                return known
        return waiting.popleft()[1]

    # -- accesses ------------------------------------------------------------------------------------------------------

    def _gone(self, thing: int) -> None:
        """An object was freed."""
        self._things.pop(thing, None)
        self._clocks.forget(("lock", thing))
        self._inner.discard(thing)

    def _touched(self, touch: Touch) -> None:
        if self._is_over:
            return
        assert self._mission is not None
        task, kernel = touch.task, self._mission.kernel
        known = self._clocks.of(task)
        places = self._things.get(touch.thing)
        if places is None:
            places = self._things[touch.thing] = {}
        place = places.get(touch.key)
        if place is None:
            place = places[touch.key] = _Place()
        mine = (place.writes if touch.is_write else place.reads).get(task)
        if mine is not None and mine.clock == known[task]:
            return  # later accesses of others were not missed: they were compared with this one
        seen = _Seen(known[task], touch, self._frames(), kernel.now, self._locks_of(task))
        self._compare(place, known, seen)
        key = touch.key
        other = places.get(_ANY_ITEM if key == WHOLE else WHOLE) if key[0] in "*[" else None
        if other is not None:
            self._compare(other, known, seen)
        self._keep(place, seen)
        if key[0] == "[":
            self._keep(places.setdefault(_ANY_ITEM, _Place()), seen)

    @staticmethod
    def _keep(place: _Place, seen: _Seen) -> None:
        (place.writes if seen.touch.is_write else place.reads)[seen.touch.task] = seen

    def _compare(self, place: _Place, known: dict[Task, int], now: _Seen) -> None:
        """Return whether another task has made an access there that is not ordered before this one."""
        mine = now.touch.task
        for seen in (place.writes, place.reads) if now.touch.is_write else (place.writes,):
            for task, before in seen.items():
                is_unordered = task is not mine and known.get(task, 0) < before.clock
                if is_unordered and before.locks.isdisjoint(now.locks):
                    self._found(before, now)
                    return

    def _locks_of(self, task: Task) -> frozenset[int]:
        """Return the locks that a task holds, if they exclude other tasks without ordering them."""
        return frozenset()

    def _frames(self) -> Frames:
        """Return the lines of mission code of the running task, from the innermost one up to its caller outside."""
        assert self._mission is not None
        files = self._mission.accesses.files
        found = []
        frame: FrameType | None = sys._getframe(2)
        while frame is not None:
            if frame.f_code.co_filename in files:
                found.append((frame.f_code, frame.f_lineno))
            elif found:
                break  # frames below cost time, and are rarely mission code
            frame = frame.f_back
        return tuple(found)

    def _found(self, before: _Seen, now: _Seen) -> None:
        self.racing |= {(each.touch.thing, each.touch.key) for each in (before, now)}
        name = " or ".join(sorted({before.touch.name, now.touch.name}))
        if name in self._told:
            return
        self._told.add(name)
        assert self._mission is not None
        task = now.touch.task
        who = task.owner.name if task.owner is not None else task.name
        race = Race(name, _side(before), _side(now), who, now.at_ns)
        self._mission.record.data_races.append(DataRace(*race.told(), cause=name))


def _side(seen: _Seen) -> RaceSide:
    """Return one side of a race."""
    places = [f"{code.co_qualname} ({PurePath(code.co_filename).name}:{line})" for code, line in seen.frames]
    here = places[0] if places else seen.touch.place
    return RaceSide(here, seen.touch.is_write, seen.touch.task.name, tuple(places[:0:-1]), seen.at_ns)

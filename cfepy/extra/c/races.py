"""Data races between tasks in code that was compiled with -fsanitize=thread, found while schedules are explored.

Two accesses of different tasks to the same memory, one of them a write, race when nothing orders them: no semaphore,
lock, message, table, or start of a task between the two. The engine compares accesses (`engine/races.c`); this module
records the order. If it is not known which task waited for which, all earlier operations count as ordered. So every
reported pair is a race, and some races may be missed. An access to memory that several tasks may use is also a
scheduling point.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Hashable
from typing import Any

from cfepy.extra.c.calls import Declarations
from cfepy.extra.c.engine import engine
from cfepy.extra.c.memory import CMemory
from cfepy.rtos import Task
from cfepy.schedules import ExploringKernel, Race, RaceSide

Key = Callable[[tuple[Any, ...]], Hashable]
"""Returns the key by which a call orders tasks, from its arguments."""
Told = tuple[int, int, bool, list[int]]
"""An access: its address in the code, number of the task, whether it writes, return addresses of its calls."""


def _first(arguments: tuple[Any, ...]) -> Hashable:
    first: Hashable = arguments[0]
    return first


def _message(arguments: tuple[Any, ...]) -> Hashable:
    return "message", bytes(arguments[0][:2])


def _always(what: str) -> Key:
    return lambda arguments: what


_LOCKS = {
    "OS_MutSemGive": "OS_MutSemTake",
    "OS_BinSemGive": "OS_BinSemTake",
    "OS_BinSemFlush": "OS_BinSemTimedWait",
    "OS_CountSemGive": "OS_CountSemTake",
    "OS_CondVarUnlock": "OS_CondVarLock",
    "OS_CondVarSignal": "OS_CondVarWait",
    "OS_CondVarBroadcast": "OS_CondVarTimedWait",
    "OS_RwLockReadGive": "OS_RwLockReadTake",
    "OS_RwLockWriteGive": "OS_RwLockWriteTake",
    "OS_QueuePut": "OS_QueueGet",
    "pthread_mutex_unlock": "pthread_mutex_lock",
}
"""Calls that release the object of their first parameter, and the calls that acquire it."""
_STARTING = (
    *("CFE_ES_CreateChildTask", "OS_TaskCreate", "OS_TaskInstallDeleteHandler", "OS_TimeBaseCreate", "OS_TimeBaseSet"),
    *("OS_TimerCreate", "OS_TimerAdd", "OS_TimerSet", "CFE_TIME_RegisterSynchCallback", "CFE_TBL_Register"),
)
"""Calls after which a function may run in another task."""
_ENDING = ("CFE_ES_DeleteChildTask", "OS_TaskDelete")
_TABLES = (
    *("CFE_TBL_GetAddress", "CFE_TBL_GetAddresses", "CFE_TBL_ReleaseAddress", "CFE_TBL_ReleaseAddresses"),
    *("CFE_TBL_Load", "CFE_TBL_Update", "CFE_TBL_Manage", "CFE_TBL_Modified", "CFE_TBL_Share", "CFE_TBL_Validate"),
)
_STARTED, _ENDED, _TABLE, _STARTUP = "started", "ended", "tables", "startup"

LETS_GO: dict[str, Key] = {
    **dict.fromkeys(_LOCKS, _first),
    "OS_CondVarWait": _first,
    "OS_CondVarTimedWait": _first,
    "CFE_SB_TransmitMsg": _message,
    **dict.fromkeys(_STARTING, _always(_STARTED)),
    **dict.fromkeys(_TABLES, _always(_TABLE)),
    "CFE_ES_RunLoop": _always(_STARTUP),
    "CFE_ES_WaitForStartupSync": _always(_STARTUP),
    "CFE_ES_WaitForSystemState": _always(_STARTUP),
}
"""Releases: a task that acquires the key later happens after the caller's earlier operations."""
TAKES: dict[str, Key] = {
    **dict.fromkeys(_LOCKS.values(), _first),
    "OS_CountSemTimedWait": _first,
    "pthread_mutex_trylock": _first,
    **dict.fromkeys(_ENDING, _always(_ENDED)),
    **dict.fromkeys(_TABLES, _always(_TABLE)),
    "CFE_ES_WaitForStartupSync": _always(_STARTUP),
    "CFE_ES_WaitForSystemState": _always(_STARTUP),
}
"""Acquisitions of a successful call."""


def _in_python(name: str) -> str:
    """Return the Python name of a function of OSAL or of SB: `mut_sem_give`."""
    return _CAPITAL.sub("_", name.removeprefix("OS_").removeprefix("CFE_SB_")).lower()


_CAPITAL = re.compile(r"(?<=[a-z])(?=[A-Z])")
_LETS_GO_IN_PYTHON = {
    _in_python(name): key for name, key in LETS_GO.items() if key in (_first, _message) and name[0].isupper()
}
_TAKES_IN_PYTHON = {_in_python(name): key for name, key in TAKES.items() if key is _first and name[0].isupper()}


class CompiledRaceWatch:
    """Records the order of the tasks of a processor, and takes the races that the engine finds.

    Args:
        kernel: the processor.
        table: the engine's table, which then reports accesses.
        declared: the API; some of its functions order tasks.
        memory: of C.
        place_of: returns the place of an address of code, in words.
        call_place: the same for a call; empty for a call outside of applications.
        describe: returns a description of an address of data, in words.
        on_race: gets each race once.
    """

    def __init__(
        self,
        kernel: ExploringKernel,
        table: Any,
        declared: Declarations,
        memory: CMemory,
        place_of: Callable[[int], str],
        call_place: Callable[[int], str],
        describe: Callable[[int], str],
        on_race: Callable[[Race], object],
    ) -> None:
        self._kernel = kernel
        self._memory = memory
        self._place_of = place_of
        self._call_place = call_place
        self._describe = describe
        self._on_race = on_race
        self._races = table.races = engine().Races(self._found)
        self._numbers: dict[Task, int] = {}
        self._names: dict[int, str] = {}
        self._things: dict[Hashable, int] = {}
        self._codes: dict[int, int] = {}
        self._seen: set[tuple[str, ...]] = set()
        for name in {*LETS_GO, *TAKES}:
            self._watch(declared, name, LETS_GO.get(name), TAKES.get(name))
        self._watch_messages(declared)
        self._watch_accesses(declared)
        kernel.watch(self)

    def close(self) -> None:
        """Stop at the end of the processor."""
        self._kernel.unwatch(self)

    # -- calls of Python tasks: see `cfepy.rtos.CallObserver` ----------------------------------------------------------

    def called(self, subject: Any, call: str, args: tuple[Any, ...]) -> None:
        """Record that a service call, from C or Python, releases its object."""
        key = _LETS_GO_IN_PYTHON.get(call)
        if key is not None and args:
            self._let_go(key(args))

    def returned(self, subject: Any, call: str, args: tuple[Any, ...], result: Any) -> None:
        """Record that a service call has acquired its object."""
        key = _TAKES_IN_PYTHON.get(call)
        if call == "receive_buffer" and result is not None:
            self._take(_message((result,)))
        elif key is not None and args and result is not False and (call != "queue_get" or result is not None):
            self._take(key(args))

    def failed(self, subject: Any, call: str) -> None:
        """Do nothing: a failed call acquires nothing."""

    # -- order ---------------------------------------------------------------------------------------------------------

    def begin(self, code: Hashable) -> int:
        """Record that the current task calls C in an object, after the task's start. Returns the task's number."""
        self._take(_STARTED)
        number = self._number()
        if number not in self._codes:
            self._codes[number] = thing = self._thing(code)
            self._races.enter(number, thing)
        return number

    def leave(self, task: Task) -> None:
        """Record that a task has returned from C for good."""
        number = self._numbers.pop(task, None)
        if number is not None:
            self._races.let_go(number, self._thing(_ENDED))
            self._races.leave(number, self._codes.pop(number))

    def has_prepared(self) -> None:
        """Record that an object was loaded; its memory is ready for tasks that start later."""
        self._let_go(_STARTED)

    def _number(self) -> int:
        task = self._kernel.current
        number = self._numbers.get(task)
        if number is None:
            number = self._numbers[task] = int(self._races.task())
            self._names[number] = task.name
        return number

    def _thing(self, key: Hashable) -> int:
        thing = self._things.get(key)
        if thing is None:
            thing = self._things[key] = int(self._races.thing())
        return thing

    def _let_go(self, key: Hashable) -> None:
        self._races.let_go(self._number(), self._thing(key))

    def _take(self, key: Hashable) -> None:
        self._races.take(self._number(), self._thing(key))

    def _watch(self, declared: Declarations, name: str, lets_go: Key | None, takes: Key | None) -> None:
        """Replace a function of the API by one that records the order and calls it."""
        call = declared.functions[name].function
        assert call is not None

        def ordered(*arguments: Any) -> Any:
            if lets_go is not None:
                self._let_go(lets_go(arguments))
            result = call(*arguments)
            if takes is not None:
                self._take(takes(arguments))
            return result

        declared.functions[name] = declared.functions[name]._replace(function=ordered)

    def _watch_messages(self, declared: Declarations) -> None:
        """Record the order by messages, by their MsgId. A sent buffer has it in its first bytes."""
        send = declared.functions["CFE_SB_TransmitBuffer"]
        receive = declared.functions["CFE_SB_ReceiveBuffer"]
        assert send.function is not None
        assert receive.function is not None
        transmit, get = send.function, receive.function

        def transmit_buffer(address: int, is_origination: bool) -> Any:
            if address:
                self._let_go(_message((self._memory.peek(address, 2),)))
            return transmit(address, is_origination)

        def receive_buffer(*arguments: Any) -> Any:
            packet = get(*arguments)
            if packet is not None:
                self._take(_message((packet,)))
            return packet

        declared.functions["CFE_SB_TransmitBuffer"] = send._replace(function=transmit_buffer)
        declared.functions["CFE_SB_ReceiveBuffer"] = receive._replace(function=receive_buffer)

    # -- accesses ----------------------------------------------------------------------------------------------------

    def _watch_accesses(self, declared: Declarations) -> None:
        """Add scheduling points: the engine calls Python before an access to memory that several tasks use."""
        declared.add("__cxa_guard_release", "p", self._order_atomics)
        for name in [each for each in declared.functions if each.startswith("__tsan_")]:
            if name.startswith("__tsan_atomic"):
                declared.add(name, "p", self._order_atomics)
            else:
                declared.add(name, "", self._kernel.point)
        for name in [each for each, function in declared.functions.items() if function.function is None]:
            declared.add(name, "", self._kernel.point)  # such as memcpy: the engine calls it only for an access

    def _order_atomics(self, address: int) -> None:
        self._kernel.point()
        self._take(("atomic", address))
        self._let_go(("atomic", address))

    def _side(self, pc: int, number: int, is_write: bool, returns: list[int]) -> RaceSide:
        """Return one side of a race from the engine's data."""
        calls = [self._call_place(each - 1) for each in returns[::-1]]
        return RaceSide(self._place_of(pc), is_write, self._names[number], tuple(each for each in calls if each))

    def _found(self, address: int, before: Told, now: Told) -> None:
        sides = [self._side(*before), self._side(*now)]
        what = self._describe(address)
        places = (what, *sorted(side.place for side in sides))
        if places in self._seen:
            return
        self._seen.add(places)
        task = self._kernel.current
        who = task.owner.name if task.owner is not None else task.name
        self._on_race(Race(what, sides[0], sides[1], who, self._kernel.now))

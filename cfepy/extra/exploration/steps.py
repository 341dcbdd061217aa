"""The steps of a run: what each task did between two places where others could have got in, and what it touched.

A step has a name that does not depend on the order of the others: the path of its task (which child of which task it
is), how many places the task had passed, and which step it is between two of them. A place is where code calls
something, or uses CPU time; within a call a step ends where it makes another task ready, or waits.

Two steps depend on each other when they touch one thing and one of them changes it, or when both take one lock; a step
depends on the one that woke its task. All else may be swapped without any difference. Where two things share a name,
more steps depend on each other than need to: that costs flights, and misses nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from cfepy.rtos import PLACE, Kernel, Task, wrapping
from cfepy.schedules import ExploringKernel

PLACES = ("point", "charge", "yield_cpu")
TIMER, OVERTAKING = -1, -2
READS, WRITES, TAKES, GIVES, TRIES = "reads", "writes", "takes", "gives", "tries"
HANDED, ENDS, PENDS = "handed", "ends", "pends"
Touched = tuple[str, str]
"""The name of a thing, and what becomes of it: READS and WRITES of data, TAKES and GIVES of locks, TRIES in vain.

Of a lock that the step was HANDED by who woke it, it is who had taken it last that counts. The thing that a step ENDS
is a task, by its path; a last step of that task, which it might have made before, PENDS.
"""


def state_of(lock: str) -> str:
    """The thing that is whether somebody has a lock; whoever need not wait for it finds that out, and WRITES it."""
    return f"state of {lock}"


class TaskStep(NamedTuple):
    """A step, or several of one task in a row of which only the last one touches anything.

    Attributes:
        task: the path of its task.
        number: what the task had passed (`cfepy.rtos.Task`).
        touched: in order.
        ready: how many steps of the run were over when its task became ready; 0 where it never waited.
        waker: number of the step in the run that woke the task; TIMER for none, OVERTAKING where its time came while
            others had something to do: then it is the time that they use which decides who comes first.
        app: whose task it is.
        joined: whether nobody could get in between the step before it and this one.
    """

    task: str
    number: int
    touched: tuple[Touched, ...] = ()
    ready: int = 0
    waker: int = TIMER
    app: str = ""
    joined: bool = False

    @classmethod
    def of(cls, plain: Sequence[Any]) -> TaskStep:
        """A step from plain data."""
        task, number, touched, ready, waker, app, joined = plain
        pairs = tuple((str(thing), str(how)) for thing, how in touched)
        return cls(str(task), int(number), pairs, int(ready), int(waker), str(app), bool(joined))


@dataclass(slots=True)
class _Call:
    """What a task is in the middle of.

    Attributes:
        things: what it touches.
        wanted: a lock that it is to get; empty for none.
        began: what the step in which it began has touched.
        has_waited: whether it had to wait.
        is_noted: whether its steps since have touched the things.
        noted: what the last step has touched that did.
        depth: how many calls it is, each within the one before.
    """

    things: list[Touched]
    wanted: str = ""
    began: dict[Touched, None] | None = None
    has_waited: bool = False
    is_noted: bool = True
    noted: dict[Touched, None] | None = None
    depth: int = 1


_Entry = tuple[Task, int, dict[Touched, None], int, int, bool]
"""A step as it is being made; see `TaskStep`."""


class StepLog:
    """Keeps the steps of a run, of a kernel of the class that it derives.

    Args:
        from_ns: virtual time from which on steps are kept; before it places are only counted.
    """

    def __init__(self, from_ns: int = 0) -> None:
        self._is_open = False
        self._kernel: ExploringKernel
        self._from_ns = from_ns
        self._log: list[_Entry] = []
        self._idle = 0  # how many steps were over when nobody had anything to do the last time
        self._gone: set[Task] = set()
        self._lasting: dict[Task, dict[Touched, None]] = {}  # what a task touches in each step
        self._shut: Task | None = None  # the one that made the last step, if nobody could get in since
        self._ready: dict[Task, tuple[int, int]] = {}  # when and by which step it was woken, until its next step
        self._calls: dict[Task, _Call] = {}
        self._quiet: dict[Task, int] = {}  # in the middle of what makes others ready, if somebody waits

    def kernel(self, base: type[Kernel]) -> type[Kernel]:
        """A class of kernel that tells of its steps.

        Args:
            base: the class to start from.
        """
        return wrapping(
            base,
            {
                **dict.fromkeys(PLACES, self._passing),
                "make_ready": self._quietly,
                "wake_all": self._quietly,
                "preempt": self._quietly_in_parts,
                "enqueue": self._woken,
                "wait_on": self._waiting,
                "kill": self._ending,
                "_time_out": self._timed_out,
                "_advance": self._idling,
            },
        )

    def begin_with(self, kernel: ExploringKernel) -> None:
        """This is the kernel; nothing of it has run, and what was made with it before is no step."""
        self._kernel = kernel
        self._is_open = True

    @property
    def steps(self) -> tuple[TaskStep, ...]:
        """In the order in which they were made."""
        self._try()
        return tuple(
            TaskStep(task.path, number, tuple(touched), ready, waker, getattr(task.owner, "name", ""), joined)
            for task, number, touched, ready, waker, joined in self._log
        )

    def touch(self, thing: str, how: str = WRITES) -> None:
        """The current task touches something.

        Args:
            thing: its name.
            how: READS, WRITES, TAKES or GIVES.
        """
        step = self._step()
        if step is not None:
            if how in (TAKES, GIVES):  # of several in one step it is the last one that counts
                step[2].pop((thing, how), None)
            step[2][thing, how] = None

    def touch_from_now_on(self, thing: str) -> None:
        """The current task may read something in any step from now on."""
        self._lasting.setdefault(self._kernel.current, {})[thing, READS] = None
        self.touch(thing, READS)

    def begin(self, things: Iterable[Touched], wanted: str = "") -> None:
        """The current task begins something that touches these things, in this step and in those after other places.

        Args:
            things: what it touches.
            wanted: a lock that it takes, if it comes to its end; empty for none.
        """
        task = self._kernel.current
        outer = self._calls.get(task)
        if outer is not None:  # a call within a call is a part of that
            outer.depth += 1
            outer.things += [each for each in things if each not in outer.things]
            self._note(outer)
            return
        step = self._step() if wanted else None
        call = self._calls[task] = _Call(list(things), wanted, None if step is None else step[2])
        self._note(call)

    def end(self) -> bool:
        """The current task has come to the end of it; whether it is not in the middle of another one now."""
        call = self._calls.get(self._kernel.current)
        if call is None:
            return True
        call.depth -= 1
        if call.depth:
            return False
        del self._calls[self._kernel.current]
        if not call.is_noted:
            self._note(call)
        if call.wanted and call.has_waited:
            self.touch(call.wanted, HANDED)
        return True

    def part(self) -> None:
        """The current task begins another step, also where nobody was woken in the one before."""
        self._kernel.current.passed += 1

    def close(self) -> None:
        """What comes from now on is no part of it."""
        self._try()
        self._is_open = False

    def _try(self) -> None:
        """Calls that are not over have tried what they were to get."""
        for call in self._calls.values():
            _has_tried(call)

    def leave(self, task: Task) -> None:
        """What a task does from now on matters to nobody."""
        self._gone.add(task)

    def fail(self) -> None:
        """As `end`, without what it wanted."""
        call = self._calls.get(self._kernel.current)
        if self.end() and call is not None:
            _has_tried(call)

    @property
    def is_in_a_call(self) -> bool:
        """Whether the current task is in the middle of something."""
        return self._kernel.current in self._calls

    def _note(self, call: _Call) -> None:
        """Its step touches the things; a lock is given back in the last one, whatever comes between."""
        call.is_noted = True
        step = self._step()
        if step is None:
            return
        is_given = any(how == GIVES for _, how in call.things)
        for touched in call.things:
            if is_given and call.noted is not None:
                call.noted.pop(touched, None)
            if is_given:
                step[2].pop(touched, None)
            step[2][touched] = None
        call.noted = step[2]

    @property
    def _runner(self) -> Task:
        """The current task; the one that ends it, if it is being ended: nobody gets in until it has."""
        task = self._kernel.current
        while task.dying and task.killer is not None:
            task = task.killer
        return task

    def _step(self) -> _Entry | None:
        """The step that the current task makes; None where none are kept."""
        if not self._is_open:
            return None
        kernel, log = self._kernel, self._log
        task = self._runner
        if kernel.now < self._from_ns or task is kernel.host or kernel.current in self._gone:
            return None
        is_shut, self._shut = self._shut is task, task
        if log and log[-1][0] is task:
            if log[-1][1] == task.passed:
                return log[-1]
            if not log[-1][2]:  # it touched nothing: this one goes on where that began
                log[-1] = (task, task.passed, *log[-1][2:5], log[-1][5] and is_shut)
                return log[-1]
        touched = dict(self._lasting.get(task, {}))
        log.append((task, task.passed, touched, *self._ready.pop(task, (0, TIMER)), is_shut))
        return log[-1]

    # -- what the kernel does ------------------------------------------------------------------------------------------

    def _passing(self, original: Callable[..., Any]) -> Callable[..., Any]:
        def passing(kernel: ExploringKernel, *args: Any) -> Any:
            task = kernel.current
            is_quiet = self._quiet.get(task)
            if not is_quiet:
                self._step()
            if not kernel.is_hushed:
                self._shut = None
            if is_quiet:
                return original(kernel, *args)
            call = self._calls.get(task)
            task.passed += 1 if call is not None else PLACE - task.passed % PLACE
            result = original(kernel, *args)
            if call is not None:
                self._note(call)
            return result

        return passing

    def _quietly_in_parts(self, original: Callable[..., Any]) -> Callable[..., Any]:
        return self._quietly(original, parts=True)

    def _quietly(self, original: Callable[..., Any], parts: bool = False) -> Callable[..., Any]:
        def quietly(kernel: Kernel, *args: Any) -> Any:
            task = kernel.current
            self._quiet[task] = self._quiet.get(task, 0) + 1
            task.passed += parts  # whether somebody waited or not
            try:
                return original(kernel, *args)
            finally:
                self._quiet[task] -= 1

        return quietly

    def _woken(self, original: Callable[..., Any]) -> Callable[..., Any]:
        def enqueue(kernel: Kernel, task: Task, value: Any) -> None:
            step = self._step()
            if step is None:
                self._ready[task] = 0, TIMER
            else:
                step[2][f"wakes {task.path}", READS] = None  # no conflict by itself
                self._ready[task] = len(self._log), len(self._log) - 1
                self._kernel.current.passed += 1
            original(kernel, task, value)

        return enqueue

    def _ending(self, original: Callable[..., None]) -> Callable[..., None]:
        def kill(kernel: Kernel, task: Task) -> None:
            step = None if task is self._kernel.current or task.done or task in self._gone else self._step()
            if step is not None:
                step[2][task.path, ENDS] = None
                if not self._kernel.is_waiting(task):
                    self._log.append((task, task.passed, {(task.path, PENDS): None}, 0, TIMER, False))
                    self._kernel.current.passed += 1
            original(kernel, task)

        return kill

    def _timed_out(self, original: Callable[..., Any]) -> Callable[..., Any]:
        def time_out(kernel: Kernel, task: Task) -> None:
            self._ready[task] = len(self._log), OVERTAKING if self._idle < len(self._log) else TIMER
            original(kernel, task)

        return time_out

    def _idling(self, original: Callable[[Kernel], Task]) -> Callable[[Kernel], Task]:
        def advance(kernel: Kernel) -> Task:
            self._idle = len(self._log)
            return original(kernel)

        return advance

    def _waiting(self, original: Callable[..., Any]) -> Callable[..., Any]:
        def wait_on(kernel: Kernel, *args: Any) -> Any:
            task = kernel.current
            self._step()
            task.passed += 1
            self._shut = None
            result = original(kernel, *args)
            if task in self._calls:
                self._calls[task].is_noted, self._calls[task].has_waited = False, True
            return result

        return wait_on


def _has_tried(call: _Call) -> None:
    """It never came to its end: what it wanted somebody else had, and might have had later."""
    if call.wanted and call.began is not None:
        call.began[call.wanted, TRIES] = None

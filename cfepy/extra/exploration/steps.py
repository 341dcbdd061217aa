"""The steps of a run: the operations of a task between two preemption points, with their accesses.

The name of a step does not depend on the order of the others. It has the path of its task (which child of which task it
is) and the number of places that the task had passed. It also has the number of the step between two places. A place is
a call in the code, or a use of CPU time. Within a call, a step ends where it makes another task ready, or waits.

Two steps depend on each other when both access one object and one of them changes it, or when both take one lock. A
step depends on the step that woke its task. All other steps may be swapped without any difference. If two objects share
a name, more steps depend on each other than necessary. That costs flights, but misses nothing.
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
"""The name of an object, and the access: READS and WRITES of data, TAKES and GIVES of locks, TRIES in vain.

If the waking task HANDED a lock to the step, the step depends on the task that had taken the lock last. The object that
a step ENDS is a task, by its path. A last step of that task, which it might have made before, PENDS.
"""


def state_of(lock: str) -> str:
    """Return the name of a lock's state (free or taken). A task that tries a lock without a wait WRITES the state."""
    return f"state of {lock}"


class TaskStep(NamedTuple):
    """A step, or several successive steps of one task of which only the last one accesses anything.

    Attributes:
        task: the path of its task.
        number: the task's count of passed places (`cfepy.rtos.Task`).
        touched: in order.
        ready: number of finished steps of the run when its task became ready; 0 if it never waited.
        waker: number of the step in the run that woke the task; TIMER for none, OVERTAKING if its time came while other
            tasks had work: then the time that they use decides which comes first.
        app: application of the task.
        joined: whether no task could run between the previous step and this one.
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
        """Return a step from plain data."""
        task, number, touched, ready, waker, app, joined = plain
        pairs = tuple((str(thing), str(how)) for thing, how in touched)
        return cls(str(task), int(number), pairs, int(ready), int(waker), str(app), bool(joined))


@dataclass(slots=True)
class _Call:
    """A call that a task is in.

    Attributes:
        things: the objects that it accesses.
        wanted: a lock that it waits for; empty for none.
        began: the accesses of the step in which it began.
        has_waited: whether it had to wait.
        is_noted: whether its steps since then include the accesses.
        noted: the accesses of the last step that includes them.
        depth: number of nested calls.
    """

    things: list[Touched]
    wanted: str = ""
    began: dict[Touched, None] | None = None
    has_waited: bool = False
    is_noted: bool = True
    noted: dict[Touched, None] | None = None
    depth: int = 1


_Entry = tuple[Task, int, dict[Touched, None], int, int, bool]
"""A step under construction; see `TaskStep`."""


class StepLog:
    """Keeps the steps of a run, for the kernel class that `kernel` derives.

    Args:
        from_ns: virtual time from which steps are kept; before it places are only counted.
    """

    def __init__(self, from_ns: int = 0) -> None:
        self._is_open = False
        self._kernel: ExploringKernel
        self._from_ns = from_ns
        self._log: list[_Entry] = []
        self._idle = 0  # number of steps when no task was ready the last time
        self._gone: set[Task] = set()
        self._lasting: dict[Task, dict[Touched, None]] = {}  # accesses of a task in each step
        self._shut: Task | None = None  # task of the last step, if no task could run since
        self._ready: dict[Task, tuple[int, int]] = {}  # when and by which step it was woken, until its next step
        self._calls: dict[Task, _Call] = {}
        self._quiet: dict[Task, int] = {}  # depth of kernel calls that wake tasks

    def kernel(self, base: type[Kernel]) -> type[Kernel]:
        """Return a kernel class that reports its steps.

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
        """Set the kernel before it runs. Operations before this call are not steps."""
        self._kernel = kernel
        self._is_open = True

    @property
    def steps(self) -> tuple[TaskStep, ...]:
        """The steps in the order in which they were made."""
        self._try()
        return tuple(
            TaskStep(task.path, number, tuple(touched), ready, waker, getattr(task.owner, "name", ""), joined)
            for task, number, touched, ready, waker, joined in self._log
        )

    def touch(self, thing: str, how: str = WRITES) -> None:
        """Record an access of the current task.

        Args:
            thing: name of the object.
            how: READS, WRITES, TAKES or GIVES.
        """
        step = self._step()
        if step is not None:
            if how in (TAKES, GIVES):  # of several in one step the last one counts
                step[2].pop((thing, how), None)
            step[2][thing, how] = None

    def touch_from_now_on(self, thing: str) -> None:
        """Record that the current task may read an object in any step from now on."""
        self._lasting.setdefault(self._kernel.current, {})[thing, READS] = None
        self.touch(thing, READS)

    def begin(self, things: Iterable[Touched], wanted: str = "") -> None:
        """Begin a call of the current task that has these accesses, in this step and in later ones.

        Args:
            things: the accesses.
            wanted: a lock that it takes if it completes; empty for none.
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
        """End the call of the current task. Returns False if it is still in an outer call."""
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
        """Begin another step of the current task, even if the last one woke no task."""
        self._kernel.current.passed += 1

    def close(self) -> None:
        """Stop recording. Later operations are not part of the log."""
        self._try()
        self._is_open = False

    def _try(self) -> None:
        """Record that unfinished calls have tried to take their locks."""
        for call in self._calls.values():
            _has_tried(call)

    def leave(self, task: Task) -> None:
        """Stop recording a task, because its later operations do not matter."""
        self._gone.add(task)

    def fail(self) -> None:
        """End a call as `end` does, without the wanted lock."""
        call = self._calls.get(self._kernel.current)
        if self.end() and call is not None:
            _has_tried(call)

    @property
    def is_in_a_call(self) -> bool:
        """Whether the current task is in a call."""
        return self._kernel.current in self._calls

    def _note(self, call: _Call) -> None:
        """Add the accesses of a call to its step. A release of a lock belongs to the last step of the call."""
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
        """The current task; if another task is ending it, that task: no task can run until it has ended."""
        task = self._kernel.current
        while task.dying and task.killer is not None:
            task = task.killer
        return task

    def _step(self) -> _Entry | None:
        """Return the current task's step, or None if steps are not kept."""
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
            if not log[-1][2]:  # it accessed nothing, so this step continues it
                log[-1] = (task, task.passed, *log[-1][2:5], log[-1][5] and is_shut)
                return log[-1]
        touched = dict(self._lasting.get(task, {}))
        log.append((task, task.passed, touched, *self._ready.pop(task, (0, TIMER)), is_shut))
        return log[-1]

    # -- kernel methods ------------------------------------------------------------------------------------------------

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
            task.passed += parts  # even if no task waited
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
    """Record that an unfinished call tried a lock of another task, which it might have taken later."""
    if call.wanted and call.began is not None:
        call.began[call.wanted, TRIES] = None

"""The stall watch: a thread of the host that ends a run in which a task does not give up the CPU.

The simulation cannot do that itself: while a task computes, nothing else runs, and virtual time stands still. So a
thread watches. It changes nothing in a run that continues. A run that it ends has failed.

A stall is a virtual clock that stands still while the run's threads use the CPU for a given number of seconds. Either
one task computes, or tasks make calls that cost nothing, a thousand or more a second. For longer computations, raise
the limit. A task that waits for something outside of the simulation, such as `input()` or a debugger, uses no CPU and
is only reported. Only CPU time of the run counts: no other program, and no other thread of this process, can end it.
"""

from __future__ import annotations

import contextlib
import linecache
import os
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from types import CodeType, FrameType
from typing import TYPE_CHECKING, NamedTuple

from cfepy.rtos.context import frame_of_thread, insist, raise_in_thread
from cfepy.rtos.kernel import Kernel
from cfepy.rtos.stall_signals import LastResort, Waker
from cfepy.rtos.task import Task, TaskExit
from cfepy.status import StallError
from cfepy.units import instant_text
from cfepy.writing.escapes import visible

if TYPE_CHECKING:
    from cfepy.rtos.cpu_time import Spent

STALL_S = 10.0
LOOK_S, SOON_S = 0.25, 0.05  # wall time between two checks; the second while the run is being ended
# CPU time, or wall time for a task that uses no CPU:
GRACE_S = 0.6  # between the user's request and the end of the run
SPUN_S = 0.3  # part of it without a call, after which the user gets a report
END_S = 0.8  # for all tasks of a broken-off run to end
PRESS_S = 0.15  # part of it for each task
BUSY = 0.1  # minimum share of a CPU that this process uses, or could use, while a task computes
TURNS_PER_S = 1000  # this many calls that let another task run, while the clock stands still, are also a stall
LOOKS, LOOK_AGAIN_S = 12, 0.01  # samples of a spinning task, to find its loop; time between them
POLL_S = 0.002
LINES = 5
SPARE_S = 2.0  # CPU time above the limit before the last resort
COLLECTOR = "a finalizer"


def to_stderr(text: str) -> None:
    """Write a report to standard error, the default."""
    sys.stderr.write(visible(text) + "\n")
    sys.stderr.flush()


class StallWatch:
    """Watches a kernel, from the first `begin` to `end`.

    Args:
        kernel: the kernel to watch.
        limit_s: CPU time in s that the run may use while the virtual clock stands still; 0 for no limit. A task that
            uses no CPU is reported after so many seconds of wall time.
        is_own: whether a source file belongs to the user, not to the simulator or a library.
        tell: gets the report about a task that waits for something outside of the simulation.

    Attributes:
        limit_s: the limit; it may be changed before the first `begin`.
        wanted: returns whether the user wants the run to end; a run that does not end soon is then broken off.
        on_lost: called in the watch's thread if only the end of the process can end a finalizer or a task on the host's
            own thread.
        last_resort: ends the process if this thread can no longer run; None for never.
        spent: measures the time that this process has used.
    """

    def __init__(
        self,
        kernel: Kernel,
        limit_s: float = STALL_S,
        is_own: Callable[[str], bool] = lambda file: True,
        tell: Callable[[str], object] = to_stderr,
    ) -> None:
        self.limit_s = limit_s
        self.wanted: Callable[[], bool] = lambda: False
        self.on_lost: Callable[[BaseException], object] = self._tell_lost
        self.last_resort: LastResort | None = None
        self.spent: Callable[[], Spent] = self._measure_first
        self._kernel = kernel
        self._is_own = is_own
        self._tell = tell
        self._over = threading.Event()
        self._thread: threading.Thread | None = None
        self._process = 0  # the process of the watching thread
        self._host_ident = self._host_native = 0
        self._waker = Waker()
        self._is_paused = self._has_lost = self._was_wanted = False
        self._stand: _Stand | None = None
        self._before: Spent | None = None
        self._wanted_s = self._ending_s = 0.0

    def begin(self) -> None:
        """Start watching; the calling thread is about to run the kernel. Cheap after the first call, for runs in many
        parts.

        A forked process has none of its parent's threads, so watching starts anew. Observations from the previous part
        are dropped.
        """
        self._host_ident, self._host_native = threading.get_ident(), threading.get_native_id()
        self._stand = None
        if self._process != os.getpid():
            self._process = os.getpid()
            self._arm()
            self._over = threading.Event()
            self._waker.begin()
            self._thread = threading.Thread(target=self._look_on, name="cfepy stall watch", daemon=True)
            self._thread.start()

    @property
    def is_on(self) -> bool:
        """Whether the watching thread is alive."""
        return self._thread is not None and self._thread.is_alive()

    def end(self) -> None:
        """Stop watching."""
        self._over.set()
        self._process = 0
        if self._thread is not None:
            self._thread.join()
        self._waker.end()
        if self.last_resort is not None:
            self.last_resort.disarm()

    @contextlib.contextmanager
    def paused(self) -> Iterator[None]:
        """Suspend the watch while a debugger holds a task, or while cfepy itself waits for a compiler."""
        self._is_paused = True
        try:
            yield
        finally:
            self._is_paused = False

    # -- looking -----------------------------------------------------------------------------------------------------

    def _look_on(self) -> None:
        over = self._over
        self._before = None
        while not over.wait(interval := self._interval()):
            self._look_again(interval)

    def _look_again(self, interval: float) -> None:
        """Check the run, some seconds after the last check.

        Measuring the time of the process takes time for each of its threads, of which many missions, or one with many
        nodes, have thousands. So it is not measured for a run whose clock advances or that is paused.
        """
        before = self._before
        if not self._may_stall():
            self._before = None
            self._look(0.0, False, 0.0)
        elif before is None:
            self._look(0.0, False, 0.0)
            self._before = self.spent()
        else:
            now = self.spent()
            wall_s = min(now.wall_s - before.wall_s, 2 * interval)  # this process may have been stopped
            used_s, ready_s = now.since(before, self._threads())
            is_busy = used_s + ready_s >= BUSY * wall_s
            self._look(wall_s, is_busy, min(used_s, wall_s))
            self._before = self.spent()

    def _measure_first(self) -> Spent:
        """Measure, after loading the code for it, which a short run never needs."""
        from cfepy.rtos.cpu_time import Expenses

        self.spent = Expenses()
        return self.spent()

    def _threads(self) -> set[int]:
        """Return the native numbers of the threads of the run."""
        return {self._host_native, *(getattr(task.carrier, "native_id", 0) for task in list(self._kernel.tasks))}

    def _may_stall(self) -> bool:
        """Return whether the clock of a run has stood still since the last check, or the run should end."""
        kernel, stand = self._kernel, self._stand
        if kernel.broken is not None or self.wanted():
            return True
        return kernel.is_running and stand is not None and stand.now_ns == kernel.progress()[0]

    def _interval(self) -> float:
        if self._kernel.broken is not None or self.wanted():
            return SOON_S
        return min(LOOK_S, self.limit_s / 4) if self.limit_s else LOOK_S

    def _look(self, wall_s: float, is_busy: bool, used_s: float) -> None:
        """Check the run once.

        Args:
            wall_s: wall time since the check before.
            is_busy: whether the run used the CPU or was ready for it.
            used_s: CPU time since then, which counts for a busy run, so that no verdict depends on other programs. A
                waiting task uses no CPU, so its wall time counts.
        """
        kernel = self._kernel
        self._arm()
        if self._is_paused or self._has_lost:
            self._stand = None
            return
        # Time before the request does not count, so the first check that sees the request counts nothing.
        passed_s = used_s if is_busy else wall_s
        given_s = passed_s if self._was_wanted else 0.0
        self._was_wanted = self.wanted()
        self._wanted_s = self._wanted_s + given_s if self._was_wanted else 0.0
        self._stand = self._standing(passed_s, is_busy) if kernel.is_running else None
        if kernel.broken is not None:
            self._hurry(passed_s)
        elif self._stand is not None and self._wanted_s >= GRACE_S:
            stand = self._stand
            if stand.still_s + stand.idle_s >= SPUN_S or stand.is_turning:
                self._break_off(self._error(stand, "the run was ended"), stand)
            else:
                self._break_off(KeyboardInterrupt())
        elif self._stand is not None and self.limit_s:
            self._hold_against_limit(self._stand)

    def _arm(self) -> None:
        if self.last_resort is not None:
            self.last_resort.arm(self.limit_s + SPARE_S if self.limit_s and not self._is_paused else 0)

    def _standing(self, passed_s: float, is_busy: bool) -> _Stand:
        """Return the record of how long the clock has been standing still; `passed_s` is CPU time if `is_busy`."""
        kernel, stand = self._kernel, self._stand
        now_ns, sequence, front = kernel.progress()
        task, calls = kernel.current, sequence - front
        if stand is None or stand.now_ns != now_ns:
            return _Stand(now_ns, calls, calls, task.ident)
        stand.standing_s += passed_s if is_busy else 0.0
        if stand.calls == calls and stand.seen == task.ident:
            stand.still_s += passed_s if is_busy else 0.0
            stand.idle_s += 0.0 if is_busy else passed_s
        else:
            stand.still_s = stand.idle_s = 0.0
        stand.calls, stand.seen = calls, task.ident
        stand.names[task.name] = None
        return stand

    def _looks(self, stand: _Stand) -> list[tuple[_Place, ...]]:
        """Sample the place of the task several times, only now, because reading frames keeps their variables alive."""
        ident = self._thread_of(self._task_of(stand))
        looks = [_places(frame_of_thread(ident))]
        while len(looks) < LOOKS and not stand.is_idle:
            time.sleep(LOOK_AGAIN_S)
            self._note_names(stand)
            looks.append(_places(frame_of_thread(ident)))
        return looks

    def _note_names(self, stand: _Stand) -> None:
        """Note the task that has the CPU, and the ready tasks of its priority: they get the CPU when it yields.

        Which task a look meets depends on the host's scheduler, so the running task alone may always be the same.
        """
        kernel = self._kernel
        task = kernel.current
        stand.names[task.name] = None
        stand.names.update((each.name, None) for *_, each in list(kernel.ready) if each.priority == task.priority)

    def _hold_against_limit(self, stand: _Stand) -> None:
        if stand.still_s >= self.limit_s or (stand.standing_s >= self.limit_s and stand.is_turning):
            hint = (
                "the run was ended; let a loop that waits sleep, or allow a long computation more time with --stall "
                f"{6 * self.limit_s:g}, or any time with --stall 0"
            )
            self._break_off(self._error(stand, hint), stand)
        elif stand.is_idle and stand.idle_s >= self.limit_s and not stand.is_told:
            error = self._error(stand, "the run waits for it")
            if self._still_stands(stand):
                stand.is_told = True
                self._tell(f"cfepy: {error}")

    def _still_stands(self, stand: _Stand) -> bool:
        """Return whether nothing has changed since the samples, because locating the stall takes longer than
        many runs.
        """
        kernel = self._kernel
        now_ns, sequence, front = kernel.progress()
        if self._stand is not stand or not kernel.is_running or now_ns != stand.now_ns:
            return False
        return stand.is_turning or (sequence - front == stand.calls and kernel.current.ident == stand.seen)

    def _error(self, stand: _Stand, end: str) -> StallError:
        """Return the error about a stall."""
        task = self._task_of(stand)
        is_host = task is self._kernel.host
        lines = lines_of(self._looks(stand), self._is_own)  # this also records which tasks have the CPU meanwhile
        app = "" if is_host or task.owner is None else str(task.owner.name)
        spent = f"{stand.idle_s:.1f} s of wall time" if stand.is_idle else f"{stand.standing_s:.1f} s of CPU time"
        return StallError(
            f"{self._subject(stand, app)} since {instant_text(stand.now_ns)} of virtual time, for {spent}; {end}",
            tuple(map(str, lines)),
            app=app,
            task=COLLECTOR if is_host else task.name,
            place=lines[0].place if lines else "",
            at_ns=stand.now_ns,
        )

    def _subject(self, stand: _Stand, app: str) -> str:
        task = self._task_of(stand)
        if task is self._kernel.host:
            return f"{COLLECTOR} has not finished"
        who = f"task {task.name}" + (f" of {app}" if app not in ("", task.name) else "")
        if stand.is_idle:
            return f"{who} has been waiting for something outside the simulation"
        if len(stand.names) > 1 and stand.is_turning:
            return f"tasks {', '.join(sorted(stand.names))} have kept each other going, and time has stood still,"
        return f"{who} has not given up the CPU"

    def _task_of(self, stand: _Stand) -> Task:
        tasks = list(self._kernel.tasks)
        return next((task for task in tasks if task.ident == stand.seen), self._kernel.current)

    def _thread_of(self, task: Task) -> int:
        kernel = self._kernel
        return self._host_ident if task is kernel.host else kernel.context.thread_of(task, self._host_ident)

    # -- ending ------------------------------------------------------------------------------------------------------

    def _break_off(self, why: BaseException, stand: _Stand | None = None) -> None:
        """Break off the run, and make the running task return the CPU.

        Args:
            why: the error that the run raises.
            stand: the stall that ends the run; None if the run ends in any case.
        """
        kernel = self._kernel
        with kernel.guard:
            if not kernel.is_running or (stand is not None and not self._still_stands(stand)):
                return  # it has just ended, or it continues
            kernel.break_off(why)
        self._press()

    def _hurry(self, passed_s: float) -> None:
        """Press the tasks of a run that was broken off to end, one after the other, each within a short time."""
        kernel, stand = self._kernel, self._stand
        self._ending_s += passed_s
        if stand is None:
            return
        if self._ending_s >= END_S:
            kernel.give_up()
        if stand.still_s + stand.idle_s >= PRESS_S:
            self._press()
            self._stand = None

    def _press(self) -> None:
        """Make the running task, or a finalizer, end."""
        task = self._kernel.current
        with _quiet():
            is_back = self._is_back(task, POLL_S) or self._insist(task, lambda: None)
            if not is_back and self._thread_of(task) == self._waker.ident:
                is_back = self._insist(task, self._waker.wake)
        if not is_back:
            self._lose(task)

    def _insist(self, task: Task, then: Callable[[], None]) -> bool:
        def strike() -> None:
            self._strike(task)
            then()

        return insist(strike, lambda seconds: self._is_back(task, seconds))

    def _strike(self, task: Task) -> None:
        kernel = self._kernel
        with kernel.guard:
            if not self._has_cpu(task):
                return
            assert kernel.broken is not None
            kernel.break_off(kernel.broken)
            if task is not kernel.host:
                kernel.context.spoil(task)
            raise_in_thread(self._thread_of(task), TaskExit)

    def _has_cpu(self, task: Task) -> bool:
        kernel = self._kernel
        if not kernel.is_running or kernel.current is not task or task.done:
            return False  # the kernel handles an ended task, and a strike would hit the kernel
        return task is not kernel.host or kernel.is_collecting

    def _is_back(self, task: Task, seconds: float) -> bool:
        before = self.spent() if seconds > POLL_S else None  # it takes longer than a short time
        until = time.monotonic() + seconds
        while self._has_cpu(task):
            if time.monotonic() >= until:
                late_s = 0.0 if before is None else seconds - self._own_s(before)
                if late_s <= 0:
                    return False
                until += late_s
            time.sleep(min(seconds, POLL_S))
        return True

    def _own_s(self, before: Spent) -> float:
        """Return the wall time since a measurement in which other programs did not keep the run from the CPU."""
        now = self.spent()
        used_s, ready_s = now.since(before, self._threads())
        return max(used_s, now.wall_s - before.wall_s - ready_s)

    def _lose(self, task: Task) -> None:
        """Give up a task that cannot be ended. If the host has its own thread, it continues without the task."""
        kernel = self._kernel
        if self._thread_of(task) != self._host_ident:
            kernel.is_lost = True
            return
        self._has_lost = True
        assert kernel.broken is not None
        self.on_lost(kernel.broken)

    def _tell_lost(self, why: BaseException) -> None:
        self._tell(f"cfepy: {why}\n  it cannot be ended; it ends only with this process")


@dataclass(slots=True)
class _Stand:
    """A clock that stands still.

    Attributes:
        now_ns: the virtual time at which it stands, in ns.
        first_calls, calls: number of calls that may let another task run: at first, and now.
        seen: number of the task that has the CPU. The task object itself is not kept, because an ended task would keep
            its whole processor alive until the next check.
        standing_s: CPU time of the stall.
        still_s: CPU time in which this task made no such call.
        idle_s: wall time in which it made no such call and used no CPU.
        is_told: whether the wait was reported.
        names: names of the tasks seen with the CPU, or ready for it at the same priority.
    """

    now_ns: int
    first_calls: int
    calls: int
    seen: int
    standing_s: float = 0.0
    still_s: float = 0.0
    idle_s: float = 0.0
    is_told: bool = False
    names: dict[str, None] = field(default_factory=dict)

    @property
    def is_idle(self) -> bool:
        """Whether the task waits for something outside of the simulation."""
        return self.idle_s > self.still_s

    @property
    def is_turning(self) -> bool:
        """Whether tasks pass the CPU to each other without end."""
        return self.calls - self.first_calls >= TURNS_PER_S * max(self.standing_s, SPUN_S)


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Suppress Python's report of a strike that a finalizer cannot pass on; the stall report is better."""
    usual = sys.unraisablehook

    def hook(unraisable: sys.UnraisableHookArgs) -> None:
        if unraisable.exc_type is not TaskExit:
            usual(unraisable)

    sys.unraisablehook = hook
    try:
        yield
    finally:
        sys.unraisablehook = usual


# -- where it spins ----------------------------------------------------------------------------------------------------


class _Place(NamedTuple):
    """The position of a frame."""

    frame: FrameType
    code: CodeType
    at: int
    line: int


@dataclass(frozen=True, slots=True)
class StallLine:
    """A line of source code to show."""

    file: str
    number: int
    function: str

    @property
    def place(self) -> str:
        """The file and line, such as "spin.py:4"."""
        return f"{os.path.basename(self.file)}:{self.number}"

    def __str__(self) -> str:
        here = os.path.join(os.getcwd(), "")
        source = linecache.getline(self.file, self.number).strip()
        return f"{self.file.removeprefix(here)}:{self.number} in {self.function}: {source}"


def _places(frame: FrameType | None) -> tuple[_Place, ...]:
    """Return the frames of a thread, the outermost first."""
    found: list[_Place] = []
    while frame is not None:
        line = frame.f_lineno or frame.f_code.co_firstlineno  # an instruction without a line has none
        found.append(_Place(frame, frame.f_code, frame.f_lasti, line))
        frame = frame.f_back
    return tuple(reversed(found))


def lines_of(looks: Sequence[tuple[_Place, ...]], is_own: Callable[[str], bool]) -> list[StallLine]:
    """Return the lines to show for a stall: the loop that it does not leave, then its callers.

    Args:
        looks: one or several samples of its frames.
        is_own: whether a source file belongs to the user.
    """
    depth = 0
    least = min(map(len, looks), default=0)
    while depth < least and len({each[depth].frame for each in looks}) == 1:
        depth += 1
    while depth and not is_own(looks[0][depth - 1].code.co_filename):
        depth -= 1
    if not depth:  # no code of the user is running
        return [] if not least else [_line(looks[-1][-1])]
    outer = [_line(each) for each in reversed(looks[-1][: depth - 1]) if is_own(each.code.co_filename)]
    loop = _loop_line(looks[0][depth - 1].code, [each[depth - 1] for each in looks])
    return [_line(looks[0][depth - 1]._replace(line=loop)), *outer][:LINES]


def _line(place: _Place) -> StallLine:
    return StallLine(place.code.co_filename, place.line, place.code.co_qualname)


def _loop_line(code: CodeType, places: Sequence[_Place]) -> int:
    """Return the first line of the innermost loop that contains all places; without one, the smallest of their
    lines.
    """
    import dis  # needed only here, and slow to import

    steps = list(dis.get_instructions(code))
    jumps = frozenset((*dis.hasjrel, *dis.hasjabs))
    loops = [(step.argval, step.offset) for step in steps if step.opcode in jumps and step.argval <= step.offset]
    around = [loop for loop in loops if all(loop[0] <= place.at <= loop[1] for place in places)]
    if not around:
        return min(place.line for place in places)
    start, end = max(around, key=lambda loop: (loop[0], -loop[1]))
    lines = (step.positions.lineno for step in steps if start <= step.offset <= end and step.positions is not None)
    return min((line for line in lines if line is not None), default=places[0].line)

"""The stall watch: a thread of the host that ends a run in which a task does not give up the CPU.

The simulation cannot do that itself: while one task computes, nothing else runs, and virtual time stands still. So a
thread looks on, in wall-clock time. It changes nothing in a run that goes on, and a run that it ends has failed.

A stall is a virtual clock that stands still for so many seconds, while this process uses the CPU: because one task
computes, or because tasks make calls that cost nothing, a thousand in a second and more. Who computes for longer
raises the limit. A task that waits for something outside of the simulation, such as `input()` or a debugger, uses no
CPU and is only told; and the time in which the process is stopped, or the computer asleep, does not count.
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
from typing import NamedTuple

from cfepy.rtos.context import frame_of_thread, insist, raise_in_thread
from cfepy.rtos.kernel import Kernel
from cfepy.rtos.stall_signals import LastResort, Waker
from cfepy.rtos.task import Task, TaskExit
from cfepy.status import StallError
from cfepy.units import NS_PER_S
from cfepy.writing.escapes import visible

STALL_S = 10.0
LOOK_S, SOON_S = 0.25, 0.05  # wall time between two looks; when the run is being ended
GRACE_S = 0.6  # CPU time from the wish of the host's user until the run is broken off; wall time of who uses no CPU
SPUN_S = 0.3  # of it without a call: that is what the user is told then
END_S = 0.8  # wall time in which all tasks of a run that was broken off have to end
PRESS_S = 0.15  # of it that each of them may take
BUSY = 0.1  # share of a CPU that this process uses, or could use, at least while a task computes
TURNS_PER_S = 1000  # so many calls that let another task run, while the clock stands still, are a stall as well
LOOKS, LOOK_AGAIN_S = 12, 0.01  # at what spins, so that the loop is found that it does not leave
POLL_S = 0.002
LINES = 5
SPARE_S = 2.0  # CPU time beyond the limit until the last resort
COLLECTOR = "a finalizer"
THREADS = "/proc/self/task"


def to_stderr(text: str) -> None:
    """Where a report goes by default."""
    sys.stderr.write(visible(text) + "\n")
    sys.stderr.flush()


class Spent(NamedTuple):
    """What a process has had of the computer's time so far, in seconds.

    Attributes:
        wall_s: of the wall clock.
        used_s: of CPU, by its threads but for the calling one.
        ready_s: in which these were ready for a CPU that other programs had.
    """

    wall_s: float
    used_s: float
    ready_s: float


class Expenses:
    """Tells, whenever it is called, what this process has had so far.

    Only Linux tells for how long threads were ready. Without it a computing task looks like a waiting one where many
    programs compute. What a thread was counted for stays when it ends, or cannot be asked.
    """

    def __init__(self) -> None:
        self._ready_ns = 0
        self._of_threads: dict[str, int] = {}

    def __call__(self) -> Spent:
        """What it is now. Its caller is left out: it looks on."""
        with contextlib.suppress(OSError):
            threads = {*os.listdir(THREADS)} - {str(threading.get_native_id())}
            for gone in self._of_threads.keys() - threads:
                del self._of_threads[gone]
            for thread in threads:
                with (
                    contextlib.suppress(OSError, IndexError, ValueError),
                    open(f"{THREADS}/{thread}/schedstat", encoding="utf-8") as told,
                ):
                    self._count(thread, int(told.read().split()[1]))
        used_s = time.process_time() - time.thread_time()
        return Spent(time.monotonic(), used_s, self._ready_ns / NS_PER_S)

    def _count(self, thread: str, ready_ns: int) -> None:
        before = self._of_threads.get(thread, 0)
        self._ready_ns += ready_ns - (before if ready_ns >= before else 0)  # with less, another one has its number now
        self._of_threads[thread] = ready_ns


class StallWatch:
    """Watches a kernel, from the first `begin` to `end`.

    Args:
        kernel: the kernel to watch.
        limit_s: wall-clock seconds for which the virtual clock may stand still; 0 for any time.
        is_own: whether a source file is the user's own, not the simulator's or a library's.
        tell: gets the text about a task that waits for something outside of the simulation.

    Attributes:
        limit_s: as given; may be set before the first `begin`.
        wanted: whether the host's user wants the run to end: then it is broken off when it does not end by itself soon.
        on_lost: called, in the thread of the watch, when a task cannot be ended that runs on the host's own thread, or
            a finalizer: only the end of the process ends it.
        last_resort: ends the process when this thread does not get to run any more; None leaves it.
        spent: tells what this process has had of the computer's time.
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
        self.spent: Callable[[], Spent] = Expenses()
        self._kernel = kernel
        self._is_own = is_own
        self._tell = tell
        self._over = threading.Event()
        self._thread: threading.Thread | None = None
        self._process = 0  # in which the thread looks
        self._host_ident = 0
        self._waker = Waker()
        self._is_paused = self._has_lost = self._was_wanted = False
        self._stand: _Stand | None = None
        self._before: Spent | None = None
        self._wanted_s = self._ending_s = 0.0

    def begin(self) -> None:
        """The calling thread is about to run the kernel. Cheap after the first time: a run may come in many pieces.

        A forked process has none of its parent's threads: it begins anew. What was seen in the piece before is over.
        """
        self._host_ident = threading.get_ident()
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
        """Whether its thread looks."""
        return self._thread is not None and self._thread.is_alive()

    def end(self) -> None:
        """Look no more."""
        self._over.set()
        self._process = 0
        if self._thread is not None:
            self._thread.join()
        self._waker.end()
        if self.last_resort is not None:
            self.last_resort.disarm()

    @contextlib.contextmanager
    def paused(self) -> Iterator[None]:
        """A debugger holds a task, for as long as its user wants; or cfepy itself waits for a compiler."""
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
        """Look, some seconds after the last look.

        To ask what the process has had of the computer takes time for each of its threads, of which many missions, or
        one with many nodes, have thousands. So a run whose clock goes on is not asked, nor one that stands by.
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
            used_s = now.used_s - before.used_s
            is_busy = used_s + now.ready_s - before.ready_s >= BUSY * wall_s
            self._look(wall_s, is_busy, min(used_s, wall_s))
            self._before = self.spent()

    def _may_stall(self) -> bool:
        """Whether the clock of a run has stood still since the last look, or the run is to end."""
        kernel, stand = self._kernel, self._stand
        if kernel.broken is not None or self.wanted():
            return True
        return kernel.is_running and stand is not None and stand.now_ns == kernel.progress()[0]

    def _interval(self) -> float:
        if self._kernel.broken is not None or self.wanted():
            return SOON_S
        return min(LOOK_S, self.limit_s / 4) if self.limit_s else LOOK_S

    def _look(self, wall_s: float, is_busy: bool, used_s: float) -> None:
        """Look once.

        Args:
            wall_s: since the look before.
            is_busy: the process used the CPU, or was ready for it.
            used_s: CPU time since then. A run that is wanted to end is given some of that, so that it comes to the end
                of its piece however busy the computer is; who waits for something uses none, and is given wall time.
        """
        kernel = self._kernel
        self._arm()
        if self._is_paused or self._has_lost:
            self._stand = None
            return
        # What was spent before the wish does not count: of the look that sees it first, nothing does.
        given_s = (used_s if is_busy else wall_s) if self._was_wanted else 0.0
        self._was_wanted = self.wanted()
        self._wanted_s = self._wanted_s + given_s if self._was_wanted else 0.0
        self._stand = self._standing(wall_s, is_busy) if kernel.is_running else None
        if kernel.broken is not None:
            self._hurry(wall_s)
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

    def _standing(self, wall_s: float, is_busy: bool) -> _Stand:
        """How long the clock has been standing still by now."""
        kernel, stand = self._kernel, self._stand
        now_ns, sequence, front = kernel.progress()
        task, calls = kernel.current, sequence - front
        if stand is None or stand.now_ns != now_ns:
            return _Stand(now_ns, calls, calls, task.ident)
        stand.standing_s += wall_s if is_busy else 0.0
        if stand.calls == calls and stand.seen == task.ident:
            stand.still_s += wall_s if is_busy else 0.0
            stand.idle_s += 0.0 if is_busy else wall_s
        else:
            stand.still_s = stand.idle_s = 0.0
        stand.calls, stand.seen = calls, task.ident
        stand.names[task.name] = None
        return stand

    def _looks(self, stand: _Stand) -> list[tuple[_Place, ...]]:
        """Where the task is, several times. Only now: who looks at frames keeps their variables alive."""
        ident = self._thread_of(self._task_of(stand))
        looks = [_places(frame_of_thread(ident))]
        while len(looks) < LOOKS and not stand.is_idle:
            time.sleep(LOOK_AGAIN_S)
            stand.names[self._kernel.current.name] = None
            looks.append(_places(frame_of_thread(ident)))
        return looks

    def _hold_against_limit(self, stand: _Stand) -> None:
        if stand.still_s >= self.limit_s or (stand.standing_s >= self.limit_s and stand.is_turning):
            hint = (
                "the run was ended; allow a long computation more time with --stall "
                f"{6 * self.limit_s:g}, or any time with --stall 0"
            )
            self._break_off(self._error(stand, hint), stand)
        elif stand.is_idle and stand.idle_s >= self.limit_s and not stand.is_told:
            error = self._error(stand, "the run waits for it")
            if self._still_stands(stand):
                stand.is_told = True
                self._tell(f"cfepy: {error}")

    def _still_stands(self, stand: _Stand) -> bool:
        """Whether nothing has gone on since it was looked at: to tell where it stands takes longer than many a run."""
        kernel = self._kernel
        now_ns, sequence, front = kernel.progress()
        if self._stand is not stand or not kernel.is_running or now_ns != stand.now_ns:
            return False
        return stand.is_turning or (sequence - front == stand.calls and kernel.current.ident == stand.seen)

    def _error(self, stand: _Stand, end: str) -> StallError:
        """What is told of it."""
        task = self._task_of(stand)
        is_host = task is self._kernel.host
        lines = lines_of(self._looks(stand), self._is_own)  # and who has the CPU meanwhile
        app = "" if is_host or task.owner is None else str(task.owner.name)
        return StallError(
            f"{self._subject(stand, app)} since {stand.now_ns / NS_PER_S:.6f} s of virtual time, "
            f"for {stand.standing_s + stand.idle_s:.1f} s of wall time; {end}",
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
        """The run cannot go on; have the running task give the CPU back.

        Args:
            why: what the run raises.
            stand: what it is ended for; None where the run is ended whatever it does.
        """
        kernel = self._kernel
        with kernel.guard:
            if not kernel.is_running or (stand is not None and not self._still_stands(stand)):
                return  # it has come to its end just now, or goes on
            kernel.break_off(why)
        self._press()

    def _hurry(self, wall_s: float) -> None:
        """The run was broken off, and its tasks are ended one after the other: none of them may take long."""
        kernel, stand = self._kernel, self._stand
        self._ending_s += wall_s
        if stand is None:
            return
        if self._ending_s >= END_S:
            kernel.give_up()
        if stand.still_s + stand.idle_s >= PRESS_S:
            self._press()
            self._stand = None

    def _press(self) -> None:
        """Have the running task, or a finalizer, end."""
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
            return False  # of a task that has ended the kernel takes leave, and a blow would hit the kernel
        return task is not kernel.host or kernel.is_collecting

    def _is_back(self, task: Task, seconds: float) -> bool:
        until = time.monotonic() + seconds
        while self._has_cpu(task):
            if time.monotonic() >= until:
                return False
            time.sleep(min(seconds, POLL_S))
        return True

    def _lose(self, task: Task) -> None:
        """Nothing ends it. A host with a thread of its own goes on without it."""
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
        now_ns: where it stands.
        first_calls, calls: number of calls that may let another task go on: at first, and now.
        seen: number of the task that has the CPU. The task itself is not held: one that has ended would hold its whole
            processor until the next look.
        standing_s: for how long it stands; wall time in which the CPU was used.
        still_s: for how long this task has made no such call, and used the CPU.
        idle_s: for how long it has made none, and used no CPU.
        is_told: that has been told.
        names: of the tasks that were seen.
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
        """Whether tasks let each other go on without an end."""
        return self.calls - self.first_calls >= TURNS_PER_S * max(self.standing_s, SPUN_S)


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """What strikes a finalizer cannot leave it, and Python would tell so; there is a better report."""
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
    """Where a frame is."""

    frame: FrameType
    code: CodeType
    at: int
    line: int


@dataclass(frozen=True, slots=True)
class StallLine:
    """A line of source that is to be shown."""

    file: str
    number: int
    function: str

    @property
    def place(self) -> str:
        """Where it is: "spin.py:4"."""
        return f"{os.path.basename(self.file)}:{self.number}"

    def __str__(self) -> str:
        here = os.path.join(os.getcwd(), "")
        source = linecache.getline(self.file, self.number).strip()
        return f"{self.file.removeprefix(here)}:{self.number} in {self.function}: {source}"


def _places(frame: FrameType | None) -> tuple[_Place, ...]:
    """Where a thread is, outermost frame first."""
    found: list[_Place] = []
    while frame is not None:
        line = frame.f_lineno or frame.f_code.co_firstlineno  # a step that belongs to no line has none
        found.append(_Place(frame, frame.f_code, frame.f_lasti, line))
        frame = frame.f_back
    return tuple(reversed(found))


def lines_of(looks: Sequence[tuple[_Place, ...]], is_own: Callable[[str], bool]) -> list[StallLine]:
    """The lines to show for something that was looked at several times: the loop that it does not leave, its callers.

    Args:
        looks: where it was, once or several times.
        is_own: whether a source file is the user's own.
    """
    depth = 0
    least = min(map(len, looks), default=0)
    while depth < least and len({each[depth].frame for each in looks}) == 1:
        depth += 1
    while depth and not is_own(looks[0][depth - 1].code.co_filename):
        depth -= 1
    if not depth:  # no code of the user's is at work
        return [] if not least else [_line(looks[-1][-1])]
    outer = [_line(each) for each in reversed(looks[-1][: depth - 1]) if is_own(each.code.co_filename)]
    loop = _loop_line(looks[0][depth - 1].code, [each[depth - 1] for each in looks])
    return [_line(looks[0][depth - 1]._replace(line=loop)), *outer][:LINES]


def _line(place: _Place) -> StallLine:
    return StallLine(place.code.co_filename, place.line, place.code.co_qualname)


def _loop_line(code: CodeType, places: Sequence[_Place]) -> int:
    """The line with which the innermost loop begins that all places are in; without one, the first of their lines."""
    import dis  # it is needed here alone, and takes time

    steps = list(dis.get_instructions(code))
    jumps = frozenset((*dis.hasjrel, *dis.hasjabs))
    loops = [(step.argval, step.offset) for step in steps if step.opcode in jumps and step.argval <= step.offset]
    around = [loop for loop in loops if all(loop[0] <= place.at <= loop[1] for place in places)]
    if not around:
        return min(place.line for place in places)
    start, end = max(around, key=lambda loop: (loop[0], -loop[1]))
    lines = (step.positions.lineno for step in steps if start <= step.offset <= end and step.positions is not None)
    return min((line for line in lines if line is not None), default=places[0].line)

"""What a task runs on: real threads, which are the reference, or greenlets, which are the fast alternative.

A context gives each task `resume` (let it go on, from the outside) and `park` (called by the task itself when it gave
the CPU away; None when `resume` already switched). `make_context` makes the one that a run asks for.

OS threads are kept for the next simulation in a pool, the one piece of process-wide state in cfepy: it cannot be seen
from a simulation, and makes one in a property test start and end in a tenth of a millisecond.
"""

from __future__ import annotations

import _thread
import contextvars
import os
import sys
import threading  # first imported in a task, it would take that task for the process's main thread
import time
from collections.abc import Callable
from contextlib import suppress
from types import FrameType
from typing import Any, Protocol

from cfepy.interpreter.host_system import in_forked_process
from cfepy.rtos.cpus import Seat, current_cpu, pin, process_seat
from cfepy.rtos.task import Task, TaskExit
from cfepy.status import UsageError

STACK_BYTES = 512 * 1024  # 64 KiB crashes in deep C recursion, 256 KiB still gives a clean RecursionError
FIRST_PATIENCE_S = 0.2  # how long a computing task may take to reach its next kernel call after Ctrl-C
UNWIND_S = 0.1  # how long what a struck task does at its end may take: a second blow must not hit that
BLOWS_S = 0.5  # how long it is struck in quick succession, when it swallows the first blows
BLOW_S = 1e-5
STAY_NS = 100_000_000  # wall time for which a run stays on a CPU
LOOK_UP_S = 0.25  # how long a signal may wait for the host in the worst case
EACH_STEP_S = 1e-6  # for `sys.setswitchinterval`: another thread may get in after each step of a loop
_HAS_BATCH = hasattr(os, "SCHED_BATCH")


class Context(Protocol):
    """A way to run tasks."""

    name: str
    interrupts: tuple[type[BaseException], ...]  # come from outside the simulation: they end the run, not just a task

    def bind_host(self, host: Task) -> None:
        """Prepare the caller of `Kernel.run`, which takes part as a task of its own."""

    def stranger(self) -> str:
        """Why the caller cannot let the tasks go on; empty when it can."""

    def create(self, task: Task, main: Callable[[Task], Task]) -> None:
        """Prepare a task: its first `resume` runs `main(task)`, which returns the task to resume at its end."""

    def prepare_run(self, tasks: list[Task]) -> None:
        """A run begins, on whatever CPU the host is now."""

    def be_prompt(self) -> None:
        """Somebody outside waits for answers: tasks are to go on at once when other programs keep the CPUs busy."""

    def end_run(self) -> None:
        """No task is left; give back what a run has of this computer."""

    def enter(self, host: Task, is_lost: Callable[[], bool]) -> None:
        """Wait in the host until the baton comes back, or is lost; the kernel handed it out before."""

    def interrupt(self, running: Callable[[], Task], host: Task) -> bool:
        """The host was woken by a signal while a task had the baton, `running()` at any moment.

        Wait for the baton, which comes at the task's next kernel call, and strike a task that makes none. False when
        the task does not give it back whatever is done.
        """

    def thread_of(self, task: Task, host_ident: int) -> int:
        """The identifier of the OS thread that a task runs on; `host_ident` is the host's."""

    def frame_of(self, task: Task) -> FrameType | None:
        """The innermost Python frame of a task that does not run now; None before it has begun."""

    def spoil(self, task: Task) -> None:
        """A task is about to be struck; what it runs on must not be used for another one."""

    def disown(self, task: Task) -> None:
        """A task will never give the baton back. Should it end after all, it must not hand it on."""


class _Carrier:
    """An OS thread that runs one task after another."""

    __slots__ = ("alive", "cpu", "disowned", "ident", "is_batch", "lock", "main", "native_id", "spoilt", "task")

    def __init__(self) -> None:
        self.lock = _thread.allocate_lock()
        self.lock.acquire()
        self.main: Callable[[Task], Task] | None = None
        self.task: Task | None = None
        self.cpu = -1
        self.native_id = 0
        self.is_batch = _HAS_BATCH
        self.alive = True
        self.spoilt = self.disowned = False
        try:
            self.ident = _start_thread(self._live)
        except RuntimeError as error:
            count = len(sys._current_frames())
            raise UsageError(
                f"cannot start another thread, this process has {count} ({error}): each task is a thread; "
                "raise the limit (ulimit -u, or the container's limit of pids), or use --tasks greenlet"
            ) from error

    def _live(self) -> None:
        with suppress(TaskExit):  # that was meant for a task, and came late
            self._loop()
        self.alive = False

    def _loop(self) -> None:
        self.native_id = _thread.get_native_id()
        if _HAS_BATCH:
            _schedule_as(0, os.SCHED_BATCH)
        while True:
            self.lock.acquire()
            main, task = self.main, self.task
            if main is None or task is None:
                break
            if self.cpu >= 0:
                pin(0, self.cpu)
            _trace_as_threads_are()
            following = contextvars.Context().run(main, task)  # context variables are a thread's own, and die with it
            self.main = self.task = task = main = None
            if self.spoilt:
                if not self.disowned:
                    following.resume()
                break
            _idle.append(self)
            following.resume()
            del following


def _trace_as_threads_are() -> None:
    """Do what `threading` does for a thread of its own: coverage, profilers and debuggers ask for all of them."""
    tracer, profiler = threading.gettrace(), threading.getprofile()
    if tracer is not sys.gettrace():
        sys.settrace(tracer)
    if profiler is not sys.getprofile():
        sys.setprofile(profiler)


_idle: list[_Carrier] = []
_stack_size = threading.Lock()  # it is one number for the whole process


def _start_thread(loop: Callable[[], None]) -> int:
    with _stack_size:
        old = _thread.stack_size(STACK_BYTES)
        try:
            return _thread.start_new_thread(loop, ())
        finally:
            _thread.stack_size(old)


def _in_forked_process() -> None:
    """It has none of its parent's other threads, and one of them may have held the lock."""
    global _stack_size
    _stack_size = threading.Lock()
    _idle.clear()


in_forked_process(_in_forked_process)


def drain() -> None:
    """End the idle threads of the pool and wait until they are gone."""
    carriers, _idle[:] = _idle[:], []
    for carrier in carriers:
        carrier.lock.release()
    while any(carrier.alive for carrier in carriers):
        time.sleep(0.0001)


class ThreadContext:
    """The reference context: a real OS thread a task.

    One raw lock a task is the baton, handed straight from the task that yields to the next. Measured ways to be slower:
    a central dispatcher thread (twice the switches), Condition or Event (two to ten times), and threads on several CPUs
    (up to fifteen times: an idle CPU must be woken for every hand-over). So all threads of a run are pinned to one CPU
    (`cfepy.rtos.cpus`) and, where there is such a thing, run as SCHED_BATCH: a woken thread then does not preempt its
    waker, and a hand-over costs exactly one switch. Which CPU that is, `cfepy.rtos.cpus` says.
    """

    name = "thread"
    interrupts: tuple[type[BaseException], ...] = (KeyboardInterrupt,)

    def __init__(self) -> None:
        self._cpu = -1
        self._seat: Seat | None = None
        self._chosen_ns = 0
        self._is_prompt = False
        self._process = os.getpid()

    def bind_host(self, host: Task) -> None:
        lock = _thread.allocate_lock()
        lock.acquire()
        host.resume, host.park = lock.release, lock.acquire

    def stranger(self) -> str:
        if os.getpid() == self._process:
            return ""
        return "its tasks are threads of another process, and a forked process has none of them; boot one here"

    def create(self, task: Task, main: Callable[[Task], Task]) -> None:
        try:
            carrier = _idle.pop()
        except IndexError:
            carrier = _Carrier()
        if _HAS_BATCH and not carrier.is_batch and not self._is_prompt:
            _schedule_as(carrier.native_id, os.SCHED_BATCH)
            carrier.is_batch = True
        carrier.main, carrier.task, carrier.cpu = main, task, self._cpu
        task.carrier = carrier
        task.resume, task.park = carrier.lock.release, carrier.lock.acquire

    def prepare_run(self, tasks: list[Task]) -> None:
        """Move the run to the CPU of its process, which follows the host's where it can, now and then.

        A paced run comes here a thousand times a second, and looking for a CPU takes as long as a message.
        """
        now_ns = time.monotonic_ns()
        if self._seat is None:
            self._seat = process_seat()
        elif now_ns - self._chosen_ns < STAY_NS:
            return
        self._chosen_ns = now_ns
        self._cpu = cpu = self._seat.choose(current_cpu())
        for task in tasks:
            carrier = task.carrier
            if self._is_prompt and not task.done and carrier.is_batch and carrier.native_id:
                carrier.is_batch = False
                _schedule_as(carrier.native_id, os.SCHED_OTHER)
            if not task.done and carrier.cpu != cpu and cpu >= 0:
                carrier.cpu = cpu
                if carrier.native_id:
                    pin(carrier.native_id, cpu)

    def be_prompt(self) -> None:
        """A SCHED_BATCH thread that is woken on another CPU waits for the end of a slice."""
        self._is_prompt = True

    def end_run(self) -> None:
        self._seat = None

    def enter(self, host: Task, is_lost: Callable[[], bool]) -> None:
        assert host.park is not None
        while not (host.park(True, LOOK_UP_S) or is_lost()):
            pass  # a signal that came just before the wait is only handled between two waits

    def interrupt(self, running: Callable[[], Task], host: Task) -> bool:
        park = host.park
        assert park is not None

        def strike() -> None:
            task = running()
            if task is not host and not task.done:
                self.spoil(task)
                raise_in_thread(task.carrier.ident, TaskExit)

        return park(True, FIRST_PATIENCE_S) or insist(strike, lambda patience: park(True, patience))

    def thread_of(self, task: Task, host_ident: int) -> int:
        return host_ident if task.carrier is None else int(task.carrier.ident)

    def frame_of(self, task: Task) -> FrameType | None:
        return frame_of_thread(task.carrier.ident) if task.started else None

    def spoil(self, task: Task) -> None:
        task.carrier.spoilt = True

    def disown(self, task: Task) -> None:
        task.carrier.spoilt = task.carrier.disowned = True


def frame_of_thread(ident: int) -> FrameType | None:
    """What an OS thread of this process executes."""
    return sys._current_frames().get(ident)


def insist(strike: Callable[[], None], is_back: Callable[[float], bool]) -> bool:
    """Strike until the baton is back; False when it does not come whatever is done, as out of a C function.

    The first blows leave time for what a task does at its end. A loop that swallows them meets the others in quick
    succession: the next one strikes where the error was caught, outside of the `try`.

    Args:
        strike: raises `TaskExit` in the running task, from this thread.
        is_back: waits for the baton, so many seconds at the most, and says whether it is back.
    """
    for patience in (UNWIND_S, UNWIND_S):
        strike()
        if is_back(patience):
            return True
    usual = sys.getswitchinterval()
    sys.setswitchinterval(EACH_STEP_S)
    try:
        until = time.monotonic() + BLOWS_S
        while time.monotonic() < until:
            strike()
            if is_back(BLOW_S):
                return True
    finally:
        sys.setswitchinterval(usual)
    return False


def raise_in_thread(ident: int, error: type[BaseException]) -> None:
    """Make a thread of this process raise `error` at its next bytecode."""
    import ctypes

    ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(ident), ctypes.py_object(error))


class _InItsPlace(BaseException):
    """Is raised and caught at once."""


def take_back() -> None:
    """What another thread was about to raise in this one is not raised any more.

    CPython 3.11 and 3.12 mark the interpreter when something is to be raised in any thread, and take the mark away
    when something is raised. With nothing left to raise, the mark would stay: all code would be slower, and a function
    that is traced, as by a debugger or for coverage, would not get past its first instruction. So something else is
    raised in its place.
    """
    try:
        raise_in_thread(threading.get_ident(), _InItsPlace)
        while True:
            pass  # up to the next instruction at which Python looks
    except _InItsPlace:
        pass


def _schedule_as(native_id: int, policy: int) -> None:
    """Give a thread of this process, 0 for the calling one, a policy of the system."""
    try:
        os.sched_setscheduler(native_id, policy, os.sched_param(0))
    except OSError:
        pass  # a container may forbid it; hand-overs are then about twice as slow


class GreenletContext:
    """One greenlet a task; needs the library greenlet (`pip install cfepy[fast]`).

    Six times cheaper to switch than threads, and the trace of a run is the same. What differs is the host's view: one
    OS thread, so `faulthandler` shows the running task only, and thread-bound C libraries see a single thread.

    Every greenlet is first entered from one shallow "starter": entered from each other, they would nest their C
    stacks and end in a RecursionError at about a thousand tasks.
    """

    name = "greenlet"

    def __init__(self) -> None:
        try:
            from greenlet import GreenletExit, getcurrent, greenlet
        except ImportError as missing:
            raise ValueError("greenlet tasks require the library greenlet: pip install 'cfepy[fast]'") from missing
        self.interrupts: tuple[type[BaseException], ...] = (KeyboardInterrupt, GreenletExit)
        self._current = getcurrent
        self._greenlet = greenlet
        self._starter = greenlet(_start_all)
        self._thread = threading.get_ident()

    def bind_host(self, host: Task) -> None:
        here = self._current()
        host.carrier, host.resume, host.park = here, here.switch, None

    def stranger(self) -> str:
        if threading.get_ident() == self._thread:
            return ""
        return (
            'its tasks are greenlets of the thread that booted it; let it go on there, or boot it with tasks="thread"'
        )

    def create(self, task: Task, main: Callable[[Task], Task]) -> None:
        current = self._current
        creator = current()

        def run() -> None:
            creator.switch()
            current().parent = main(task).carrier

        carrier = self._greenlet(run, parent=self._starter)
        task.carrier, task.resume, task.park = carrier, carrier.switch, None
        self._starter.switch(carrier)

    def prepare_run(self, tasks: list[Task]) -> None:
        pass

    def be_prompt(self) -> None:
        """Its one thread is the host's."""

    def end_run(self) -> None:
        pass

    def enter(self, host: Task, is_lost: Callable[[], bool]) -> None:
        pass

    def interrupt(self, running: Callable[[], Task], host: Task) -> bool:
        """Nothing to do: a signal is raised in the running task itself, which is on the host's own thread."""
        return True

    def thread_of(self, task: Task, host_ident: int) -> int:
        return host_ident

    def frame_of(self, task: Task) -> FrameType | None:
        frame: FrameType | None = task.carrier.gr_frame
        return frame if task.started else None

    def spoil(self, task: Task) -> None:
        pass

    def disown(self, task: Task) -> None:
        pass


def _start_all(first: Any) -> None:
    pending = first
    while True:
        pending = pending.switch()


def make_context(name: str) -> Context:
    """The context called `name`.

    Args:
        name: "thread" or "greenlet".

    Raises:
        ValueError: another name, or greenlet is not installed.
    """
    if name == "thread":
        return ThreadContext()
    if name == "greenlet":
        return GreenletContext()
    raise ValueError(f"unknown kind of tasks {name!r}; expected thread or greenlet")

"""The execution context of tasks: real threads, which are the reference, or greenlets, which are the fast alternative.

A context gives each task `resume` (makes the task continue, called from outside) and `park` (called by the task after
it gave the CPU away; None if `resume` already switched). `make_context` creates the context of a run.

Idle OS threads stay in a pool for the next simulation. The pool is the only process-wide state of cfepy. It is
invisible to a simulation. It lets a simulation in a property test start and end in a tenth of a millisecond.
"""

from __future__ import annotations

import _thread
import contextvars
import os
import sys
import threading  # imported first in a task, it would take that task for the main thread of the process
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
FIRST_PATIENCE_S = 0.2  # time for a computing task to reach its next kernel call after Ctrl-C
UNWIND_S = 0.1  # time for the cleanup of a struck task, which a second strike must not hit
BLOWS = 5000  # strikes in quick succession at a task that swallows the first ones
BLOW_S = 1e-5
STAY_NS = 100_000_000  # wall time for which a run stays on a CPU
LOOK_UP_S = 0.25  # longest time that a signal may wait for the host
EACH_STEP_S = 1e-6  # for `sys.setswitchinterval`: another thread can run after each step of a loop
_HAS_BATCH = hasattr(os, "SCHED_BATCH")


class Context(Protocol):
    """A way to run tasks."""

    name: str
    interrupts: tuple[type[BaseException], ...]  # from outside the simulation; they end the run, not only a task

    def bind_host(self, host: Task) -> None:
        """Prepare the caller of `Kernel.run`, which acts as a task of its own."""

    def stranger(self) -> str:
        """Return why the caller cannot make the tasks continue; empty if it can."""

    def create(self, task: Task, main: Callable[[Task], Task]) -> None:
        """Prepare a task. Its first `resume` runs `main(task)`, which returns the task to resume at the end."""

    def prepare_run(self, tasks: list[Task]) -> None:
        """Prepare a run on the CPU that the host uses now."""

    def be_prompt(self) -> None:
        """Schedule tasks promptly even if other programs keep the CPUs busy, because an external client waits for
        answers.
        """

    def end_run(self) -> None:
        """Release the host resources of a run, after its last task has ended."""

    def enter(self, host: Task, is_lost: Callable[[], bool]) -> None:
        """Wait in the host until the baton comes back or is lost; the kernel has handed it out before."""

    def interrupt(self, running: Callable[[], Task], host: Task) -> bool:
        """Wait for the baton after a signal woke the host while the task `running()` has it.

        The baton comes back at the task's next kernel call. A task that makes none is struck.

        Returns:
            False if the task does not give the baton back at all.
        """

    def thread_of(self, task: Task, host_ident: int) -> int:
        """Return the identifier of a task's OS thread; `host_ident` is the host's."""

    def frame_of(self, task: Task) -> FrameType | None:
        """Return the innermost Python frame of a task that is not running; None before it has started."""

    def spoil(self, task: Task) -> None:
        """Mark the thread of a task that will be struck, so that no other task uses it."""

    def disown(self, task: Task) -> None:
        """Give up a task that will never return the baton. If it ends after all, it must not pass the baton on."""


class _Carrier:
    """An OS thread that runs tasks one after another."""

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
        with suppress(TaskExit):  # a strike at a task that came late
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
            following = contextvars.Context().run(main, task)  # context variables belong to one thread and end with it
            self.main = self.task = task = main = None
            if self.spoilt:
                if not self.disowned:
                    following.resume()
                break
            _idle.append(self)
            following.resume()
            del following


def _trace_as_threads_are() -> None:
    """Install the trace and profile functions of `threading`, which coverage, profilers and debuggers set for all
    threads.
    """
    tracer, profiler = threading.gettrace(), threading.getprofile()
    if tracer is not sys.gettrace():
        sys.settrace(tracer)
    if profiler is not sys.getprofile():
        sys.setprofile(profiler)


_idle: list[_Carrier] = []
_stack_size = threading.Lock()  # the stack size is one number for the whole process


def _start_thread(loop: Callable[[], None]) -> int:
    with _stack_size:
        old = _thread.stack_size(STACK_BYTES)
        try:
            return _thread.start_new_thread(loop, ())
        finally:
            _thread.stack_size(old)


def _in_forked_process() -> None:
    """Replace the lock, which another thread of the parent may have held; the child has none of these threads."""
    global _stack_size
    _stack_size = threading.Lock()
    _idle.clear()


in_forked_process(_in_forked_process)


def drain() -> None:
    """End the idle threads of the pool and wait until they have ended."""
    carriers, _idle[:] = _idle[:], []
    for carrier in carriers:
        carrier.lock.release()
    while any(carrier.alive for carrier in carriers):
        time.sleep(0.0001)


class ThreadContext:
    """The reference context: a real OS thread for each task.

    One raw lock for each task is the baton. The task that yields hands it directly to the next task. Measured
    alternatives are slower: a central dispatcher thread (twice the switches), Condition or Event (two to ten times),
    and threads on several CPUs (up to fifteen times, because each hand-over must wake an idle CPU). So all threads of a
    run are pinned to one CPU, which `cfepy.rtos.cpus` chooses. Where the system has SCHED_BATCH, they use it: a woken
    thread then does not preempt its waker, and a hand-over costs exactly one switch.
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
        """Move the run to the CPU of its process, which follows the host's CPU from time to time where possible.

        A paced run calls this a thousand times a second, and choosing a CPU takes as long as a message.
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
        """Use the normal scheduling policy. A SCHED_BATCH thread that is woken on another CPU waits for the end of a
        slice.
        """
        self._is_prompt = True

    def end_run(self) -> None:
        self._seat = None

    def enter(self, host: Task, is_lost: Callable[[], bool]) -> None:
        assert host.park is not None
        while not (host.park(True, LOOK_UP_S) or is_lost()):
            pass  # a signal just before the wait is handled only between two waits

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
    """Return the current frame of an OS thread of this process."""
    return sys._current_frames().get(ident)


def insist(strike: Callable[[], None], is_back: Callable[[float], bool]) -> bool:
    """Strike until the baton is back.

    The first strikes leave time for the task's cleanup. A loop that swallows them is struck in quick succession: the
    next strike then hits where the error was caught, outside of the `try`.

    Args:
        strike: raises `TaskExit` in the running task, from this thread.
        is_back: waits for the baton for at most the given number of seconds; returns whether it is back.

    Returns:
        False if the baton does not come back, for example from a C function.
    """
    for patience in (UNWIND_S, UNWIND_S):
        strike()
        if is_back(patience):
            return True
    usual = sys.getswitchinterval()
    sys.setswitchinterval(EACH_STEP_S)
    try:
        for _ in range(BLOWS):
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
    """An exception that is raised and caught at once."""


def take_back() -> None:
    """Cancel an exception that another thread scheduled in this one.

    CPython 3.11 and 3.12 set a flag in the interpreter when an exception is scheduled in any thread, and clear it when
    one is raised. With no exception left to raise, the flag would stay set. All code would be slower, and a traced
    function (debugger or coverage) would not pass its first instruction. So another exception is raised in its place.
    """
    try:
        raise_in_thread(threading.get_ident(), _InItsPlace)
        while True:
            pass  # until the next instruction at which Python checks
    except _InItsPlace:
        pass


def _schedule_as(native_id: int, policy: int) -> None:
    """Set the scheduling policy of a thread of this process; 0 is the calling thread."""
    try:
        os.sched_setscheduler(native_id, policy, os.sched_param(0))
    except OSError:
        pass  # a container may forbid this; hand-overs are then about twice as slow


class GreenletContext:
    """One greenlet for each task; requires the library greenlet (`pip install cfepy[fast]`).

    Greenlets switch six times faster than threads, and the trace of a run is the same. Only the host's view differs:
    there is one OS thread. So `faulthandler` shows only the running task, and thread-bound C libraries see a single
    thread.

    Every greenlet is first entered from one shallow "starter". If greenlets entered each other, their C stacks would
    nest and end in a RecursionError at about a thousand tasks.
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
        """Do nothing: the only thread is the host's."""

    def end_run(self) -> None:
        pass

    def enter(self, host: Task, is_lost: Callable[[], bool]) -> None:
        pass

    def interrupt(self, running: Callable[[], Task], host: Task) -> bool:
        """Do nothing: a signal raises its exception in the running task itself, which is on the host's own thread."""
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
    """Return a new context.

    Args:
        name: "thread" or "greenlet".

    Raises:
        ValueError: if the name is invalid or greenlet is not installed.
    """
    if name == "thread":
        return ThreadContext()
    if name == "greenlet":
        return GreenletContext()
    raise ValueError(f"unknown kind of tasks {name!r}; expected thread or greenlet")

"""Tasks on real OS threads: one raw lock a task is the baton, handed straight from the task that yields to the next.

Measured ways to be slower: a central dispatcher thread (twice the switches), Condition or Event (two to ten times), and
threads on several CPUs (up to fifteen times: an idle CPU must be woken for every hand-over). So all threads of a run
are pinned to the CPU the run starts on and, where there is such a thing, run as SCHED_BATCH: a woken thread then
does not preempt its waker, and a hand-over costs exactly one switch.

OS threads are kept for the next simulation in a pool, the one piece of process-wide state in cfepy: it cannot be seen
from a simulation, and makes one in a property test start and end in a tenth of a millisecond.
"""

from __future__ import annotations

import _thread
import os
import sys
import threading  # noqa: F401  # first imported in a task, it would take that task for the process's main thread
import time
import traceback
from collections.abc import Callable
from contextvars import Context

from cfepy.rtos.task import Task
from cfepy.status import UsageError

STACK_BYTES = 512 * 1024  # 64 KiB crashes in deep C recursion, 256 KiB still gives a clean RecursionError
FIRST_PATIENCE_S = 0.2  # how long a computing task may take to reach its next kernel call after Ctrl-C
LAST_PATIENCE_S = 5.0
LOOK_UP_S = 0.5  # how long a signal may wait for the host in the worst case
_HAS_AFFINITY = hasattr(os, "sched_setaffinity")
_HAS_BATCH = hasattr(os, "SCHED_BATCH")


class _Carrier:
    """An OS thread that runs one task after another."""

    __slots__ = ("alive", "cpu", "ident", "lock", "main", "native_id", "task")

    def __init__(self) -> None:
        self.lock = _thread.allocate_lock()
        self.lock.acquire()
        self.main: Callable[[Task], Task] | None = None
        self.task: Task | None = None
        self.cpu = -1
        self.native_id = 0
        self.alive = True
        old = _thread.stack_size(STACK_BYTES)
        try:
            self.ident = _thread.start_new_thread(self._loop, ())
        except RuntimeError as error:
            count = len(sys._current_frames())
            raise UsageError(
                f"this computer refuses another thread, this process has {count} ({error}): a task is a thread; "
                "raise the limit (ulimit -u, or the container's limit of pids), or use --tasks greenlet"
            ) from error
        finally:
            _thread.stack_size(old)

    def _loop(self) -> None:
        self.native_id = _thread.get_native_id()
        if _HAS_BATCH:
            _be_batch()
        while True:
            self.lock.acquire()
            main, task = self.main, self.task
            if main is None or task is None:
                break
            if _HAS_AFFINITY and self.cpu >= 0:
                os.sched_setaffinity(0, {self.cpu})
            following = Context().run(main, task)  # context variables are a thread's own, and die with it
            self.main = self.task = task = main = None
            _idle.append(self)
            following.resume()
            del following
        self.alive = False


_idle: list[_Carrier] = []


def drain() -> None:
    """End the idle threads of the pool and wait until they are gone."""
    carriers, _idle[:] = _idle[:], []
    for carrier in carriers:
        carrier.lock.release()
    while any(carrier.alive for carrier in carriers):
        time.sleep(0.0001)


class ThreadContext:
    """The reference context; see the module's text."""

    name = "thread"
    interrupts: tuple[type[BaseException], ...] = (KeyboardInterrupt,)

    def __init__(self) -> None:
        self._cpu = _current_cpu()

    def bind_host(self, host: Task) -> None:
        lock = _thread.allocate_lock()
        lock.acquire()
        host.resume, host.park = lock.release, lock.acquire

    def create(self, task: Task, main: Callable[[Task], Task]) -> None:
        carrier = _idle.pop() if _idle else _Carrier()
        carrier.main, carrier.task, carrier.cpu = main, task, self._cpu
        task.carrier = carrier
        task.resume, task.park = carrier.lock.release, carrier.lock.acquire

    def prepare_run(self, tasks: list[Task]) -> None:
        """Move the run to the CPU that the host is on now; another program may keep the former one busy."""
        self._cpu = cpu = _current_cpu()
        for task in tasks:
            carrier = task.carrier
            if not task.done and carrier.cpu != cpu and cpu >= 0:
                carrier.cpu = cpu
                if carrier.native_id:
                    _pin(carrier.native_id, cpu)

    def enter(self, host: Task) -> None:
        assert host.park is not None
        while not host.park(True, LOOK_UP_S):
            pass  # a signal that came just before the wait is only handled between two waits

    def interrupt(self, running: Callable[[], Task], host: Task, error: type[BaseException]) -> None:
        assert host.park is not None
        patience = FIRST_PATIENCE_S
        while not host.park(True, patience):
            task = running()
            if task is not host and not task.done:
                raise_in_thread(task.carrier.ident, error)
            patience = min(2 * patience, LAST_PATIENCE_S)  # a second error must not hit a task that is ending already

    def stack_of_running(self, task: Task, host_ident: int) -> list[str]:
        return stack_of_thread(task.carrier.ident)


def stack_of_thread(ident: int) -> list[str]:
    """The formatted stack of an OS thread of this process."""
    frame = sys._current_frames().get(ident)
    return traceback.format_stack(frame) if frame is not None else []


def raise_in_thread(ident: int, error: type[BaseException]) -> None:
    """Make another thread of this process raise `error` at its next bytecode."""
    import ctypes

    ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(ident), ctypes.py_object(error))


def _current_cpu() -> int:
    """The CPU this thread runs on, -1 where that cannot be told or pinning is not possible."""
    if not _HAS_AFFINITY:
        return -1
    try:
        with open("/proc/thread-self/stat", "rb") as stat:
            cpu = int(stat.read().rpartition(b")")[2].split()[36])
    except (OSError, ValueError, IndexError):
        return -1
    return cpu if cpu in os.sched_getaffinity(0) else -1


def _pin(native_id: int, cpu: int) -> None:
    if _HAS_AFFINITY:
        os.sched_setaffinity(native_id, {cpu})


def _be_batch() -> None:
    try:
        os.sched_setscheduler(0, os.SCHED_BATCH, os.sched_param(0))
    except OSError:
        pass  # a container may forbid it; hand-overs are then about twice as slow

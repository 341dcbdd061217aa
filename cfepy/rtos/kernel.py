"""The simulated real-time kernel: the scheduler, the lifecycle of tasks, and the host that runs them.

`Scheduler` decides which task runs. `Kernel` adds the start and end of tasks and `run`, which the host calls. One host
thread at a time may use it.
"""

from __future__ import annotations

import gc
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from heapq import heapify, heappop, heappush
from types import TracebackType
from typing import Any

from cfepy import trace as tr
from cfepy.interpreter.compiled import mypyc_attr
from cfepy.interpreter.garbage import collect_leftovers, collect_young, freeze_many, no_collection
from cfepy.rtos.context import make_context, take_back
from cfepy.rtos.errors import DeadlockError
from cfepy.rtos.scheduler import FAIR_PRIORITY, Scheduler
from cfepy.rtos.task import Task, TaskExit
from cfepy.rtos.wait_graph import Wait, circles, endless, waiting_report

ENDLESS = 1 << 62
COLLECT_NS = 10_000_000_000  # garbage is collected at multiples of this, so finalizers run at fixed times
COLLECT_ALL_NS = (
    600_000_000_000  # until then, each time among all objects; later more seldom: a long run has more of them
)


@mypyc_attr(allow_interpreted_subclasses=True)
class Kernel(Scheduler):
    """One simulated processor.

    Args:
        context: "thread" or "greenlet"; see `cfepy.rtos.context`.
        trace: the trace that records the run; None records nothing (for measurements only).
        tick_ns: deadlines are rounded up to multiples of this; 0 for a tickless clock.
        switch_cost_ns: virtual CPU time of a task switch.
        seed: the seed for random streams above the kernel; the kernel itself uses no randomness.

    Attributes:
        is_running: whether the host is running or ending tasks.
        is_collecting: whether the host itself runs finalizers.
        broken: why the run was broken off; None if it was not.
        is_fair: whether all tasks take turns as if they had one priority, as Linux schedules an ordinary user's tasks.
        abortion: why the flight software has aborted, after which no task runs; None if it has not.
        is_lost: whether the running task will not return the CPU and the host is about to continue without it.
        guard: lock for another thread that reads these attributes and acts on them.
        frames_wanted: whether a tool reads the Python frames of tasks, so that other code must show a frame too.
        call_heard: gets the place and the arguments of each call made by code other than Python; None if unused.
    """

    def __init__(
        self,
        context: str = "thread",
        trace: tr.Trace | None = None,
        tick_ns: int = 0,
        switch_cost_ns: int = 0,
        seed: int = 0,
    ) -> None:
        super().__init__(trace, tick_ns, switch_cost_ns)
        self.seed = seed
        self.context = make_context(context)
        self.on_task_error: Callable[[Task, BaseException], bool] = lambda task, error: False
        self._idents = 0
        self._failed: list[Task] = []
        self._interrupted: BaseException | None = None
        self._stopped = False
        self._begun = False
        self._collect_at = COLLECT_NS
        self._collected_all_at = 0
        self.is_running = self.is_collecting = self.is_lost = False
        self.guard = threading.Lock()
        self._gave_up = False
        self.frames_wanted = False
        self.call_heard: Callable[[str, tuple[object, ...]], object] | None = None

    def __enter__(self) -> Kernel:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        self.shutdown()

    # -- tasks -----------------------------------------------------------------------------------------------------

    def spawn(self, name: str, entry: Callable[[], object], priority: int = 100, owner: Any = None) -> Task:
        """Create a task and make it ready.

        Args:
            name: name for traces and reports.
            entry: called without arguments in the new task.
            priority: 0 (most urgent) to 255; a task more urgent than the caller runs before this call returns.
            owner: value of `Task.owner`; None takes the caller's owner.

        Returns:
            The task.
        """
        self._idents = ident = self._idents + 1
        task = Task(name, ident, entry, FAIR_PRIORITY if self.is_fair else priority)
        parent = self.current
        task.owner = parent.owner if owner is None else owner
        parent.children += 1
        task.path = f"{parent.path}.{parent.children}" if parent.path else str(parent.children)
        self.context.create(task, self._main)  # fails if the host has no more threads
        self._enlist(task)
        self.make_ready(task, None)
        return task

    def _enlist(self, task: Task) -> None:
        """Add a task to the list of tasks."""
        self.tasks.append(task)

    @property
    def tasks_made(self) -> int:
        """Number of tasks created so far."""
        return self._idents

    def kill(self, task: Task) -> None:
        """End a task: raise `TaskExit` in the call that it waits in, and run its `finally` blocks, before this call
        returns.

        For a task that kills itself, this call does not return.
        """
        if task is self.current:
            raise TaskExit
        if task.done:
            return
        task.dying = True
        task.interruption = None
        self._stop_waiting(task)
        self.ready = [entry for entry in self.ready if entry[2] is not task]
        heapify(self.ready)
        if self._gave_up and self.current is self.host:
            self._leave(task)
        else:
            self._finish_in(task)
        self.preempt()  # its end may have made a more urgent task ready

    def interrupt(self, task: Task, error: BaseException) -> None:
        """Raise an exception in the call that another task waits in; the task continues from there.

        Args:
            task: a task that has started and not ended; other tasks are left alone.
            error: the exception.
        """
        if task.done or task.dying or not task.started:
            return
        waiting = self.is_waiting(task)
        task.dying = True
        task.interruption = error
        self._stop_waiting(task)
        if waiting:
            self.make_ready(task)

    @staticmethod
    def is_waiting(task: Task) -> bool:
        """Return whether a task waits for an object or for a time."""
        return task.waits is not None or task.timer != 0

    @staticmethod
    def _stop_waiting(task: Task) -> None:
        task.timer = 0
        if task.waits is not None:
            task.waits.remove(task)
            task.waits = None

    def exit_task(self) -> None:
        """End the current task."""
        raise TaskExit

    def set_priority(self, task: Task, priority: int) -> None:
        """Set the base priority of a task; a priority inherited from waiters of its mutexes stays."""
        task.base_priority = FAIR_PRIORITY if self.is_fair else priority
        self.inherit(task)
        self.preempt()

    def _finish_in(self, task: Task) -> None:
        """Let a dying task unwind, then return."""
        killer = self.current
        task.killer = killer
        if killer is self.host:
            self.context.bind_host(killer)
            with self._letting_run():
                self.current = task
                task.resume()
                self._await()
            self.current = killer
            self._drop_pause_mark()
        else:
            self.current = task
            task.resume()
            if killer.park is not None:
                killer.park()
            self.current = killer

    def _main(self, task: Task) -> Task:
        """Run a task from start to end; return the task to resume next."""
        try:
            if not task.dying:
                task.started = True
                assert task.entry is not None
                task.entry()
        except TaskExit:
            pass
        except BaseException as error:
            if not task.done:
                self._failure(task, error)
        if task.done:  # the host has continued without it
            return self.host
        task.done = True
        task.since = self.now
        task.entry = None
        self._leave_held(task)
        self.tasks.remove(task)
        following = task.killer
        if following is None:
            following = self.host if self._stopped or self._failed or self._interrupted else self._next()
        self.current = following
        if self.record is not None:
            self.record(following.exit_mark)
        return following

    def _failure(self, task: Task, error: BaseException) -> None:
        task.error = error
        if isinstance(error, self.context.interrupts):
            self._interrupted = error
            return
        try:
            handled = self.on_task_error(task, error)
        except TaskExit:
            handled = True
        except Exception as broken:  # an error of the hook itself; if it left here, the baton would be lost
            task.error = broken
            handled = False
        if not handled:
            self._failed.append(task)

    # -- the host --------------------------------------------------------------------------------------------------

    def run(self, until_ns: int | None = None) -> None:
        """Run tasks; only the host may call this.

        Args:
            until_ns: virtual time at which to return, in ns; events at exactly this time still happen. None runs until
                no task can ever continue.

        Raises:
            DeadlockError: if `until_ns` is None and tasks are left that can never continue.
            BaseException: the error of a task that `on_task_error` did not handle; KeyboardInterrupt; or the reason why
                the run was broken off, also in every later call.
        """
        if self.current is not self.host:
            raise RuntimeError("run() cannot be called from inside the simulation")
        self.check_caller()
        self._check_whole()
        end = ENDLESS if until_ns is None else until_ns
        if self.passes(end):
            return
        if self.abortion is not None:
            self.now = max(self.now, until_ns or 0)
            return
        self._stopped = self._exhausted = False
        if not self._begun:
            self._begun = True
            freeze_many()
        with no_collection:
            try:
                with self._letting_run():
                    self._run_until(end)
            finally:
                self._drop_host()
        self._check_whole()
        if not self._stopped and until_ns is not None:
            self.now = max(self.now, until_ns)
        if until_ns is None and self._exhausted and self.tasks:
            raise DeadlockError(self.waiting())

    def _check_whole(self) -> None:
        """Check that the run was not broken off."""
        if self.broken is not None:
            raise self.broken

    def passes(self, until_ns: int) -> bool:
        """Let virtual time pass to `until_ns` if nothing happens until then or at that time.

        A paced run can usually do so. Code that brings input into such a run waits for this.

        Returns:
            Whether the time has passed.
        """
        if self.current is not self.host or self.broken is not None or not self._is_idle_until(until_ns):
            return False
        self._stopped = False
        self.now = max(self.now, until_ns)
        return True

    def _is_idle_until(self, end: int) -> bool:
        """Return whether nothing happens until a virtual time."""
        if not self._begun or self.ready or self._failed or self._interrupted is not None or end >= self._collect_at:
            return False
        upcoming = self.next_event()
        return upcoming is not None and upcoming > end

    def _run_until(self, end: int) -> None:
        """Run in parts, and collect garbage between them, at fixed virtual times."""
        while self.now <= end:
            if self.now >= self._collect_at:
                self._collect(gc.collect if self._is_due_among_all() else collect_young)
                self._collect_at = self.now // COLLECT_NS * COLLECT_NS + COLLECT_NS
            self._until = min(end, self._collect_at)
            self._enter()
            self._drop_pause_mark()
            if self._stopped or self._exhausted or self._until >= end or self.broken is not None:
                return
            self.now = max(self.now, self._until)

    def _is_due_among_all(self) -> bool:
        """Return whether to look for garbage among all objects. The distance doubles when the time has doubled."""
        distance = COLLECT_NS << max(0, (self.now // COLLECT_ALL_NS).bit_length() - 1)
        before, self._collected_all_at = self._collected_all_at, self.now // distance * distance
        return before != self._collected_all_at

    @property
    def is_stopped(self) -> bool:
        """Whether the last run was stopped before its end."""
        return self._stopped

    def stop(self) -> None:
        """End the run: `run` returns when the current task reaches its next wait, or at once if the host calls this."""
        self._stopped = True
        self._until = -1
        if self.current is not self.host:
            heappush(self.ready, (-1, 0, self.host))

    def break_off(self, why: BaseException) -> None:
        """End the run as soon as the running task gives the CPU away; called by another thread, which holds `guard`.

        Args:
            why: the error that `run` raises, now and in later calls.
        """
        if self.broken is None:
            self.broken = why
        self._until = -1
        self._stopped = True
        if self.current is not self.host:
            heappush(self.ready, (-1, 0, self.host))

    def give_up(self) -> None:
        """Leave tasks that have not ended where they are; called by another thread."""
        self._gave_up = self.is_lost = True

    @contextmanager
    def _letting_run(self) -> Iterator[None]:
        """Mark the time while the host runs tasks; an error for one of the tasks can strike the host here."""
        was_running, self.is_running = self.is_running, True
        try:
            yield
        except TaskExit:
            if self.broken is None:
                raise
        finally:
            while self.is_running is not was_running:
                with suppress(TaskExit):
                    self._stand_still(was_running)

    def _stand_still(self, was_running: bool) -> None:
        with self.guard:
            self.is_running = was_running
            if self.broken is not None and not was_running:
                take_back()

    def _collect(self, collect: Callable[[], object]) -> None:
        """Collect garbage; a strike at a finalizer may arrive late."""
        self.is_collecting = True
        try:
            with suppress(TaskExit):
                collect()
        finally:
            self.is_collecting = False

    def _await(self) -> None:
        """Wait in the host until the baton comes back; continue without it if its task is lost."""
        self.context.enter(self.host, lambda: self.is_lost)
        if self.is_lost:
            self._leave(self.current)

    def _leave(self, task: Task) -> None:
        """Continue in the host without a task; this kernel never runs the task again."""
        self.is_lost = False
        self.current = self.host
        if task is self.host or task.done:
            return
        self.context.disown(task)
        task.done = True
        self.tasks.remove(task)
        self.stuck.append(task)
        self._leave_held(task)

    @contextmanager
    def unwinding(self) -> Iterator[None]:
        """Let tasks end as at the end of a computer: their mutexes stay locked for no other task."""
        before, self._is_unwinding = self._is_unwinding, True
        try:
            yield
        finally:
            self._is_unwinding = before

    def unwind(self) -> None:
        """End every task, the youngest first; the clock and the trace continue. The host calls this when it resets a
        computer.
        """
        with self.unwinding():
            while self.tasks:
                self.kill(self.tasks[-1])
        self.ready.clear()
        self.timers.clear()
        self._last = None

    def check_caller(self) -> None:
        """Check that the caller can make the tasks continue.

        Raises:
            RuntimeError: if the tasks belong to another process, or, with greenlets, to another thread.
        """
        why = self.context.stranger()
        if why:
            raise RuntimeError(f"this mission cannot continue from here: {why}")

    def shutdown(self, tidy: bool = False) -> None:
        """Unwind every task and release their threads; the host calls this at the end.

        Args:
            tidy: collect the garbage of the run, because Python hardly collects any: collection is off while tasks run.
        """
        self.unwind()
        self.context.end_run()
        if tidy and gc.isenabled():
            with self._letting_run():
                self._collect(collect_leftovers)
        self._begun = False

    def waiting(self) -> str:
        """Return the deadlock report: each waiting task, the object it waits for, and the holder of the object."""
        return waiting_report(self.tasks, self.timers)

    def deadlocked(self) -> list[tuple[Wait, ...]]:
        """Return the cycles of tasks that wait for each other forever, and the tasks that wait for an ended task.

        Holders are known for OSAL's mutexes and readers-writer locks, for recursive locks of nodes and, while schedules
        are explored, for their plain locks.
        """
        return circles(endless(self.tasks))

    def progress(self) -> tuple[int, int, int]:
        """Return numbers of which at least one changes with every kernel call that makes time or another task
        advance.
        """
        return self.now, self.sequence, self._front

    def next_event(self) -> int | None:
        """Return the virtual time of the next event in ns: now if a task is ready, None if there is no event."""
        if self.ready:
            return self.now
        timers = self.timers
        while timers and timers[0][2].timer != timers[0][1]:
            heappop(timers)
        return timers[0][0] if timers else None

    def _drop_pause_mark(self) -> None:
        """Remove the host's empty mark from the trace, recorded when the host got the CPU."""
        if self.trace is not None:
            self.trace.drop_empty()

    def _drop_host(self) -> None:
        """Remove the host from the ready tasks after a `stop`."""
        self._drop_pause_mark()
        self.ready = [entry for entry in self.ready if entry[2] is not self.host]
        heapify(self.ready)

    def _enter(self) -> None:
        """Hand the baton to the tasks and wait in the host until it comes back."""
        host = self.host
        self.context.bind_host(host)
        self.context.prepare_run(self.tasks)
        following = self._next()
        if following is not host:
            self._go_on_with(following)
            try:
                following.resume()
                self._await()
            except BaseException as error:
                self._take_back(error)
        if self._interrupted is not None:
            interrupted, self._interrupted = self._interrupted, None
            raise interrupted
        if self._failed:
            failed = self._failed.pop(0)
            assert failed.error is not None
            raise failed.error

    def _go_on_with(self, task: Task) -> None:
        """Dispatch the first task after a pause, with the same record and cost as without the pause."""
        last, self._last = self._last, None
        self.current = task
        if task is last:
            return
        if self.record is not None:
            self.record(task.exit_mark if last is not None and last.done else task.mark)
        if last is not None and not last.done:
            self.now += self.switch_cost_ns
            task.cpu_ns += self.switch_cost_ns

    def _take_back(self, error: BaseException) -> None:
        """Stop the clock after a signal woke the host while a task has the baton, and wait for the baton."""
        if self.current is not self.host:
            self._until = -1
            self._stopped = True
            heappush(self.ready, (-1, 0, self.host))
            while self.current is not self.host:
                try:
                    if self.context.interrupt(lambda: self.current, self.host):
                        self.current = self.host
                    else:
                        self._leave(self.current)
                except KeyboardInterrupt:
                    continue  # another Ctrl-C changes nothing
        raise error

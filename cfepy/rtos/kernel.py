"""The simulated real-time kernel: the scheduler, the life of tasks, and the host that lets them run.

`Scheduler` decides which task runs; this adds the start and end of tasks, and `run`, which the host calls. It may be
used by one host thread at a time.
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
from cfepy.interpreter.garbage import collect_leftovers, freeze_many, no_collection
from cfepy.rtos.context import make_context, take_back
from cfepy.rtos.errors import DeadlockError
from cfepy.rtos.scheduler import Scheduler
from cfepy.rtos.task import Task, TaskExit
from cfepy.rtos.wait_graph import Wait, circles, endless, waiting_report

ENDLESS = 1 << 62
COLLECT_NS = 10_000_000_000  # garbage is collected at multiples of this: finalizers always run at the same place


@mypyc_attr(allow_interpreted_subclasses=True)
class Kernel(Scheduler):
    """One simulated processor.

    Args:
        context: "thread" or "greenlet"; see `cfepy.rtos.context`.
        trace: where the records of the run go; None records nothing (for measurements only).
        tick_ns: deadlines are rounded up to multiples of this; 0 for a tickless clock.
        switch_cost_ns: virtual CPU time that a change of task takes.
        seed: what random streams above the kernel are derived from; the kernel itself uses no randomness.

    Attributes:
        is_running: the host lets tasks run or end, and waits for that.
        is_collecting: the host itself runs finalizers.
        broken: why the run was broken off; None as long as it was not.
        is_lost: the running task will not give the CPU back; the host is about to go on without it.
        guard: held by who looks at these from another thread and acts on it.
        frames_wanted: somebody looks at the Python frames of tasks, so code that is no Python shows itself in one.
        call_heard: gets the place and the arguments of each call that code which is no Python makes; None for nobody.
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
        self.is_running = self.is_collecting = self.is_lost = False
        self.broken: BaseException | None = None
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
            name: for traces and reports.
            entry: called without arguments in the new task.
            priority: 0 (most urgent) to 255; a more urgent task runs before this call returns.
            owner: kept in `Task.owner`; None takes over the caller's.
        """
        self._idents = ident = self._idents + 1
        task = Task(name, ident, entry, priority)
        parent = self.current
        task.owner = parent.owner if owner is None else owner
        parent.children += 1
        task.path = f"{parent.path}.{parent.children}" if parent.path else str(parent.children)
        self.context.create(task, self._main)  # fails where the host has no more threads
        self._enlist(task)
        self.make_ready(task, None)
        return task

    def _enlist(self, task: Task) -> None:
        """It is one of the tasks from now on."""
        self.tasks.append(task)

    @property
    def tasks_made(self) -> int:
        """How many tasks there have been."""
        return self._idents

    def kill(self, task: Task) -> None:
        """End a task: `TaskExit` comes out of the call it waits in, and its `finally` blocks run, before this returns.

        A task that kills itself does not come back from this call.
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
        """Have an exception come out of the call that another task waits in; it goes on from there.

        Args:
            task: one that has started and has not ended; else nothing happens.
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
        """Whether a task waits for something, a time included."""
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
        """Change the priority that a task has by itself; what it inherited from waiters of its mutexes stays."""
        task.base_priority = priority
        self.inherit(task)
        self.preempt()

    def _finish_in(self, task: Task) -> None:
        """Let a dying task unwind, and come back."""
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
        """The life of a task; returns the one to resume at its end."""
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
        if task.done:  # the host went on without it
            return self.host
        task.done = True
        task.entry = None
        for mutex in task.held[:]:
            mutex.abandon(task)
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
        except Exception as broken:  # the hook itself; were it to come out here, the baton would be lost
            task.error = broken
            handled = False
        if not handled:
            self._failed.append(task)

    # -- the host --------------------------------------------------------------------------------------------------

    def run(self, until_ns: int | None = None) -> None:
        """Run tasks; only the host may call this.

        Args:
            until_ns: virtual time at which to come back; events at that very instant are included. None runs until no
                task can ever go on.

        Raises:
            DeadlockError: without `until_ns`, when tasks are left that can never go on.
            BaseException: what a task raised, when `on_task_error` did not handle it; KeyboardInterrupt; what the run
                was broken off for, also in every later call.
        """
        if self.current is not self.host:
            raise RuntimeError("run() cannot be called from inside the simulation")
        self.check_caller()
        self._check_whole()
        end = ENDLESS if until_ns is None else until_ns
        if self.passes(end):
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
        """That the run was not broken off."""
        if self.broken is not None:
            raise self.broken

    def passes(self, until_ns: int) -> bool:
        """Let virtual time go by, if nothing happens before it is `until_ns` or at that instant; whether it did.

        A run that waits for the wall clock mostly finds it so, and who brings something in for it waits for this.
        """
        if self.current is not self.host or self.broken is not None or not self._is_idle_until(until_ns):
            return False
        self._stopped = False
        self.now = max(self.now, until_ns)
        return True

    def _is_idle_until(self, end: int) -> bool:
        """Whether nothing happens up to a virtual time."""
        if not self._begun or self.ready or self._failed or self._interrupted is not None or end >= self._collect_at:
            return False
        upcoming = self.next_event()
        return upcoming is not None and upcoming > end

    def _run_until(self, end: int) -> None:
        """Run piece by piece: between the pieces, at fixed virtual times, garbage is collected."""
        while self.now <= end:
            if self.now >= self._collect_at:
                self._collect(gc.collect)
                self._collect_at = self.now // COLLECT_NS * COLLECT_NS + COLLECT_NS
            self._until = min(end, self._collect_at)
            self._enter()
            self._drop_pause_mark()
            if self._stopped or self._exhausted or self._until >= end or self.broken is not None:
                return
            self.now = max(self.now, self._until)

    @property
    def is_stopped(self) -> bool:
        """Whether the last run ended before its time, because it was stopped."""
        return self._stopped

    def stop(self) -> None:
        """End the run: `run` returns as soon as the current task reaches its next wait, or at once from the host."""
        self._stopped = True
        self._until = -1
        if self.current is not self.host:
            heappush(self.ready, (-1, 0, self.host))

    def break_off(self, why: BaseException) -> None:
        """Called by another thread, which holds `guard`: the run ends as soon as the running task gives the CPU away.

        Args:
            why: what `run` raises, now and from now on.
        """
        if self.broken is None:
            self.broken = why
        self._until = -1
        self._stopped = True
        if self.current is not self.host:
            heappush(self.ready, (-1, 0, self.host))

    def give_up(self) -> None:
        """Called by another thread: tasks that have not ended yet are left where they are."""
        self._gave_up = self.is_lost = True

    @contextmanager
    def _letting_run(self) -> Iterator[None]:
        """Around what the host lets tasks do. An error that was meant for one of them may strike the host."""
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
        """Collect garbage. What strikes a finalizer may come a little late."""
        self.is_collecting = True
        try:
            with suppress(TaskExit):
                collect()
        finally:
            self.is_collecting = False

    def _await(self) -> None:
        """Wait in the host until the baton comes back; go on without it when its task is lost."""
        self.context.enter(self.host, lambda: self.is_lost)
        if self.is_lost:
            self._leave(self.current)

    def _leave(self, task: Task) -> None:
        """Go on in the host without a task: it will never run again as far as this kernel is concerned."""
        self.is_lost = False
        self.current = self.host
        if task is self.host or task.done:
            return
        self.context.disown(task)
        task.done = True
        self.tasks.remove(task)
        self.stuck.append(task)
        for mutex in task.held[:]:
            mutex.abandon(task)

    def unwind(self) -> None:
        """End every task, youngest first; the clock and the trace go on. The host calls it when a computer is reset."""
        while self.tasks:
            self.kill(self.tasks[-1])
        self.ready.clear()
        self.timers.clear()
        self._last = None

    def check_caller(self) -> None:
        """That the caller can let the tasks go on.

        Raises:
            RuntimeError: it is in another process than they are, or for greenlets in another thread.
        """
        why = self.context.stranger()
        if why:
            raise RuntimeError(f"this mission cannot continue from here: {why}")

    def shutdown(self, tidy: bool = False) -> None:
        """Unwind every task and let their threads go. The host calls it at the end.

        Args:
            tidy: what the run leaves is worth looking for garbage, which is hardly ever done by itself: it is off
                while tasks run.
        """
        self.unwind()
        self.context.end_run()
        if tidy and gc.isenabled():
            with self._letting_run():
                self._collect(collect_leftovers)
        self._begun = False

    def waiting(self) -> str:
        """The deadlock report: each waiting task, what it waits for, and its holder."""
        return waiting_report(self.tasks, self.timers)

    def deadlocked(self) -> list[tuple[Wait, ...]]:
        """The circles of tasks that wait for each other for ever, and the tasks that wait for one that has ended.

        Known are the holders of OSAL's mutexes and readers-writer locks, of the recursive locks of nodes, and, while
        schedules are explored, of their plain locks.
        """
        return circles(endless(self.tasks))

    def progress(self) -> tuple[int, int, int]:
        """Numbers of which one changes with every kernel call that lets time or another task go on."""
        return self.now, self.sequence, self._front

    def next_event(self) -> int | None:
        """Virtual time of the next thing to happen: now if a task is ready, None if there is nothing."""
        if self.ready:
            return self.now
        timers = self.timers
        while timers and timers[0][2].timer != timers[0][1]:
            heappop(timers)
        return timers[0][0] if timers else None

    def _drop_pause_mark(self) -> None:
        """Take the host's empty mark, recorded when the host got the CPU, out of the trace."""
        if self.trace is not None:
            self.trace.drop_empty()

    def _drop_host(self) -> None:
        """`stop` put the host among the ready tasks; it is back now."""
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
        """Dispatch the first task after a pause, with the record and the cost it would have had without the pause."""
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
        """A signal woke the host while a task has the baton: stop the clock and never go on before it is back."""
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
                    continue  # Ctrl-C once more; there is nothing more to do about it
        raise error

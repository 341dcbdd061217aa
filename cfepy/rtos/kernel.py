"""The simulated real-time kernel: virtual time, strict priorities, and one task running at any moment.

A task gives up the CPU only inside a kernel call: when it waits, when it makes a more urgent task ready, or when the
virtual CPU time it used lets another one in. When nobody is ready, the clock jumps to the next deadline, so idle time
costs nothing. Who runs next is decided in the task that yields, which then hands the baton over directly.

This is the one long module of cfepy: its parts share the ready heap, the timer heap and the clock, and its hot paths
are written out where a call would cost more than the work. It takes no lock and never logs. It stands for the
scheduler below OSAL (a POSIX kernel with SCHED_FIFO, FreeRTOS) and knows nothing of OSAL or cFE.
"""

from __future__ import annotations

import gc
from collections.abc import Callable
from heapq import heapify, heappop, heappush
from types import TracebackType
from typing import Any

from cfepy import trace as tr
from cfepy.rtos.context import make_context
from cfepy.rtos.errors import DeadlockError
from cfepy.rtos.policy import Policy
from cfepy.rtos.report import waiting_report
from cfepy.rtos.task import FOREVER, TIMEOUT, Task, TaskExit, WaitList

ENDLESS = 1 << 62
HOST_PRIORITY = 256
COLLECT_NS = 10_000_000_000  # garbage is collected at multiples of this: finalizers always run at the same place
SLICE_NS = 20_000  # equals take turns when this much virtual CPU time was used
MAX_REFUSALS = 100  # kernel calls that a dying task may try before it is left where it stands


class Kernel:
    """One simulated processor.

    Args:
        context: "thread" or "greenlet"; see `cfepy.rtos.context`.
        trace: where the records of the run go; None records nothing (for measurements only).
        policy: who runs next among equals; None is first come, first served.
        tick_ns: deadlines are rounded up to multiples of this; 0 for a tickless clock.
        switch_cost_ns: virtual CPU time that a change of task takes.
        seed: what random streams above the kernel are derived from; the kernel itself uses no randomness.
    """

    def __init__(
        self,
        context: str = "thread",
        trace: tr.Trace | None = None,
        policy: Policy | None = None,
        tick_ns: int = 0,
        switch_cost_ns: int = 0,
        seed: int = 0,
    ) -> None:
        self.now = 0
        self.tick_ns = tick_ns
        self.switch_cost_ns = switch_cost_ns
        self.seed = seed
        self.trace = trace
        self.record: Callable[[bytes], None] | None = trace.append if trace is not None else None
        self.policy = policy
        self.context = make_context(context)
        self.tasks: list[Task] = []
        self.ready: list[tuple[int, int, Task]] = []
        self.timers: list[tuple[int, int, Task]] = []
        self.sequence = 0
        self.on_task_error: Callable[[Task, BaseException], bool] = lambda task, error: False
        self.stuck: list[Task] = []  # tasks that would not die
        self.host = self.current = Task("host", 0, None, HOST_PRIORITY)
        self.host.dying = True  # the host must never wait: `_refuse` catches it where dying tasks are caught
        self.host.mark = self.host.exit_mark = b""  # a pause of the run leaves no mark: slices of a run are one run
        self._front = 0
        self._idents = 0
        self._until = 0
        self._slice_task: Task | None = None
        self._slice_from = 0
        self._slice_end = 0
        self._last: Task | None = None  # who gave the CPU to the host when the run paused
        self._failed: list[Task] = []
        self._interrupted: BaseException | None = None
        self._stopped = False
        self._exhausted = False
        self._frozen = False
        self._collect_at = COLLECT_NS

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
        task.owner = self.current.owner if owner is None else owner
        self.tasks.append(task)
        self.context.create(task, self._main)
        self.make_ready(task, None)
        return task

    def kill(self, task: Task) -> None:
        """End a task: `TaskExit` comes out of the call it waits in, and its `finally` blocks run, before this returns.

        A task that kills itself does not come back from this call.
        """
        if task is self.current:
            raise TaskExit
        if task.done:
            return
        task.dying = True
        task.timer = 0
        if task.waits is not None:
            task.waits.remove(task)
            task.waits = None
        self.ready = [entry for entry in self.ready if entry[2] is not task]
        heapify(self.ready)
        self._finish_in(task)
        self.preempt()  # its end may have made a more urgent task ready

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
        self.current = task
        task.resume()
        if killer is self.host:
            self.context.enter(killer)
        elif killer.park is not None:
            killer.park()
        self.current = killer
        if killer is self.host:
            self._drop_pause_mark()

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
            self._failure(task, error)
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
        if not isinstance(error, Exception) and not isinstance(error, SystemExit):
            self._interrupted = error  # Ctrl-C reached a task on the host's own thread
            return
        try:
            handled = self.on_task_error(task, error)
        except TaskExit:
            handled = True
        if not handled:
            self._failed.append(task)

    # -- waiting ---------------------------------------------------------------------------------------------------

    def delay(self, duration_ns: int) -> None:
        """Sleep for a time in ns, at least 1, rounded up to the board's tick."""
        task = self.current
        if task.dying:
            self._refuse(task)
        when = self.now + (duration_ns if duration_ns > 0 else 1)
        if self.tick_ns:
            when = -(-when // self.tick_ns) * self.tick_ns
        self.sequence = task.timer = sequence = self.sequence + 1
        heappush(self.timers, (when, sequence, task))
        self.block()

    def wait_on(self, waits: WaitList, timeout_ns: int = FOREVER) -> Any:
        """Wait in a list until `wake_first` or `wake_all`.

        Args:
            waits: where to wait.
            timeout_ns: the longest time, at least 1; FOREVER (-1) for no limit.

        Returns:
            The value that was given to the waker's call, or TIMEOUT.
        """
        task = self.current
        if task.dying:
            self._refuse(task)
        if waits and waits[-1].priority > task.priority:
            at = len(waits)
            while at and waits[at - 1].priority > task.priority:
                at -= 1
            waits.insert(at, task)
        else:
            waits.append(task)
        task.waits = waits
        if timeout_ns >= 0:
            self.arm(task, timeout_ns or 1)
        return self.block()

    def wake_first(self, waits: WaitList, value: Any = None) -> bool:
        """Make the most urgent waiter ready; it may run before this returns. False when nobody waits."""
        if not waits:
            return False
        self.make_ready(waits.pop(0), value)
        return True

    def wake_all(self, waits: WaitList, value: Any = None) -> int:
        """Make all waiters ready before any of them runs; how many they were."""
        tasks = waits[:]
        waits.clear()
        for task in tasks:
            self.enqueue(task, value)
        self.preempt()
        return len(tasks)

    def yield_cpu(self) -> None:
        """Let the others of the same priority run first."""
        task = self.current
        if task.dying:
            self._refuse(task)
        ready = self.ready
        if ready and ready[0][0] <= task.priority:
            self.sequence = sequence = self.sequence + 1
            heappush(ready, (task.priority, sequence, task))
            self._switch(task, self._take())

    def charge(self, duration_ns: int) -> None:
        """The current task used the CPU for `duration_ns` of virtual time: due timers fire, and others may get in."""
        task = self.current
        if task is self.host:
            return
        task.cpu_ns += duration_ns
        self.now = now = self.now + duration_ns
        timers = self.timers
        ready = self.ready
        if (
            (timers and timers[0][0] <= now)
            or now > self._until
            or (ready and ready[0][0] <= task.priority and now >= self._slice_end)
        ):
            self._catch_up(task, duration_ns)

    def _catch_up(self, task: Task, duration_ns: int) -> None:
        """Time went on under a running task: fire what is due; more urgent tasks, then equals, get their turn."""
        self._fire_due()
        if task.dying:
            return
        ready = self.ready
        first = ready[0][0] if ready else HOST_PRIORITY
        paused = self.now > self._until
        if first == task.priority and self.now >= self._slice_end and self._turn_is_over(task, duration_ns):
            self.sequence = sequence = self.sequence + 1
            heappush(ready, (task.priority, sequence, task))
        elif first < task.priority or paused:
            self._push_front(task)
        else:
            return
        if paused:
            self._last = task
        following = self.host if paused else self._take()
        if following is not task:
            self._switch(task, following)

    def _turn_is_over(self, task: Task, duration_ns: int) -> bool:
        """Whether a task used the CPU for a whole slice while equals were ready; a new slice begins when it did."""
        if self._slice_task is not task:
            self._slice_task = task
            self._slice_from = task.cpu_ns - duration_ns
        left = SLICE_NS - (task.cpu_ns - self._slice_from)
        self._slice_end = self.now + left
        if left > 0:
            return False
        self._slice_task = None
        self._slice_end = self.now
        return True

    def arm(self, task: Task, duration_ns: int) -> None:
        """Set the timer of a task that is about to wait; it replaces an earlier one."""
        when = self.now + duration_ns
        if self.tick_ns:
            when = -(-when // self.tick_ns) * self.tick_ns
        self.sequence = task.timer = sequence = self.sequence + 1
        heappush(self.timers, (when, sequence, task))

    def block(self) -> Any:
        """Give the CPU away until somebody makes the current task ready; the value it was made ready with.

        Whoever calls this has seen to it that somebody will, and that the task is not dying (`_refuse`).
        """
        task = self.current
        ready = self.ready
        following = (heappop(ready)[2] if self.policy is None else self._take()) if ready else self._advance()
        if following is not task:
            self.current = following
            if self.record is not None:
                self.record(following.mark)
            if self.switch_cost_ns and following is not self.host:
                self.now += self.switch_cost_ns
                following.cpu_ns += self.switch_cost_ns
            following.resume()
            if task.park is not None:
                task.park()
            if task.dying:
                raise TaskExit
        return task.wake

    def make_ready(self, task: Task, value: Any = None) -> None:
        """End the wait of a task, which must not be in a wait list any more; it runs now if it is more urgent."""
        task.wake = value
        task.timer = 0
        task.waits = None
        if self.record is not None:
            self.record(task.wake_mark)
        current = self.current
        if task.priority < current.priority and current is not self.host and not current.dying:
            self._push_front(current)
            self._switch(current, task)
        else:
            self.sequence = sequence = self.sequence + 1
            heappush(self.ready, (task.priority, sequence, task))

    def preempt(self) -> None:
        """Let a more urgent ready task run, if there is one."""
        task = self.current
        ready = self.ready
        if ready and ready[0][0] < task.priority and task is not self.host and not task.dying:
            following = self._take()
            self._push_front(task)
            self._switch(task, following)

    def inherit(self, task: Task) -> None:
        """Recompute a task's priority: its own, or that of the most urgent task that waits for a mutex it holds.

        When that changes it, so may the priority of the task that it waits for itself, and so on.
        """
        heir: Task | None = task
        while heir is not None:
            priority = heir.base_priority
            for mutex in heir.held:
                if mutex.waits and mutex.waits[0].priority < priority:
                    priority = mutex.waits[0].priority
            if priority == heir.priority:
                return
            self.reprioritize(heir, priority)
            heir = heir.mutex.owner if heir.mutex is not None else None

    def reprioritize(self, task: Task, priority: int) -> None:
        """Change a task's present priority, and its place among those that are ready or wait for the same thing."""
        task.priority = priority
        for at, (_, sequence, waiting) in enumerate(self.ready):
            if waiting is task:
                self.ready[at] = (priority, sequence, task)
                heapify(self.ready)
                return
        if task.waits is not None:
            task.waits.remove(task)
            at = len(task.waits)
            while at and task.waits[at - 1].priority > priority:
                at -= 1
            task.waits.insert(at, task)

    # -- choosing --------------------------------------------------------------------------------------------------

    def enqueue(self, task: Task, value: Any) -> None:
        """As `make_ready`, but the caller goes on even when the task is more urgent; `preempt` makes up for it."""
        task.wake = value
        task.timer = 0
        task.waits = None
        if self.record is not None:
            self.record(task.wake_mark)
        self.sequence = sequence = self.sequence + 1
        heappush(self.ready, (task.priority, sequence, task))

    def _push_front(self, task: Task) -> None:
        """A preempted task stays the first of its priority."""
        self._front = front = self._front - 1
        heappush(self.ready, (task.priority, front, task))

    def _take(self) -> Task:
        """Remove the task that runs next from the ready heap."""
        if self.policy is None:
            return heappop(self.ready)[2]
        first = heappop(self.ready)
        equals = [first]
        while self.ready and self.ready[0][0] == first[0]:
            equals.append(heappop(self.ready))
        chosen = equals.pop(self.policy.choose([entry[2] for entry in equals])) if len(equals) > 1 else equals.pop()
        for entry in equals:
            heappush(self.ready, entry)
        return chosen[2]

    def _next(self) -> Task:
        return self._take() if self.ready else self._advance()

    def _advance(self) -> Task:
        """Nobody is ready: move the clock to the next deadline. The host, when the run is over before that."""
        timers = self.timers
        while timers:
            when, sequence, task = timers[0]
            if task.timer != sequence:
                heappop(timers)
                continue
            if when > self._until:
                break
            heappop(timers)
            if when > self.now:
                self.now = when
                if self.trace is not None:
                    records = self.trace.records
                    records.append(tr.pack_time(tr.TIME, when))
                    if len(records) > tr.BATCH:
                        self.trace.flush()
            self._time_out(task)
            if timers and timers[0][0] <= self.now:
                self.sequence = order = self.sequence + 1
                heappush(self.ready, (task.priority, order, task))
                self._fire_due()
                return self._take()
            return task  # the usual case: exactly one timer is due
        self._exhausted = not timers
        if self.current is not self.host:
            self._last = self.current
        return self.host

    def _fire_due(self) -> None:
        timers = self.timers
        now = self.now
        while timers and timers[0][0] <= now:
            _, sequence, task = heappop(timers)
            if task.timer == sequence:
                self._time_out(task)
                self.sequence = order = self.sequence + 1
                heappush(self.ready, (task.priority, order, task))

    def _time_out(self, task: Task) -> None:
        task.timer = 0
        task.wake = TIMEOUT
        if task.waits is not None:
            task.waits.remove(task)
            task.waits = None

    def _switch(self, task: Task, following: Task) -> None:
        """Hand the baton from `task`, which is in the ready heap already, to `following`."""
        self.current = following
        if self.record is not None:
            self.record(following.mark)
        if self.switch_cost_ns and following is not self.host:
            self.now += self.switch_cost_ns
            following.cpu_ns += self.switch_cost_ns
        following.resume()
        if task.park is not None:
            task.park()
        if task.dying:
            raise TaskExit

    def _refuse(self, task: Task) -> None:
        """A dying task, or the host, must not wait."""
        if task is self.host:
            raise RuntimeError("this call waits, so only a task inside the simulation can make it")
        task.refusals += 1
        if task.refusals > MAX_REFUSALS and task.killer is not None:
            self._leave_behind(task, task.killer)
        raise TaskExit

    def _leave_behind(self, task: Task, killer: Task) -> None:
        """It swallows every TaskExit: never run it again, and let the killer go on."""
        task.done = True
        self.tasks.remove(task)
        self.stuck.append(task)
        for mutex in task.held[:]:
            mutex.abandon(task)
        self.current = killer
        killer.resume()
        while task.park is not None:
            task.park()

    # -- the host --------------------------------------------------------------------------------------------------

    def run(self, until_ns: int | None = None) -> None:
        """Run tasks; only the host may call this.

        Args:
            until_ns: virtual time at which to come back; events at that very instant are included. None runs until no
                task can ever go on.

        Raises:
            DeadlockError: without `until_ns`, when tasks are left that wait for each other or for nobody.
            BaseException: what a task raised, when `on_task_error` did not handle it; KeyboardInterrupt.
        """
        if self.current is not self.host:
            raise RuntimeError("run() was called from inside the simulation")
        end = ENDLESS if until_ns is None else until_ns
        self._stopped = self._exhausted = False
        if not self._frozen:
            gc.freeze()
            self._frozen = True
        enabled = gc.isenabled()
        gc.disable()
        try:
            self._run_until(end)
        finally:
            self._drop_host()
            if enabled:
                gc.enable()
        if not self._stopped and until_ns is not None:
            self.now = max(self.now, until_ns)
        if until_ns is None and self._exhausted and self.tasks:
            raise DeadlockError(self.waiting())

    def _run_until(self, end: int) -> None:
        """Run piece by piece: between the pieces, at fixed virtual times, garbage is collected."""
        while self.now <= end:
            if self.now >= self._collect_at:
                gc.collect()
                self._collect_at = self.now // COLLECT_NS * COLLECT_NS + COLLECT_NS
            self._until = min(end, self._collect_at)
            self._enter()
            self._drop_pause_mark()
            if self._stopped or self._exhausted or self._until >= end:
                return
            self.now = max(self.now, self._until)

    def stop(self) -> None:
        """End the run: `run` returns as soon as the current task reaches its next wait, or at once from the host."""
        self._stopped = True
        self._until = -1
        if self.current is not self.host:
            heappush(self.ready, (-1, 0, self.host))

    def shutdown(self) -> None:
        """Unwind every task, youngest first, and let their threads go. The host calls it at the end."""
        while self.tasks:
            self.kill(self.tasks[-1])
        self.ready.clear()
        self.timers.clear()
        if self._frozen:
            gc.unfreeze()
            self._frozen = False

    def waiting(self) -> str:
        """Who waits for what, held by whom: the deadlock report."""
        return waiting_report(self.tasks, self.timers)

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
        """Whoever gave the CPU to the host recorded the host's empty mark; nobody is to see it."""
        records = self.trace.records if self.trace is not None else []
        if records and not records[-1]:
            records.pop()

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
                self.context.enter(host)
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
            self.context.interrupt(lambda: self.current, self.host, TaskExit)
            self.current = self.host
        raise error

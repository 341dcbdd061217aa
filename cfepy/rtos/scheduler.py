"""The scheduler: the running task, the waiting tasks and their deadlines, virtual time, strict priorities, direct
hand-over.

A task gives up the CPU only inside a kernel call: if it waits, if it makes a more urgent task ready, or if the virtual
CPU time that it used lets another task run. If no task is ready, the clock jumps to the next deadline, so idle time
costs nothing. The task that yields chooses the next task and hands the CPU directly to it.

All parts of this module share the ready heap, the timer heap and the clock. Its hot paths are inlined where a call
would cost more than the work. It takes no lock and never logs. It models the scheduler below OSAL (a POSIX kernel with
SCHED_FIFO, FreeRTOS) and does not depend on OSAL or cFE.
"""

from __future__ import annotations

from collections.abc import Callable
from heapq import heapify, heappop, heappush
from operator import index
from typing import TYPE_CHECKING, Any, NamedTuple, SupportsIndex

from cfepy import trace as tr
from cfepy.interpreter.compiled import mypyc_attr
from cfepy.rtos.policy import Policy, Question
from cfepy.rtos.task import FOREVER, TIMEOUT, Task, TaskExit
from cfepy.rtos.wait_list import WaitList

if TYPE_CHECKING:
    from cfepy.rtos.kept_back import KeptBack, ReadyWatch

HOST_PRIORITY = 256
LOOK_NS = 100_000_000  # virtual time between two looks at the ready tasks
FAIR_PRIORITY = 100
SLICE_NS = 20_000  # tasks of equal priority take turns after this much virtual CPU time
MAX_REFUSALS = 100  # number of kernel calls that a dying task may try before the kernel abandons it


def whole(time_ns: Any) -> int:
    """Return a time as an int, because a clock that became a float would never be exact again.

    Raises:
        TypeError: if it is not a whole number.
    """
    try:
        return int(index(time_ns))
    except TypeError:
        raise TypeError(f"time must be an int, not {time_ns!r}") from None


class Abortion(NamedTuple):
    """The end of the whole flight software by abort() or a signal.

    Attributes:
        task: the task that caused it.
        text: the cause.
        at_ns: virtual time in ns.
    """

    task: Task
    text: str
    at_ns: int


@mypyc_attr(allow_interpreted_subclasses=True)
class Scheduler:
    """The base class of `Kernel`, which documents the arguments."""

    def __init__(self, trace: tr.Trace | None, tick_ns: int, switch_cost_ns: int) -> None:
        self.now = 0
        self.tick_ns = tick_ns
        self.switch_cost_ns = switch_cost_ns
        self.trace = trace
        self.record: Callable[[bytes], None] | None = trace.append if trace is not None else None
        self.policy: Policy | None = None  # None means first come, first served
        self.tasks: list[Task] = []
        self.ready: list[tuple[int, int, Task]] = []
        self.timers: list[tuple[int, int, Task]] = []
        self.sequence = 0
        self.stuck: list[Task] = []  # tasks that did not end when they were killed
        self.host = self.current = Task("host", 0, None, HOST_PRIORITY)
        self.host.dying = True  # the host must never wait: `_refuse` catches it together with dying tasks
        self.host.mark = self.host.exit_mark = b""  # a pause leaves no mark: a run in parts has the same trace
        self._front = 0
        self._until = 0
        self._slice_task: Task | None = None
        self._slice_from = 0
        self._slice_end = 0
        self._last: Task | None = None  # the task that gave the CPU to the host when the run paused
        self._exhausted = False
        self._is_unwinding = False
        self.broken: BaseException | None = None
        self.abortion: Abortion | None = None
        self.is_fair = False
        self._ready_watch: ReadyWatch | None = None
        self._look_at = LOOK_NS

    # -- waiting ---------------------------------------------------------------------------------------------------

    def delay(self, duration_ns: SupportsIndex) -> None:
        """Sleep for a time in ns, at least 1, rounded up to the board's tick."""
        task = self.current
        if task.dying:
            self._refuse(task)
        length = duration_ns if type(duration_ns) is int else whole(duration_ns)
        when = self.now + (length if length > 0 else 1)
        if self.tick_ns:
            when = -(-when // self.tick_ns) * self.tick_ns
        self.sequence = task.timer = sequence = self.sequence + 1
        heappush(self.timers, (when, sequence, task))
        self.block()

    def may_start_early(self, name: str) -> None:
        """Announce that the start delay of the task with this name is not a delay that its application can rely on."""

    def has_started(self) -> None:
        """Announce that the start delay of the current task is over."""

    def tell(self, subject: object, call: str, args: tuple[object, ...] = ()) -> None:
        """Report an action of the current task that may affect other tasks and is not a call of a service or a lock.

        Args:
            subject: the object of the action.
            call: name of the action.
            args: further objects of the action.
        """

    def connection_delay(self, publisher: str, subscriber: str, topic: str, usual_ns: int) -> int:
        """Return the delay until two nodes are connected, in virtual ns.

        Args:
            publisher: name of the publishing node.
            subscriber: name of the subscribing node.
            topic: its resolved name.
            usual_ns: the mission's delay, in virtual ns.
        """
        return usual_ns

    def answer(self, question: Question) -> int:
        """Return the index of the schedule's answer to an open question; without a policy 0, the first answer."""
        return 0

    def wait_on(self, waits: WaitList, timeout_ns: SupportsIndex = FOREVER) -> Any:
        """Wait in a list until `wake_first` or `wake_all`.

        Args:
            waits: the list to wait in.
            timeout_ns: the longest time, at least 1; FOREVER (-1) for no limit.

        Returns:
            The value of the waker's call, or TIMEOUT.
        """
        task = self.current
        if task.dying:
            self._refuse(task)
        limit = FOREVER
        if timeout_ns != FOREVER:
            limit = timeout_ns if type(timeout_ns) is int else whole(timeout_ns)
        if waits and waits[-1].priority > task.priority:
            at = len(waits)
            while at and waits[at - 1].priority > task.priority:
                at -= 1
            waits.insert(at, task)
        else:
            waits.append(task)
        task.waits = waits
        if limit >= 0:
            self.arm(task, limit or 1)
        else:
            task.since = self.now
        return self.block()

    def wake_first(self, waits: WaitList, value: Any = None) -> bool:
        """Make the most urgent waiter ready; it may run before this call returns.

        Returns:
            False if no task waits.
        """
        if not waits:
            return False
        self.make_ready(waits.pop(0), value)
        return True

    def wake_all(self, waits: WaitList, value: Any = None) -> int:
        """Make all waiters ready before any of them runs; return their number."""
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
            self._push_back(task)
            self._switch(task, self._take())

    def delay_nothing(self, cost_ns: int) -> None:
        """Sleep for no time, as Linux does: tasks of the same priority run first, and less urgent ones do not run.

        Args:
            cost_ns: CPU time of the call, so that a loop of such calls comes to an end; at least 1 is charged.
        """
        self.charge(max(cost_ns, 1))
        self.yield_cpu()

    def charge(self, duration_ns: int) -> None:
        """Charge the current task `duration_ns` of virtual CPU time; due timers fire, and other tasks may run."""
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

    def compute(self, duration_ns: SupportsIndex) -> None:
        """Use virtual CPU time in the current task; events happen at their due times meanwhile.

        More urgent tasks run when they are due, and the work continues after them. `charge` is for short times: it lets
        all of the time pass before any event happens.

        Raises:
            TypeError: if the duration is not a whole number.
            ValueError: if it is negative.
        """
        left = whole(duration_ns)
        if left < 0:
            raise ValueError(f"invalid time {left} ns; expected 0 or more")
        task = self.current
        while left > 0 and task is not self.host:
            if task.dying:
                self._refuse(task)
            step = max(min(left, self._undisturbed()), 1)
            left -= step
            self.charge(step)

    def _undisturbed(self) -> int:
        """Return the time in ns until the next event, if the current task continues."""
        timers, ready = self.timers, self.ready
        while timers and timers[0][2].timer != timers[0][1]:
            heappop(timers)
        until = min(self._until + 1, timers[0][0]) if timers else self._until + 1
        if ready and ready[0][0] <= self.current.priority:
            until = min(until, self.now + SLICE_NS)
        return until - self.now

    def _catch_up(self, task: Task, duration_ns: int) -> None:
        """Handle time that passed under a running task: fire due timers, then let more urgent tasks and tasks of equal
        priority run.
        """
        self._fire_due()
        if task.dying:
            return
        if self.now >= self._look_at:
            self.look_at_ready()
        ready = self.ready
        first = ready[0][0] if ready else HOST_PRIORITY
        paused = self.now > self._until
        if first == task.priority and self.now >= self._slice_end and self._turn_is_over(task, duration_ns):
            self._push_back(task)
        elif first < task.priority or paused:
            self._push_front(task)
        else:
            return
        if paused:
            self._last = task
        following = self.host if paused else self._take()
        if following is not task:
            self._switch(task, following)

    def look_at_ready(self) -> None:
        """Note which tasks are ready without running (`cfepy.rtos.kept_back`)."""
        if self._ready_watch is None:
            from cfepy.rtos.kept_back import ReadyWatch

            self._ready_watch = ReadyWatch()
        task = self.current
        if task is self.host and self._last is not None:
            task = self._last
        self._ready_watch.look(self.now, task, self.ready)
        self._look_at = self.now + LOOK_NS

    def kept_back(self) -> list[KeptBack]:
        """Return the tasks that were ready for 100 ms or more without running."""
        return [] if self._ready_watch is None else list(self._ready_watch.found.values())

    def _turn_is_over(self, task: Task, duration_ns: int) -> bool:
        """Return whether a task used a whole time slice while tasks of equal priority were ready; if so, a new slice
        begins.
        """
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
        """Set the timer of a task that is about to wait, in place of an earlier one."""
        when = self.now + duration_ns
        if self.tick_ns:
            when = -(-when // self.tick_ns) * self.tick_ns
        self.sequence = task.timer = sequence = self.sequence + 1
        heappush(self.timers, (when, sequence, task))

    def block(self) -> Any:
        """Give the CPU away until the current task is made ready; return the value it was made ready with.

        The caller must ensure that this happens, and that the task is not dying (`_refuse`).
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
                raise _fate(task)
        return task.wake

    def make_ready(self, task: Task, value: Any = None) -> None:
        """End the wait of a task, which must no longer be in a wait list; it runs now if it is more urgent than the
        caller.
        """
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

    def call_joiners(self, task: Task) -> None:
        """Make the tasks ready that wait until a task can be deleted, without running them yet."""
        joiners = task.joiners
        if joiners is not None:
            while joiners:
                self.enqueue(joiners.pop(0), None)

    def _leave_held(self, task: Task) -> None:
        """Free the mutexes of a task that ends, except those that stay locked, as the mutexes of Linux's threads do.

        If a task waits for one of those at this time, the C library of NASA's process calls abort().
        """
        for mutex in task.held[:]:
            if not mutex.stays_locked or self._is_unwinding:
                mutex.abandon(task)
            elif mutex.waits:
                text = f"{task.name} ended while it held mutex {mutex.name}, for which {mutex.waits[0].name} waits"
                self.abort(task, f"{text} (assertion in pthread_mutex_lock)")

    def abort(self, task: Task, text: str) -> None:
        """End the whole flight software: after this no task runs.

        Args:
            task: the task that caused it.
            text: the cause.
        """
        if self.abortion is None:
            self.abortion = Abortion(task, text, self.now)
            self.stop()

    def stop(self) -> None:
        """End the run: `run` returns when the current task reaches its next wait, or at once if the host calls this."""
        raise NotImplementedError

    def inherit(self, task: Task) -> None:
        """Recompute a task's priority: its own, or the priority of the most urgent task that waits for one of its
        mutexes.

        A change can also change the priority of the owner of the mutex that the task itself waits for, and so on.
        """
        heir: Task | None = task
        while heir is not None and not heir.done:
            priority = heir.base_priority
            for mutex in heir.held:
                if mutex.waits and mutex.waits[0].priority < priority:
                    priority = mutex.waits[0].priority
            if priority == heir.priority:
                return
            self.reprioritize(heir, priority)
            heir = heir.mutex.owner if heir.mutex is not None else None

    def reprioritize(self, task: Task, priority: int) -> None:
        """Change a task's present priority, and its place among the ready tasks or in its wait list."""
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
        """Make a task ready like `make_ready`, but do not switch to it; the caller must call `preempt` afterwards."""
        task.wake = value
        task.timer = 0
        task.waits = None
        if self.record is not None:
            self.record(task.wake_mark)
        self.sequence = sequence = self.sequence + 1
        heappush(self.ready, (task.priority, sequence, task))

    def _push_front(self, task: Task) -> None:
        """Put a preempted task in front of the others of its priority."""
        self._front = front = self._front - 1
        heappush(self.ready, (task.priority, front, task))

    def _push_back(self, task: Task) -> None:
        """Put the running task behind the others of its priority."""
        self.sequence = sequence = self.sequence + 1
        heappush(self.ready, (task.priority, sequence, task))

    def _take(self) -> Task:
        """Remove the task that runs next from the ready heap."""
        return heappop(self.ready)[2]

    def _next(self) -> Task:
        return self._take() if self.ready else self._advance()

    def _advance(self) -> Task:
        """Move the clock to the next deadline because no task is ready; return the task to run, or the host if the run
        ends before.
        """
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
                trace = self.trace
                if trace is not None:
                    trace.append(tr.pack_time(tr.TIME, when))
                    if len(trace.records) > tr.BATCH:
                        trace.flush()
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
        """Hand the baton from `task`(already in the ready heap) to `following`."""
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
            raise _fate(task)

    def _refuse(self, task: Task) -> None:
        """Raise the error for a dying task, or the host, that tries to wait."""
        if task is self.host:
            raise RuntimeError("this call waits, so it requires a task inside the simulation")
        task.refusals += 1
        if task.refusals > MAX_REFUSALS and task.killer is not None:
            self._leave_behind(task, task.killer)
        raise TaskExit

    def _leave_behind(self, task: Task, killer: Task) -> None:
        """Abandon a task that swallows every TaskExit: it never runs again, and its killer continues."""
        task.done = True
        task.since = self.now
        self.tasks.remove(task)
        self.stuck.append(task)
        self._leave_held(task)
        self.current = killer
        killer.resume()
        while task.park is not None:
            task.park()


def _fate(task: Task) -> BaseException:
    """Return the exception for a task in the call that it waited in: its end, or an interruption that it survives."""
    interruption = task.interruption
    if interruption is None:
        return TaskExit()
    task.interruption = None
    task.dying = False
    return interruption

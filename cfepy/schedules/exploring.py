"""A kernel that asks a policy at every scheduling point which task runs, to find failures that fifo never shows.

Scheduling points are: each call of an app or a node into the API (`point`), each charge of virtual CPU time, each call
that makes another task ready or changes a priority, and each wait. Always taking candidate 0 gives exactly the run of
`Kernel`, which pays nothing for this module.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from heapq import heappop, heappush
from typing import Any, Protocol, SupportsIndex

from cfepy import trace as tr
from cfepy.rtos import SLICE_NS, Decision, Kernel, Policy, Question, Task
from cfepy.schedules.moves import stable_name
from cfepy.units import time_word

CONNECTION_DELAYS = 8  # delays of a connection to try, evenly spaced up to the longest, in addition to the usual one


class CallObserver(Protocol):
    """Called for the calls that are scheduling points, in the task that makes them; it must not wait or call back."""

    def called(self, subject: Any, call: str, args: tuple[Any, ...]) -> None:
        """Handle the start of a call, after other tasks had their chance to run.

        Args:
            subject: the object of the method: a service of cFE, or a lock of a node; `__init__` means that it was
                created.
            call: the method's name.
            args: its arguments.
        """

    def returned(self, subject: Any, call: str, args: tuple[Any, ...], result: Any) -> None:
        """Handle the end of a call with its result."""

    def failed(self, subject: Any, call: str) -> None:
        """Handle an exception from a call."""


class _All:
    """Several observers, called in order."""

    def __init__(self, observers: Sequence[CallObserver]) -> None:
        self._observers = observers

    def called(self, subject: Any, call: str, args: tuple[Any, ...]) -> None:
        for each in self._observers:
            each.called(subject, call, args)

    def returned(self, subject: Any, call: str, args: tuple[Any, ...], result: Any) -> None:
        for each in self._observers:
            each.returned(subject, call, args, result)

    def failed(self, subject: Any, call: str) -> None:
        for each in self._observers:
            each.failed(subject, call)


class ExploringKernel(Kernel):
    """A kernel that lets a policy choose.

    Args:
        context: see `Kernel`, as for the arguments not named here.
        policy: decides which task runs next.

    Attributes:
        observer: called for calls; None for none. `watch` adds one.
        on_wake: called with a task that the running one wakes; None for none.
    """

    def __init__(
        self,
        context: str,
        trace: tr.Trace | None,
        policy: Policy,
        tick_ns: int = 0,
        switch_cost_ns: int = 0,
        seed: int = 0,
    ) -> None:
        super().__init__(context, trace, tick_ns, switch_cost_ns, seed)
        self.policy = policy
        self.observer: CallObserver | None = None
        self._watching: tuple[CallObserver, ...] = ()
        self.on_wake: Callable[[Task], object] | None = None
        self.frames_wanted = True
        self._any = policy.any_priority
        self._hold_ns = policy.hold_ns
        self._late_ns = policy.late_ns
        self._decisions = 0
        self._going_on: Task | None = None  # the task that was just put in front: it could continue
        self._left: Task | None = None  # the task that just gave up its turn, or should have
        # tasks that wake others and continue, and those with a postponed scheduling point
        self._hushed: dict[Task, None] = {}
        self._owing: dict[Task, None] = {}
        self._early: dict[str, None] = {}  # names of tasks that may start early
        self._busy: Task | None = None  # the task that used the CPU last, and how long it may use it at once
        self._busy_until = 0

    def watch(self, observer: CallObserver) -> None:
        """Add an observer of calls."""
        self._look((*self._watching, observer))

    def unwatch(self, observer: CallObserver) -> None:
        """Remove an observer of calls."""
        self._look(tuple(each for each in self._watching if each is not observer))

    def _look(self, watching: tuple[CallObserver, ...]) -> None:
        self._watching = watching
        self.observer = None if not watching else watching[0] if len(watching) == 1 else _All(watching)

    def tell(self, subject: object, call: str, args: tuple[object, ...] = ()) -> None:
        """Report an action to the observers as the start of a call."""
        if self.observer is not None:
            self.observer.called(subject, call, args)

    # -- scheduling points -----------------------------------------------------------------------------------------

    def point(self) -> None:
        """Let other tasks run before a call of the current task."""
        task = self.current
        if self._hushed and self._is_quiet(task):
            self._owing[task] = None
            return
        if self._hold_ns or self._early:
            if task is self.host or task.dying or not self._has_choice(task):
                return
        else:  # for most calls no other task can run: they end here
            ready = self.ready
            if not ready or not (self._any or ready[0][0] <= task.priority) or task.dying or task is self.host:
                return
        self._push_front(task)
        following = self._take()
        if following is not task:
            self._switch(task, following)

    def preempt(self) -> None:
        """Let other tasks run now; more urgent ones always do."""
        self.point()

    def hush(self, call: Callable[..., Any], *args: Any, **options: Any) -> Any:
        """Make a call during which only more urgent tasks may run; the others may run after it, at `settle`.

        Args:
            call: the call; it makes tasks ready and does not wait.
            args: arguments of the call.
            options: keyword arguments of the call.
        """
        task = self.current
        self._hushed[task] = None
        try:
            return call(*args, **options)
        finally:
            self._hushed.pop(task, None)

    @property
    def is_hushed(self) -> bool:
        """Whether other tasks cannot run at a scheduling point of the current task."""
        return bool(self._hushed) and self._is_quiet(self.current)

    def _is_quiet(self, task: Task) -> bool:
        """Return whether no other task may run now: the running task is in a hushed call, and no more urgent task is
        ready.
        """
        return task in self._hushed and not (self.ready and self.ready[0][0] < task.priority)

    def settle(self) -> None:
        """Let the tasks run that the current task woke in hushed calls."""
        if self.current in self._owing:
            del self._owing[self.current]
            self.point()

    def forgive(self) -> None:
        """Drop the postponed scheduling point of a task that is about to wait or end, because others run then
        anyway.
        """
        self._owing.pop(self.current, None)

    def enqueue(self, task: Task, value: Any) -> None:
        if self.on_wake is not None:
            self.on_wake(task)
        super().enqueue(task, value)

    def delay(self, duration_ns: SupportsIndex) -> None:
        self.point()
        super().delay(duration_ns)

    def make_ready(self, task: Task, value: Any = None) -> None:
        self.enqueue(task, value)
        self.point()

    def charge(self, duration_ns: int) -> None:
        task = self.current
        if task is self.host:
            return
        task.cpu_ns = used = task.cpu_ns + duration_ns
        self.now = now = self.now + duration_ns
        if task is not self._busy:
            self._busy, self._busy_until = task, used + SLICE_NS
        elif used >= self._busy_until:
            self._left = task
            self._busy_until += SLICE_NS
        timers = self.timers
        ready = self.ready
        if (
            (ready and (self._any or ready[0][0] <= task.priority))
            or (timers and timers[0][0] - self._hold_ns <= now)
            or now > self._until
            or self._early
        ):
            self._catch_up(task, duration_ns)

    def _catch_up(self, task: Task, duration_ns: int) -> None:
        """Handle time like the base class, but let tasks of equal priority run each time, not only after a
        time slice.
        """
        self._fire_due()
        paused = self.now > self._until
        if task.dying or not (paused or self._has_choice(task)):
            return
        is_over = self._slice_is_used_up(task, duration_ns)
        if not (paused or is_over) and self._is_quiet(task):
            return
        if is_over:
            self._push_back(task)
        else:
            self._push_front(task)
        if paused:
            self._last = task
        following = self.host if paused else self._take()
        if following is not task:
            self._switch(task, following)

    def _slice_is_used_up(self, task: Task, duration_ns: int) -> bool:
        ready = self.ready
        return (
            bool(ready)
            and ready[0][0] == task.priority
            and self.now >= self._slice_end
            and self._turn_is_over(task, duration_ns)
        )

    def _has_choice(self, task: Task) -> bool:
        """Return whether another task could run from here."""
        ready = self.ready
        return (
            bool(ready and (self._any or ready[0][0] <= task.priority))
            or bool(self._hold_ns and self._next_timer(self._hold_ns) is not None)
            or bool(self._early and self._starters(task))
        )

    # -- tasks ---------------------------------------------------------------------------------------------------------

    def _enlist(self, task: Task) -> None:
        task.alias = stable_name(task, self.tasks)
        super()._enlist(task)

    # -- tasks that may start early ----------------------------------------------------------------------------------

    def may_start_early(self, name: str) -> None:
        self._early[name] = None

    def has_started(self) -> None:
        self._early.pop(self.current.name, None)

    def _starters(self, task: Task) -> list[Task]:
        """Return the tasks of the same application that could start now instead of later."""
        owner = task.owner
        return [each for each in self.tasks if each.timer and each.owner is owner and each.name in self._early]

    # -- questions -----------------------------------------------------------------------------------------------------

    def connection_delay(self, publisher: str, subscriber: str, topic: str, usual_ns: int) -> int:
        """Return the delay of a connection, which the policy chooses if connections are open to it."""
        assert self.policy is not None
        longest_ns = self.policy.connect_ns
        if not longest_ns:
            return usual_ns
        tried = (longest_ns * step // CONNECTION_DELAYS for step in range(CONNECTION_DELAYS + 1))
        delays = tuple(dict.fromkeys((usual_ns, *tried)))
        name = f"connection of {publisher} to {subscriber} on {topic}"
        words = tuple(time_word(delay) for delay in delays)
        return delays[self.answer(Question(name, "slow connection", words, f"{topic} connects in {{}}"))]

    def answer(self, question: Question) -> int:
        number = self._decisions
        self._decisions = number + 1
        assert self.policy is not None
        return self.policy.choose(Decision(number, self.now, (), False, False, None, question))

    # -- choosing --------------------------------------------------------------------------------------------------

    def _push_front(self, task: Task) -> None:
        self._front = front = self._front - 1
        heappush(self.ready, (task.priority, front, task))
        self._going_on = task

    def _push_back(self, task: Task) -> None:
        super()._push_back(task)
        self._left = task

    def _advance(self) -> Task:
        """Advance like the base class, but let the policy delay the only task whose timer is due."""
        decisions = self._decisions
        task = super()._advance()
        if not self._late_ns or task is self.host or self._decisions != decisions:
            return task
        self.sequence = order = self.sequence + 1
        heappush(self.ready, (task.priority, order, task))
        return self._take()

    def _take(self) -> Task:
        """Ask the policy if there is a choice; a pause of the run does not count as another decision."""
        ready = self.ready
        while True:
            if len(ready) > 1:
                ready.sort()  # a sorted list is a heap, and stays one if items are removed
            first = ready[0][2]
            if first is self.host:
                return heappop(ready)[2]
            width = 1 if len(ready) == 1 else self._width()
            longest = self._hold_ns if first is self._going_on else self._late_ns
            timer = self._next_timer(longest) if longest else None
            starters = self._starters(first) if self._early else []
            choice = 0 if width == 1 and timer is None and not starters else self._ask(width, starters, timer)
            if choice < width + len(starters):
                self._going_on = self._left = None
                if choice < width:
                    return ready.pop(choice)[2]
                starter = starters[choice - width]
                self._time_out(starter)
                return starter
            assert timer is not None
            self.now = timer
            self._fire_due()
            if self.now > self._until:
                self._last = first
                return self.host

    def _width(self) -> int:
        """Return the number of candidates among the ready tasks, which are sorted."""
        ready = self.ready
        if self._any:
            return len(ready)
        priority = ready[0][0]
        width = 1
        while width < len(ready) and ready[width][0] == priority:
            width += 1
        return width

    def _ask(self, width: int, starters: list[Task], timer: int | None) -> int:
        """Return which of the first `width` ready tasks or the starters runs; one more answer means none before the
        timer.
        """
        tasks = [*(entry[2] for entry in self.ready[:width]), *starters]
        number = self._decisions
        self._decisions = number + 1
        assert self.policy is not None
        running = tasks[0] is self._going_on
        return self.policy.choose(Decision(number, self.now, tasks, running, timer is not None, self._left))

    def _next_timer(self, longest: int) -> int | None:
        """Return the time of the next timer, if a task may be held up until then: for `longest` ns."""
        timers = self.timers
        while timers and timers[0][2].timer != timers[0][1]:
            heappop(timers)
        return timers[0][0] if timers and timers[0][0] - self.now <= longest else None


class CallPointKernel(ExploringKernel):
    """A kernel that records which tasks have called it, for scheduling points after such calls; see above for the
    arguments.

    Attributes:
        entered: tasks that have called; the user removes them.
        passed: number of calls.
        longest_ns: the longest computation that was charged at once.
    """

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self.entered: dict[Task, bool] = {}
        self.passed = 0
        self.longest_ns = 0

    def point(self) -> None:
        self.passed += 1
        self.entered[self.current] = True
        super().point()

    def charge(self, duration_ns: int) -> None:
        self.passed += 1
        self.longest_ns = max(self.longest_ns, duration_ns)
        self.entered[self.current] = True
        super().charge(duration_ns)

"""The wall time of each task, exactly: the clock is read when a task gets the processor, and when it gives it up.

The time between both is the time of a task switch. For that, `TimedTasks` wraps the two functions by which the kernel
hands the processor from task to task (`cfepy.rtos.context`), in a run that is profiled.
"""

from __future__ import annotations

import threading
from collections import defaultdict
from collections.abc import Callable
from time import perf_counter_ns
from types import CodeType
from typing import Any, NamedTuple, Protocol

from cfepy.attachment import Attachment
from cfepy.rtos import Kernel, Task


class TaskLabel(NamedTuple):
    """A task in the profile: its application, "" for one of cFE's boot, and its name."""

    app: str
    task: str


HOST = TaskLabel("", "")
"""The label of the time outside of all tasks: display, ports, pace."""

Stack = tuple[CodeType, ...]
"""Functions from the outermost to the innermost."""

DEEPEST = 250  # frames of a stack


class Turns(Protocol):
    """Interface of an observer of the turns of tasks."""

    def begin_turn(self, label: TaskLabel) -> None:
        """Begin the turn of a task, in its thread."""

    def end_turn(self) -> None:
        """End it, in its thread."""


class TaskTimes:
    """The times of a run.

    Attributes:
        times: wall time of each task in ns.
        turns: how often each task got the processor.
        switches: number of task switches.
        switch_ns: their wall time in ns.
        label: the task that has the processor, or had it until the present switch.
        task: the same; None for the host.
    """

    def __init__(self) -> None:
        self.times: dict[TaskLabel, int] = defaultdict(int)
        self.turns: dict[TaskLabel, int] = defaultdict(int)
        self.switches = self.switch_ns = 0
        self.label = HOST
        self.task: Task | None = None
        self._is_on = False
        self._began = self._left = 0

    @property
    def wall_ns(self) -> int:
        """The wall time of the run."""
        return sum(self.times.values()) + self.switch_ns

    @property
    def is_switching(self) -> bool:
        """Whether a task switch is going on."""
        return self._left != 0

    def start(self) -> None:
        """Start the clock, in the host; do nothing if it runs."""
        if not self._is_on:
            self._is_on = True
            self._began = perf_counter_ns()

    def stop(self) -> None:
        """Stop the clock for good, in the host."""
        if self._is_on:
            self.times[self.label] += perf_counter_ns() - self._began
            self._is_on = False
            self._began = -1
            self.task = None

    def exclude(self, spent_ns: int) -> None:
        """Leave a wall time of the profiler itself out of the present turn."""
        self._began += spent_ns

    def leave(self) -> None:
        """Note that the task gives up the processor."""
        self._left = perf_counter_ns()

    def arrive(self, label: TaskLabel, task: Task | None) -> None:
        """Note that a task has got the processor."""
        now = perf_counter_ns()
        if self._is_on:
            left = self._left or now
            self.times[self.label] += left - self._began
            self.switch_ns += now - left
            self.switches += 1
            self.turns[label] += 1
        self._began, self._left = now, 0
        self.label, self.task = label, task


class TimedTasks(Attachment):
    """Measures the times of the tasks of a mission.

    Attributes:
        times: the result.
        kernel_seen: the kernel of the mission; None before.
        host_ident: identifier of the host's thread.
        turns: observes the turns of tasks that are threads; None for no observer.
    """

    def __init__(self) -> None:
        self.times = TaskTimes()
        self.kernel_seen: Kernel | None = None
        self.host_ident = 0
        self.turns: Turns | None = None

    def kernel(self, base: type[Kernel]) -> type[Kernel]:
        watch = self._watch

        class TimedKernel(base):  # type: ignore[misc, valid-type]  # mypy does not follow a class that is an argument
            """A kernel whose tasks are timed."""

            def __init__(self, *args: Any, **options: Any) -> None:
                super().__init__(*args, **options)
                watch(self)

        return TimedKernel

    def conclude(self) -> None:
        self.times.stop()

    def _watch(self, kernel: Kernel) -> None:
        """Wrap the context of a kernel, which has no tasks yet."""
        self.kernel_seen = kernel
        context: Any = kernel.context
        create, bind_host = context.create, context.bind_host

        def create_timed(task: Task, main: Callable[[Task], Task]) -> None:
            label = TaskLabel(getattr(task.owner, "name", ""), task.name)

            def timed_main(task: Task) -> Task:
                self.times.arrive(label, task)
                if self.turns is not None and task.park is not None:
                    self.turns.begin_turn(label)
                return main(task)

            create(task, timed_main)
            self._time(task, label, task)

        def bind_timed(host: Task) -> None:
            bind_host(host)
            self.host_ident = threading.get_ident()
            self.times.start()
            self._time(host, HOST, None)

        context.create, context.bind_host = create_timed, bind_timed

    def _time(self, task: Task, label: TaskLabel, shown: Task | None) -> None:
        """Wrap the functions of a task that hand it the processor and that await it."""
        times, resume, park = self.times, task.resume, task.park
        if park is None:  # a greenlet: its `resume` returns when the caller gets the processor again

            def switch() -> Any:
                caller = times.label, times.task
                times.leave()
                try:
                    return resume()
                finally:
                    times.arrive(*caller)

            task.resume = switch
            return

        turns = self.turns

        def release() -> Any:
            if turns is not None:
                turns.end_turn()
            times.leave()
            return resume()

        def await_turn(*args: Any) -> Any:
            got = park(*args)
            if got:
                times.arrive(label, shown)
                if turns is not None and shown is not None:
                    turns.begin_turn(label)
            return got

        task.resume, task.park = release, await_turn

"""When faults happen: at occasions, selected by `When` and counted by a `Gate`, or at the times of an `Agenda`.

An occasion is a message, a call or a tick. The schedule can be asked at which of them the fault happens; its answer is
a decision like any other, "no" under fifo. Faults with a time are executed by a task of priority 0, which exists only
while some are left.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from heapq import heapify, heappop, heappush
from random import Random
from typing import Any

from cfepy.rtos import Kernel, Question, WaitList, wrapping
from cfepy.schedules import ExploringKernel
from cfepy.status import CfeError

PRIORITY = 0
TASK_NAME = "FAULTS"
CALLS = ("point", "charge", "delay")
NO, YES = "does not strike", "strikes"


@dataclass(frozen=True, slots=True)
class When:
    """At which occasions a fault happens; an occasion is a message, a call or a tick that matches the fault.

    Attributes:
        at_ns: virtual times in ns. A fault with occasions happens at the next one after each of them.
        after_ns: start of the window of virtual time, in ns.
        until_ns: end of the window, which is not included; None for the end of the run.
        number: which occasions within the window, from 1; any if empty.
        every: only every n-th of them.
        probability: probability of a fault at each remaining occasion, 0 to 1.
        count: maximum number of occurrences; None for no limit.
        explored: maximum number of occurrences, if the schedule decides at which of these occasions it happens;
            otherwise 0.
    """

    at_ns: tuple[int, ...] = ()
    after_ns: int = 0
    until_ns: int | None = None
    number: tuple[int, ...] = ()
    every: int = 1
    probability: float = 1.0
    count: int | None = None
    explored: int = 0


class Gate:
    """Decides for one fault, across all resets of the processor.

    Args:
        when: at which occasions.
        random: the fault's own stream of random numbers, independent of other faults.
        strikes: asks the schedule whether it happens at an occasion.

    Attributes:
        seen: number of occasions so far, including those outside the window.
        fired: number of occurrences.
    """

    def __init__(self, when: When, random: Random, strikes: Callable[[], bool] = lambda: False) -> None:
        self.when = when
        self.random = random
        self._strikes = strikes
        self.seen = self.fired = 0
        self._inside = 0
        self._waiting = sorted(when.at_ns)

    def opens(self, now_ns: int) -> bool:
        """Return whether the fault happens at this occasion."""
        self.seen += 1
        if not self._is_due(now_ns):
            return False
        self.fired += 1
        return True

    def is_open(self, now_ns: int) -> bool:
        """Return whether it is within the window of time."""
        when = self.when
        return when.after_ns <= now_ns and (when.until_ns is None or now_ns < when.until_ns)

    def _is_due(self, now_ns: int) -> bool:
        when = self.when
        if not self.is_open(now_ns) or (when.count is not None and self.fired >= when.count):
            return False
        if when.at_ns:
            if not self._waiting or now_ns < self._waiting[0]:
                return False
            self._waiting.pop(0)
            return True
        self._inside += 1
        if (when.number and self._inside not in when.number) or self._inside % when.every:
            return False
        if when.explored:
            return self.fired < when.explored and self._strikes()
        return when.probability >= 1 or self.random.random() < when.probability

    def why_not(self) -> str:
        """Return why it never happened, as far as its occasions show."""
        if self.when.explored:
            return "no schedule selected it; cfepy explore tries schedules that do"
        if not self.seen:
            return "no matching occasion occurred"
        times = "1 time" if self.seen == 1 else f"{self.seen} times"
        if not self._inside:
            return f"matched {times}, but never within its time window"
        return f"matched {times}, but never at one of the times given"


def asker(kernel: Kernel, name: str) -> Callable[[], bool]:
    """Return the function that asks the schedule whether the fault with a name happens at an occasion."""
    question = Question(f"fault {name}", "fault", (NO, YES), f"fault {name} {{}}", is_rare=True)
    return lambda: bool(kernel.answer(question))


class OpenCalls:
    """Lets faults happen at the calls of applications in an exploration.

    Such a fault can happen before each call, and before each charge of CPU time: wherever other tasks could run.
    """

    def __init__(self) -> None:
        self._open: list[tuple[str | None, Gate, Callable[[], object]]] = []
        self._is_asking = False

    def kernel(self, base: type[Kernel]) -> type[Kernel]:
        if not issubclass(base, ExploringKernel):
            return base
        return wrapping(base, dict.fromkeys(CALLS, self._wrapped))

    def add(self, app_name: str | None, gate: Gate, strike: Callable[[], object]) -> None:
        """Execute a fault at calls.

        Args:
            app_name: application of the calls; None for all.
            gate: selects the calls.
            strike: executes it, in the calling task.
        """
        self._open.append((app_name, gate, strike))

    def _wrapped(self, original: Callable[..., Any]) -> Callable[..., Any]:
        def call(kernel: Kernel, *args: Any) -> Any:
            task = kernel.current
            if task.owner is not None and not task.dying and not self._is_asking:
                self._ask(task.owner.name, kernel.now)
            return original(kernel, *args)

        return call

    def _ask(self, app_name: str, now: int) -> None:
        self._is_asking = True  # the fault itself makes calls
        try:
            due = [strike for app, gate, strike in self._open if app in (None, app_name) and gate.opens(now)]
        finally:
            self._is_asking = False
        for strike in due:
            strike()


class Agenda:
    """Actions by virtual time; it continues after resets of the processor.

    Args:
        kernel: kernel of the simulated computer.
    """

    def __init__(self, kernel: Kernel) -> None:
        self._kernel = kernel
        self._entries: list[tuple[int, int, bool, Callable[[], object]]] = []
        self._serial = 0
        self._waits = WaitList("the next fault")
        self._is_running = self._is_up = False

    def add(self, when_ns: int, action: Callable[[], object], survives: bool = False) -> None:
        """Execute an action at a time, or at once if that has passed.

        Args:
            when_ns: virtual time.
            action: called without arguments in the task of the faults.
            survives: whether it is kept if the processor is reset before that time.
        """
        self._serial += 1
        heappush(self._entries, (when_ns, self._serial, survives, action))
        if self._is_running:
            self._kernel.wake_first(self._waits)
        elif self._is_up:
            self._start()

    def power_up(self) -> None:
        """A processor was created: drop the actions of the previous one, and keep the others."""
        self._entries = [entry for entry in self._entries if entry[2]]
        heapify(self._entries)
        self._is_running, self._is_up = False, True
        if self._entries:
            self._start()

    def _start(self) -> None:
        self._is_running = True
        self._waits = WaitList("the next fault")
        self._kernel.spawn(TASK_NAME, self._serve, PRIORITY)

    def _serve(self) -> None:
        kernel = self._kernel
        kernel.current.owner = None
        while self._entries:
            when_ns = self._entries[0][0]
            if when_ns > kernel.now:
                kernel.wait_on(self._waits, when_ns - kernel.now)
            else:
                with suppress(CfeError):  # a delayed message that finds no room; the bus has reported it
                    heappop(self._entries)[3]()
        self._is_running = False

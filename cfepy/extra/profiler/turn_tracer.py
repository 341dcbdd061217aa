"""Stacks of tasks on threads: all calls in some turns of the tasks, chosen at random.

A turn is the time from getting the processor to giving it up. On threads, another thread gets Python's global lock
mostly at the end of a turn, so `cfepy.extra.profiler.stack_sampler` would see tasks only where they wait. So the task
itself watches its calls in a turn (`sys.setprofile`), and the time between two of them belongs to the stack there. The
time of the watching is left out.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterator
from random import Random
from time import perf_counter_ns
from types import CodeType, FrameType
from typing import Any

from cfepy.extra.profiler.task_times import DEEPEST, Stack, TaskLabel, TaskTimes

EVERY_NS = 2_000_000  # wall time for each traced turn, on average
ALWAYS = 3  # turns of a task that are traced in any case
BEGIN = 50  # turns between two traced ones, before the rate of turns is known


class _Call:
    """A function in the tree of calls of a task: its time in ns without its calls, and its calls by code object."""

    __slots__ = ("caller", "calls", "code", "spent_ns")

    def __init__(self, code: CodeType | None, caller: _Call | None) -> None:
        self.code, self.caller = code, caller
        self.spent_ns = 0
        self.calls: dict[int, _Call] = {}  # by id, because the hash of a code object is slow

    def of(self, code: CodeType) -> _Call:
        """Return a function that this one calls."""
        found = self.calls.get(id(code))
        if found is None:
            found = self.calls[id(code)] = _Call(code, self)
        return found

    def stacks(self, above: Stack = ()) -> Iterator[tuple[Stack, int]]:
        """Yield the stacks below it with their times."""
        here = above if self.code is None else (*above, self.code)
        if self.spent_ns:
            yield here, self.spent_ns
        for each in self.calls.values():
            yield from each.stacks(here)


class TurnTracer:
    """Traces turns of tasks.

    Args:
        times: has the rate of turns.

    Attributes:
        count: number of traced turns.
    """

    def __init__(self, times: TaskTimes) -> None:
        self.count = 0
        self._times = times
        self._random = Random(0)  # of the profiler alone: the run has streams of its own
        self._left = 0
        self._traced: Counter[TaskLabel] = Counter()
        self._trees: dict[TaskLabel, _Call] = {}
        self._tree: _Call | None = None  # of the traced turn; None if the turn is not traced
        self._call: _Call | None = None  # the function that runs; None before the first event of a turn
        self._last_ns = self._own_ns = 0

    def begin_turn(self, label: TaskLabel) -> None:
        """Begin the turn of a task, in its thread; trace it if it is one of those to trace."""
        self._left -= 1
        if (self._left > 0 and self._traced[label] >= ALWAYS) or sys.getprofile() is not None:
            return
        if self._left <= 0:
            self._left = self._random.randint(1, 2 * self._turns())
        self._traced[label] += 1
        self.count += 1
        tree = self._trees.get(label)
        if tree is None:
            tree = self._trees[label] = _Call(None, None)
        self._tree, self._call = tree, None
        self._last_ns = perf_counter_ns()
        sys.setprofile(self._take)

    def end_turn(self) -> None:
        """End the turn of a task, in its thread."""
        if self._tree is not None:
            sys.setprofile(None)
            self._tree = None
            self._times.exclude(self._own_ns)
            self._own_ns = 0

    def _turns(self) -> int:
        """Return the number of turns between two traced ones."""
        times = self._times
        return max(1, times.switches * EVERY_NS // max(times.wall_ns, 1)) if times.switches > BEGIN else BEGIN

    def _take(self, frame: FrameType, event: str, _: Any) -> None:
        now = perf_counter_ns()
        call = self._call
        if call is None:
            call = self._found(frame.f_back if event == "call" else frame)
        call.spent_ns += now - self._last_ns
        if event == "call":
            call = call.of(frame.f_code)
        elif event == "return" and call.caller is not None:
            call = call.caller
        self._call = call
        self._last_ns = last = perf_counter_ns()
        self._own_ns += last - now

    def _found(self, frame: FrameType | None) -> _Call:
        """Return the place of a frame in the tree of the turn."""
        codes: list[CodeType] = []
        while frame is not None and len(codes) < DEEPEST:
            codes.append(frame.f_code)
            frame = frame.f_back
        call = self._tree
        assert call is not None
        for code in reversed(codes):
            call = call.of(code)
        return call

    def stacks(self) -> dict[TaskLabel, Counter[Stack]]:
        """Return the wall time in ns of each stack in the traced turns, by task."""
        found: dict[TaskLabel, Counter[Stack]] = {}
        for label, tree in self._trees.items():
            found[label] = Counter()
            for stack, spent_ns in tree.stacks():
                found[label][stack] += spent_ns
        return found

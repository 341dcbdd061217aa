"""The wall times of tasks, with a clock that counts."""

from __future__ import annotations

import sys
from collections.abc import Callable
from itertools import count

import pytest

from cfepy.extra.profiler import task_times, turn_tracer
from cfepy.extra.profiler.profile_report import advice, greenlet_switch_ns
from cfepy.extra.profiler.task_times import HOST, TaskLabel, TaskTimes, TimedTasks
from cfepy.extra.profiler.turn_tracer import TurnTracer
from cfepy.rtos import Kernel, Task

A, B = TaskLabel("APP", "a"), TaskLabel("APP", "b")


@pytest.fixture
def at(monkeypatch: pytest.MonkeyPatch) -> Callable[[int], None]:
    """Set the clock of the times."""
    now = [0]
    monkeypatch.setattr(task_times, "perf_counter_ns", lambda: now[0])
    return lambda ns: now.__setitem__(0, ns)


def test_time_of_a_task_is_from_getting_to_giving_up_the_processor(at: Callable[[int], None]) -> None:
    times, task = TaskTimes(), Task("a", 1, None, 50)
    at(1000)
    times.start()
    for label, left, arrived in ((A, 1100, 1110), (B, 1150, 1155), (HOST, 1255, 1260)):
        at(left)
        times.leave()
        assert times.is_switching
        at(arrived)
        times.arrive(label, None if label == HOST else task)
    at(1300)
    times.stop()
    at(9000)
    times.stop()
    times.arrive(A, task)
    assert dict(times.times) == {HOST: 100 + 40, A: 40, B: 100}
    assert (times.switches, times.switch_ns, times.wall_ns) == (3, 20, 300)
    assert dict(times.turns) == {A: 1, B: 1, HOST: 1}


def test_task_that_ends_without_a_switch_leaves_no_gap(at: Callable[[int], None]) -> None:
    times, task = TaskTimes(), Task("a", 1, None, 50)
    times.start()
    times.arrive(A, task)
    at(70)
    times.arrive(B, task)  # a greenlet that ends
    times.exclude(20)
    at(100)
    times.stop()
    assert dict(times.times) == {HOST: 0, A: 70, B: 10}


@pytest.mark.parametrize("context", ["thread", "greenlet"])
def test_turns_of_a_kernel_are_counted(context: str) -> None:
    timed = TimedTasks()
    kernel = timed.kernel(Kernel)(context)
    with kernel:
        for name in ("one", "two"):
            kernel.spawn(name, lambda: [kernel.delay(10) for _ in range(5)])
        kernel.run()
    timed.conclude()
    turns = dict(timed.times.turns)
    assert {name: turns[TaskLabel("", name)] for name in ("one", "two")} == {"one": 6, "two": 6}
    assert timed.times.switches == sum(turns.values())
    assert set(timed.times.times) == {HOST, TaskLabel("", "one"), TaskLabel("", "two")}


def test_traced_turn_gives_its_time_to_the_stacks(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = count(0, 10)
    monkeypatch.setattr(turn_tracer, "perf_counter_ns", lambda: next(clock))
    tracer = TurnTracer(TaskTimes())

    def inner() -> None:
        """Be called."""

    def outer() -> None:
        inner()
        inner()

    tracer.begin_turn(A)
    outer()
    tracer.end_turn()
    assert sys.getprofile() is None
    stacks = tracer.stacks()[A]
    names = {tuple(code.co_name for code in stack)[-2:] for stack in stacks}
    assert ("outer", "inner") in names
    assert tracer.count == 1
    assert sum(weight for stack, weight in stacks.items() if stack[-1].co_name == "inner") == 20


def test_tracer_leaves_another_profiler_alone() -> None:
    def other(*_: object) -> None:
        """Profile nothing."""

    usual = sys.getprofile()
    sys.setprofile(other)
    try:
        tracer = TurnTracer(TaskTimes())
        tracer.begin_turn(A)
        tracer.end_turn()
        assert sys.getprofile() is other
    finally:
        sys.setprofile(usual)
    assert (tracer.count, tracer.stacks()) == (0, {})


def test_advice_names_the_gain_of_greenlets() -> None:
    times = TaskTimes()
    times.times[A] = 600_000_000
    times.switches, times.switch_ns = 40_000, 400_000_000
    virtual_ns = 6_000_000_000
    assert advice(times, "thread", virtual_ns, 1000.0) == (
        "40,000 task switches took 40% of the time, 10.0 us each. Tasks were threads. With --tasks greenlet it would "
        "fly about 9.4 x real time: a switch of greenlets takes 1.0 us here."
    )
    assert advice(times, "thread", virtual_ns, None).endswith(
        "Greenlets (pip install 'cfepy[fast]') would save most of that: at most 10.0 x real time."
    )
    assert advice(times, "greenlet", virtual_ns, None).endswith("10.0 us each. Tasks were greenlets.")
    assert 0 < (greenlet_switch_ns() or 1) < 1e9

"""Pacing to the wall clock: never early, and the same trace."""

from __future__ import annotations

import pytest

from cfepy.rtos import Kernel
from cfepy.rtos.realtime import NS_PER_S, Pacer, Stopwatch
from cfepy.trace import Trace


def ticking(kernel: Kernel, period_ns: int) -> None:
    def task() -> None:
        while True:
            kernel.delay(period_ns)

    kernel.spawn("ticker", task)


def test_virtual_time_is_never_ahead_of_the_clock() -> None:
    with Kernel("thread", Trace()) as kernel:
        ticking(kernel, 7_000_000)
        watch = Stopwatch()
        pacer = Pacer(kernel, kernel.run, factor=5)
        while kernel.now < NS_PER_S // 2:
            pacer.step(NS_PER_S // 2)
            assert kernel.now <= watch.elapsed_ns() * 5
    assert kernel.now == NS_PER_S // 2


def test_the_trace_is_that_of_a_free_run() -> None:
    digests = []
    for factor in (None, 100.0):
        trace = Trace()
        with Kernel("thread", trace) as kernel:
            ticking(kernel, 3_000_000)
            if factor is None:
                kernel.run(NS_PER_S)
            else:
                pacer = Pacer(kernel, kernel.run, factor)
                while kernel.now < NS_PER_S:
                    pacer.step(NS_PER_S)
            digests.append(trace.digest())
    assert digests[0] == digests[1]


def test_what_input_has_made_ready_does_not_wait() -> None:
    """Work made ready by input does not wait. Other work would wait for a millisecond, to run in one go."""
    waits: list[float] = []
    with Kernel("thread", Trace()) as kernel:
        pacer = Pacer(kernel, kernel.run, wait=waits.append, elapsed_ns=lambda: 5_000_000)
        kernel.run(5_000_000)
        kernel.spawn("woken", lambda: None)
        pacer.step(NS_PER_S)
        assert waits == []
        assert not kernel.tasks


def test_an_answer_is_not_cut_in_two_by_what_its_calls_cost() -> None:
    """The host would look at the clock between the calls of a task that answers an external peer."""
    pieces: list[int] = []
    with Kernel("thread", Trace()) as kernel:

        def run(until_ns: int) -> None:
            pieces.append(until_ns)
            kernel.run(until_ns)

        def answer() -> None:
            for _ in range(10):
                kernel.charge(5_000)

        pacer = Pacer(kernel, run, elapsed_ns=lambda: 5_000_000)
        kernel.run(5_000_000)
        kernel.spawn("woken", answer)
        pacer.step(NS_PER_S)
        assert not kernel.tasks
        assert pieces == [5_100_000]


@pytest.mark.parametrize("factor", [0, -1, float("nan")])
def test_a_factor_that_makes_no_sense(factor: float) -> None:
    with Kernel("thread") as kernel, pytest.raises(ValueError, match="greater than 0"):
        Pacer(kernel, kernel.run, factor)


def test_a_wait_that_ends_early_takes_the_run_to_that_instant() -> None:
    """Any input ends the wait. The input then enters at the time of the wall clock."""
    waits: list[float] = []
    with Kernel("thread", Trace()) as kernel:
        ticking(kernel, NS_PER_S)
        watch = Stopwatch()
        pacer = Pacer(kernel, kernel.run, wait=waits.append)
        while len(waits) < 3:
            pacer.step(1_000_000 * NS_PER_S)
            assert kernel.now <= watch.elapsed_ns()
    assert all(0 < wait <= 0.05 for wait in waits)
    assert kernel.now > 0

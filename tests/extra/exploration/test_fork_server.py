"""Runs that share their beginning and then differ, each in a separate process."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import closing

import pytest

from cfepy.extra.exploration.fork_server import ForkServer, LateSchedule
from cfepy.rtos import NotingPolicy
from cfepy.schedules import Schedule, make_kernel
from cfepy.trace import Trace

pytest.importorskip("greenlet")

FROM = ":from=50us"
END_NS = 200_000


def two_counters(schedule: LateSchedule | Schedule) -> tuple[int, str, dict[int, int], str]:
    """Run two tasks that repeatedly add to a number. Returns its value, the digest, the deviations, the schedule."""
    recorded, trace, box = NotingPolicy(schedule.policy()), Trace(), [0]
    with make_kernel("greenlet", trace, recorded) as kernel:

        def add() -> None:
            for _ in range(50):
                value = box[0]
                kernel.charge(1000)
                box[0] = value + 1

        kernel.spawn("a", add)
        kernel.spawn("b", add)
        kernel.run(END_NS)
        return box[0], trace.digest(), recorded.deviations, schedule.text()


@pytest.fixture
def server() -> Iterator[ForkServer]:
    """A server of the two counters."""
    with closing(ForkServer(two_counters, Schedule.parse("at" + FROM))) as made:
        yield made


@pytest.mark.parametrize("seeds", [2, pytest.param(4, marks=pytest.mark.slow)])
def test_a_forked_run_is_the_run_from_the_start(server: ForkServer, seeds: int) -> None:
    digests = set()
    for seed in range(seeds):
        for text in (f"random:{seed}{FROM}", f"pct:{seed}:3:20{FROM}"):
            whole = two_counters(Schedule.parse(text))
            assert server.run(Schedule.parse(text)) == whole
            digests.add(whole[1])
            again = Schedule.parse(text).at(whole[2])
            assert server.run(again) == two_counters(again)
            assert server.run(again)[1] == whole[1]
    assert len(digests) > 3


def test_schedule_is_fifo_before_its_begin() -> None:
    _, _, deviations, _ = two_counters(Schedule.parse("random:1:from=60us"))
    whole = two_counters(Schedule.parse("random:1"))
    assert deviations
    assert min(deviations) > min(whole[2])


def test_run_without_a_choice_after_the_begin_answers_all_schedules() -> None:
    def body(schedule: LateSchedule) -> int:
        with make_kernel("greenlet", None, schedule.policy()) as kernel:
            kernel.run(1000)
        return 7

    with closing(ForkServer(body, Schedule.parse("at:from=1s"))) as server:
        assert [server.run(Schedule.parse(f"random:{seed}:from=1s")) for seed in range(3)] == [7, 7, 7]


def _failing(end: Callable[[], object]) -> Callable[[LateSchedule], object]:
    def body(schedule: LateSchedule) -> object:
        value = two_counters(schedule)
        if "random:1" in value[3]:
            end()
        return value[3]

    return body


def test_error_of_a_run_is_raised_and_the_next_run_works() -> None:
    def fail() -> None:
        raise KeyError("broken")

    with closing(ForkServer(_failing(fail), Schedule.parse("at" + FROM))) as server:
        with pytest.raises(KeyError, match="broken"):
            server.run(Schedule.parse("random:1" + FROM))
        assert server.run(Schedule.parse("random:2" + FROM)) == "random:2" + FROM


def test_run_that_ends_its_process_is_reported_and_the_next_run_works() -> None:
    with closing(ForkServer(_failing(lambda: os._exit(3)), Schedule.parse("at" + FROM))) as server:
        with pytest.raises(ChildProcessError, match="random:1:from=50us ended without an answer"):
            server.run(Schedule.parse("random:1" + FROM))
        assert server.run(Schedule.parse("random:2" + FROM)) == "random:2" + FROM


def test_schedules_with_other_options_are_refused(server: ForkServer) -> None:
    with pytest.raises(ValueError, match="must have the options of"):
        server.run(Schedule.parse("random:1:from=51us"))
    with pytest.raises(ValueError, match="from=600ms"):
        ForkServer(two_counters, Schedule.parse("random:1"))

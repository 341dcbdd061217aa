"""Running from the host: end time, pieces, and causes of the end."""

from __future__ import annotations

import pytest

from cfepy.rtos import FOREVER, DeadlockError, Kernel, Queue, WaitList
from cfepy.trace import Trace
from tests.rtos.helpers import Log


def test_run_until_includes_that_instant_and_ends_at_it(kernel: Kernel, log: Log) -> None:
    def sleeper() -> None:
        for _ in range(3):
            kernel.delay(10)
            log(str(kernel.now))

    kernel.spawn("sleeper", sleeper)
    kernel.run(until_ns=20)
    assert log == ["10", "20"]
    assert kernel.now == 20
    kernel.run(until_ns=25)
    assert kernel.now == 25
    kernel.run()
    assert log == ["10", "20", "30"]


def test_task_that_only_charges_stops_at_the_end_of_the_run(kernel: Kernel) -> None:
    def spinner() -> None:
        while True:
            kernel.charge(7)

    kernel.spawn("spinner", spinner)
    kernel.run(until_ns=1000)
    assert kernel.now <= 1007
    kernel.run(until_ns=2000)
    assert 2000 <= kernel.now <= 2007


def _periodic_program(kernel: Kernel) -> None:
    queue = Queue(kernel, 3)

    def producer(period: int) -> None:
        while True:
            kernel.delay(period)
            queue.put(period)

    def consumer() -> None:
        while True:
            queue.get(23)
            kernel.charge(3)

    kernel.spawn("consumer", consumer, 50)
    for period in (7, 11, 13):
        kernel.spawn(f"p{period}", lambda period=period: producer(period), 40 + period % 2)


@pytest.mark.parametrize("board", [{}, {"switch_cost_ns": 2}, {"tick_ns": 10, "switch_cost_ns": 1}])
def test_run_in_pieces_has_the_digest_of_one_run(make_kernel: type[Kernel], board: dict[str, int]) -> None:
    digests = set()
    for pieces in ([1000], [1, 2, 3, 999, 1000], list(range(0, 1001, 50))):
        trace = Trace()
        with make_kernel(trace=trace, **board) as kernel:
            _periodic_program(kernel)
            for until in pieces:
                kernel.run(until_ns=until)
            digests.add(trace.digest())
    assert len(digests) == 1


def test_pause_leaves_no_record(make_kernel: type[Kernel]) -> None:
    records: list[bytes] = []
    trace = Trace(sink=records.extend)
    with make_kernel(trace=trace) as kernel:
        _periodic_program(kernel)
        for until in range(0, 1001, 50):
            kernel.run(until_ns=until)
        kernel.kill(kernel.tasks[0])
    trace.flush()
    assert records
    assert all(records)


def test_stop_ends_the_run_at_the_next_wait(kernel: Kernel, log: Log) -> None:
    def stopper() -> None:
        kernel.delay(10)
        kernel.stop()
        log("after stop")
        kernel.delay(10)
        log("continued")

    kernel.spawn("stopper", stopper)
    kernel.spawn("other", lambda: kernel.delay(1000))
    kernel.run()
    assert log == ["after stop"]
    assert kernel.now == 10
    kernel.run(until_ns=20)
    assert log == ["after stop", "continued"]


def test_deadlock_is_reported_with_the_objects_waited_for(kernel: Kernel) -> None:
    queue = Queue(kernel, 1, "HK_PIPE")
    kernel.spawn("HK_APP", queue.get, 80)
    with pytest.raises(DeadlockError, match=r"HK_APP \(task 1, priority 80\) waits for queue HK_PIPE"):
        kernel.run()


def test_run_with_an_end_is_not_a_deadlock(kernel: Kernel) -> None:
    kernel.spawn("waiter", lambda: kernel.wait_on(WaitList("nothing"), FOREVER))
    kernel.run(until_ns=500)
    assert kernel.now == 500


def test_run_cannot_be_called_from_a_task(kernel: Kernel) -> None:
    kernel.spawn("nested", kernel.run)
    with pytest.raises(RuntimeError, match="inside the simulation"):
        kernel.run()


def test_host_cannot_wait(kernel: Kernel) -> None:
    with pytest.raises(RuntimeError, match="requires a task"):
        kernel.delay(1)
    with pytest.raises(RuntimeError, match="requires a task"):
        Queue(kernel, 1).get()


def test_next_event_returns_the_time_of_the_next_action(kernel: Kernel) -> None:
    assert kernel.next_event() is None
    kernel.spawn("sleeper", lambda: kernel.delay(40))
    assert kernel.next_event() == 0
    kernel.run(until_ns=0)
    assert kernel.next_event() == 40

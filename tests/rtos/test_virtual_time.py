"""Virtual time: delays, deadlines, ticks, time-outs, and the processor time that tasks use."""

from __future__ import annotations

from itertools import groupby

from cfepy.rtos import EMPTY, TIMEOUT, Kernel, Queue, WaitList
from cfepy.rtos.scheduler import SLICE_NS
from tests.rtos.helpers import Log

MS = 1_000_000


def test_time_jumps_to_the_next_deadline(kernel: Kernel, log: Log) -> None:
    def sleeper(duration: int) -> None:
        kernel.delay(duration)
        log(f"{duration}@{kernel.now}")

    for duration in (5, 3_600_000_000_000, 7):
        kernel.spawn("sleeper", lambda duration=duration: sleeper(duration))
    kernel.run()
    assert log == ["5@5", "7@7", "3600000000000@3600000000000"]


def test_a_delay_lasts_at_least_one_ns(kernel: Kernel) -> None:
    kernel.spawn("sleeper", lambda: kernel.delay(0))
    kernel.run()
    assert kernel.now == 1


def test_deadlines_are_rounded_up_to_the_tick(make_kernel: type[Kernel]) -> None:
    with make_kernel(tick_ns=10 * MS) as kernel:
        seen: list[int] = []

        def sleeper() -> None:
            for _ in range(2):
                kernel.delay(1)
                seen.append(kernel.now)
            kernel.delay(10 * MS)
            seen.append(kernel.now)

        kernel.spawn("sleeper", sleeper)
        kernel.run()
        assert seen == [10 * MS, 20 * MS, 30 * MS]


def test_tasks_due_at_the_same_time_run_by_priority_then_by_arming_order(kernel: Kernel, log: Log) -> None:
    def sleeper(name: str) -> None:
        kernel.delay(10)
        log(name)

    for name, priority in (("b", 50), ("c", 50), ("a", 10)):
        kernel.spawn(name, lambda name=name: sleeper(name), priority)
    kernel.run()
    assert log == ["a", "b", "c"]


def test_wait_that_times_out_leaves_the_list(kernel: Kernel) -> None:
    waits = WaitList("nothing")
    results: list[object] = []

    def waiter() -> None:
        results.append(kernel.wait_on(waits, 100))
        results.append(kernel.now)

    kernel.spawn("waiter", waiter)
    kernel.run()
    assert results == [TIMEOUT, 100]
    assert not waits


def test_wake_up_in_time_cancels_the_time_out(kernel: Kernel) -> None:
    queue = Queue(kernel, 1)
    results: list[object] = []

    def reader() -> None:
        results.append(queue.get(100))
        kernel.delay(1000)
        results.append(kernel.now)

    def writer() -> None:
        kernel.delay(99)
        queue.put("in time")

    kernel.spawn("reader", reader)
    kernel.spawn("writer", writer)
    kernel.run()
    assert results == ["in time", 1099]


def test_put_exactly_at_the_deadline_does_not_lose_the_item(kernel: Kernel) -> None:
    queue = Queue(kernel, 1)
    results: list[object] = []
    kernel.spawn("writer", lambda: (kernel.delay(100), queue.put("late")), 10)

    def reader() -> None:
        results.extend((queue.get(100), queue.get(0)))

    kernel.spawn("reader", reader, 20)
    kernel.run()
    assert results in (["late", EMPTY], [TIMEOUT, "late"])


def test_poll_of_an_empty_queue_does_not_wait(kernel: Kernel) -> None:
    queue = Queue(kernel, 1)
    results: list[object] = []
    kernel.spawn("reader", lambda: results.append(queue.get(0)))
    kernel.run()
    assert results == [EMPTY]
    assert kernel.now == 0


def test_full_queue_refuses_a_put(kernel: Kernel) -> None:
    queue = Queue(kernel, 2)
    assert [queue.put(number) for number in range(3)] == [True, True, False]
    assert queue.peak == 2


def test_used_cpu_time_moves_the_clock_and_wakes_due_tasks(kernel: Kernel, log: Log) -> None:
    def sleeper() -> None:
        kernel.delay(50)
        log(f"sleeper@{kernel.now}")

    def worker() -> None:
        kernel.charge(80)
        log(f"worker@{kernel.now}")

    kernel.spawn("sleeper", sleeper, 10)
    task = kernel.spawn("worker", worker, 20)
    kernel.run()
    assert log == ["sleeper@80", "worker@80"]
    assert task.cpu_ns == 80


def test_tasks_of_equal_priority_take_turns_when_one_computes_for_long(kernel: Kernel) -> None:
    done: list[str] = []

    def spinner(name: str) -> None:
        for _ in range(300):
            kernel.charge(1000)
            done.append(name)

    for name in "ab":
        kernel.spawn(name, lambda name=name: spinner(name))
    kernel.run()
    whole = SLICE_NS // 1000
    turns = [len(list(turn)) for _, turn in groupby(done)]
    assert turns[:6] == [whole - 1, whole - 1, whole, whole, whole, whole]
    assert max(turns) == whole


def test_a_switch_costs_virtual_time(make_kernel: type[Kernel]) -> None:
    with make_kernel(switch_cost_ns=2_500) as kernel:
        waits = WaitList("go")
        woken_at: list[int] = []

        def urgent() -> None:
            kernel.wait_on(waits)
            woken_at.append(kernel.now)

        def waker() -> None:
            start = kernel.now
            kernel.wake_first(waits)
            woken_at.append(start)

        kernel.spawn("urgent", urgent, 1)
        kernel.spawn("waker", waker, 2)
        kernel.run()
        assert woken_at[0] - woken_at[1] == 2_500

"""The kernel's promises on who runs when: strict priorities, turns among equals, preemption, virtual time."""

from __future__ import annotations

from itertools import groupby

import pytest

from cfepy.rtos import EMPTY, FOREVER, TIMEOUT, DeadlockError, Kernel, Queue, Semaphore, WaitList
from cfepy.rtos.scheduler import SLICE_NS
from cfepy.trace import Trace
from tests.rtos.helpers import Log

MS = 1_000_000


def test_more_urgent_tasks_run_first(kernel: Kernel, log: Log) -> None:
    for name, priority in (("low", 200), ("high", 10), ("middle", 100)):
        kernel.spawn(name, log.writer(name), priority)
    kernel.run()
    assert log == ["high", "middle", "low"]


def test_equals_run_in_the_order_they_became_ready(kernel: Kernel, log: Log) -> None:
    for name in "abcd":
        kernel.spawn(name, log.writer(name), 50)
    kernel.run()
    assert log == ["a", "b", "c", "d"]


def test_a_more_urgent_new_task_runs_before_spawn_returns(kernel: Kernel, log: Log) -> None:
    def parent() -> None:
        kernel.spawn("urgent", log.writer("urgent"), 10)
        log("parent")
        kernel.spawn("lazy", log.writer("lazy"), 90)
        log("parent again")

    kernel.spawn("parent", parent, 50)
    kernel.run()
    assert log == ["urgent", "parent", "parent again", "lazy"]


def test_a_wake_up_preempts_a_less_urgent_waker(kernel: Kernel, log: Log) -> None:
    queue = Queue(kernel, 4)

    def reader() -> None:
        while True:
            log(f"got {queue.get()}")

    def writer() -> None:
        for number in range(3):
            queue.put(number)
            log(f"put {number}")
        kernel.stop()

    kernel.spawn("reader", reader, 10)
    kernel.spawn("writer", writer, 20)
    kernel.run()
    assert log == ["got 0", "put 0", "got 1", "put 1", "got 2", "put 2"]


def test_a_wake_up_does_not_preempt_an_equal(kernel: Kernel, log: Log) -> None:
    queue = Queue(kernel, 4)
    kernel.spawn("reader", lambda: log(f"got {queue.get()}"), 20)

    def writer() -> None:
        queue.put("x")
        log("put")

    kernel.spawn("writer", writer, 20)
    kernel.run()
    assert log == ["put", "got x"]


def test_a_preempted_task_stays_the_first_of_its_priority(kernel: Kernel, log: Log) -> None:
    semaphore = Semaphore(kernel)

    def urgent() -> None:
        semaphore.take()
        log("urgent")

    def first() -> None:
        semaphore.give()
        log("first")

    kernel.spawn("urgent", urgent, 1)
    kernel.spawn("first", first, 50)
    kernel.spawn("second", log.writer("second"), 50)
    kernel.run()
    assert log == ["urgent", "first", "second"]


def test_wake_all_makes_everybody_ready_before_anyone_runs(kernel: Kernel, log: Log) -> None:
    waits = WaitList("signal")

    def waiter(name: str, priority: int) -> None:
        kernel.spawn(name, lambda: log(f"{name} {kernel.wait_on(waits)}"), priority)

    for name, priority in (("c", 30), ("a", 10), ("b", 10)):
        waiter(name, priority)
    kernel.run(until_ns=0)

    def waker() -> None:
        log(str(kernel.wake_all(waits, "go")))
        log("waker")

    kernel.spawn("waker", waker, 20)
    kernel.run()
    assert log == ["a go", "b go", "3", "waker", "c go"]


def test_waiters_are_woken_by_priority_and_then_by_arrival(kernel: Kernel, log: Log) -> None:
    queue = Queue(kernel, 8)
    for name, priority in (("c", 30), ("a", 10), ("d", 30), ("b", 20)):
        kernel.spawn(name, lambda name=name: log(f"{name}{queue.get()}"), priority)
    kernel.run(until_ns=0)
    for number in range(4):
        queue.put(number)
    kernel.run()
    assert log == ["a0", "b1", "c2", "d3"]


def test_yield_lets_equals_run_but_not_lesser_ones(kernel: Kernel, log: Log) -> None:
    def polite() -> None:
        log("one")
        kernel.yield_cpu()
        log("two")

    kernel.spawn("polite", polite, 50)
    kernel.spawn("equal", log.writer("equal"), 50)
    kernel.spawn("lesser", log.writer("lesser"), 60)
    kernel.run()
    assert log == ["one", "equal", "two", "lesser"]


def test_raising_another_tasks_priority_preempts(kernel: Kernel, log: Log) -> None:
    def booster() -> None:
        kernel.set_priority(slow, 1)
        log("booster")

    slow = kernel.spawn("slow", log.writer("slow"), 90)
    kernel.spawn("booster", booster, 50)
    kernel.run()
    assert log == ["slow", "booster"]


def test_lowering_ones_own_priority_gives_way(kernel: Kernel, log: Log) -> None:
    def modest() -> None:
        kernel.set_priority(kernel.current, 100)
        log("modest")

    kernel.spawn("modest", modest, 10)
    kernel.spawn("other", log.writer("other"), 50)
    kernel.run()
    assert log == ["other", "modest"]


def test_changing_the_priority_of_a_waiter_moves_it_in_the_queue(kernel: Kernel, log: Log) -> None:
    queue = Queue(kernel, 2)
    tasks = {name: kernel.spawn(name, lambda name=name: log(f"{name}{queue.get()}"), 50) for name in "ab"}
    kernel.run(until_ns=0)
    kernel.set_priority(tasks["b"], 40)
    queue.put(0)
    queue.put(1)
    kernel.run()
    assert log == ["b0", "a1"]


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


def test_a_wait_times_out_and_leaves_the_list(kernel: Kernel) -> None:
    waits = WaitList("nothing")
    results: list[object] = []

    def waiter() -> None:
        results.append(kernel.wait_on(waits, 100))
        results.append(kernel.now)

    kernel.spawn("waiter", waiter)
    kernel.run()
    assert results == [TIMEOUT, 100]
    assert not waits


def test_a_wake_up_in_time_cancels_the_time_out(kernel: Kernel) -> None:
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


def test_a_put_at_the_very_deadline_does_not_lose_the_item(kernel: Kernel) -> None:
    queue = Queue(kernel, 1)
    results: list[object] = []
    kernel.spawn("writer", lambda: (kernel.delay(100), queue.put("late")), 10)

    def reader() -> None:
        results.extend((queue.get(100), queue.get(0)))

    kernel.spawn("reader", reader, 20)
    kernel.run()
    assert results in (["late", EMPTY], [TIMEOUT, "late"])


def test_a_poll_of_an_empty_queue_does_not_wait(kernel: Kernel) -> None:
    queue = Queue(kernel, 1)
    results: list[object] = []
    kernel.spawn("reader", lambda: results.append(queue.get(0)))
    kernel.run()
    assert results == [EMPTY]
    assert kernel.now == 0


def test_a_full_queue_refuses(kernel: Kernel) -> None:
    queue = Queue(kernel, 2)
    assert [queue.put(number) for number in range(3)] == [True, True, False]
    assert queue.peak == 2


def test_used_cpu_time_moves_the_clock_and_lets_due_tasks_in(kernel: Kernel, log: Log) -> None:
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


def test_equals_take_turns_when_one_uses_the_cpu_for_long(kernel: Kernel) -> None:
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


def test_a_task_that_only_charges_stops_at_the_end_of_the_run(kernel: Kernel) -> None:
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
def test_slices_of_a_run_are_the_same_as_one_run(make_kernel: type[Kernel], board: dict[str, int]) -> None:
    digests = set()
    for pieces in ([1000], [1, 2, 3, 999, 1000], list(range(0, 1001, 50))):
        trace = Trace()
        with make_kernel(trace=trace, **board) as kernel:
            _periodic_program(kernel)
            for until in pieces:
                kernel.run(until_ns=until)
            digests.add(trace.digest())
    assert len(digests) == 1


def test_a_pause_leaves_no_record(make_kernel: type[Kernel]) -> None:
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


def test_deadlock_is_reported_with_what_everybody_waits_for(kernel: Kernel) -> None:
    queue = Queue(kernel, 1, "HK_PIPE")
    kernel.spawn("HK_APP", queue.get, 80)
    with pytest.raises(DeadlockError, match=r"HK_APP \(task 1, priority 80\) waits for queue HK_PIPE"):
        kernel.run()


def test_a_run_with_an_end_is_no_deadlock(kernel: Kernel) -> None:
    kernel.spawn("waiter", lambda: kernel.wait_on(WaitList("nothing"), FOREVER))
    kernel.run(until_ns=500)
    assert kernel.now == 500


def test_run_cannot_be_called_from_a_task(kernel: Kernel) -> None:
    kernel.spawn("nested", kernel.run)
    with pytest.raises(RuntimeError, match="inside the simulation"):
        kernel.run()


def test_the_host_must_not_wait(kernel: Kernel) -> None:
    with pytest.raises(RuntimeError, match="only a task"):
        kernel.delay(1)
    with pytest.raises(RuntimeError, match="only a task"):
        Queue(kernel, 1).get()


def test_next_event_tells_when_something_will_happen(kernel: Kernel) -> None:
    assert kernel.next_event() is None
    kernel.spawn("sleeper", lambda: kernel.delay(40))
    assert kernel.next_event() == 0
    kernel.run(until_ns=0)
    assert kernel.next_event() == 40


def test_children_work_for_their_parents_owner(kernel: Kernel) -> None:
    owners: list[object] = []
    kernel.spawn("app", lambda: kernel.spawn("child", lambda: owners.append(kernel.current.owner)), owner="APP")
    kernel.run()
    assert owners == ["APP"]

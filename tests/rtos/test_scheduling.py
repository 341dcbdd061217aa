"""The kernel's scheduling guarantees: strict priorities, order among equals, preemption."""

from __future__ import annotations

from cfepy.rtos import Kernel, Queue, Semaphore, WaitList
from tests.rtos.helpers import Log


def test_more_urgent_tasks_run_first(kernel: Kernel, log: Log) -> None:
    for name, priority in (("low", 200), ("high", 10), ("middle", 100)):
        kernel.spawn(name, log.writer(name), priority)
    kernel.run()
    assert log == ["high", "middle", "low"]


def test_tasks_of_equal_priority_run_in_the_order_they_became_ready(kernel: Kernel, log: Log) -> None:
    for name in "abcd":
        kernel.spawn(name, log.writer(name), 50)
    kernel.run()
    assert log == ["a", "b", "c", "d"]


def test_more_urgent_new_task_runs_before_spawn_returns(kernel: Kernel, log: Log) -> None:
    def parent() -> None:
        kernel.spawn("urgent", log.writer("urgent"), 10)
        log("parent")
        kernel.spawn("lazy", log.writer("lazy"), 90)
        log("parent again")

    kernel.spawn("parent", parent, 50)
    kernel.run()
    assert log == ["urgent", "parent", "parent again", "lazy"]


def test_wake_up_preempts_a_less_urgent_waker(kernel: Kernel, log: Log) -> None:
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


def test_wake_up_does_not_preempt_a_task_of_equal_priority(kernel: Kernel, log: Log) -> None:
    queue = Queue(kernel, 4)
    kernel.spawn("reader", lambda: log(f"got {queue.get()}"), 20)

    def writer() -> None:
        queue.put("x")
        log("put")

    kernel.spawn("writer", writer, 20)
    kernel.run()
    assert log == ["put", "got x"]


def test_preempted_task_stays_first_of_its_priority(kernel: Kernel, log: Log) -> None:
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


def test_wake_all_makes_all_tasks_ready_before_any_runs(kernel: Kernel, log: Log) -> None:
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


def test_yield_lets_tasks_of_equal_priority_run_but_no_lower_ones(kernel: Kernel, log: Log) -> None:
    def polite() -> None:
        log("one")
        kernel.yield_cpu()
        log("two")

    kernel.spawn("polite", polite, 50)
    kernel.spawn("equal", log.writer("equal"), 50)
    kernel.spawn("lesser", log.writer("lesser"), 60)
    kernel.run()
    assert log == ["one", "equal", "two", "lesser"]


def test_raised_priority_of_another_task_preempts(kernel: Kernel, log: Log) -> None:
    def booster() -> None:
        kernel.set_priority(slow, 1)
        log("booster")

    slow = kernel.spawn("slow", log.writer("slow"), 90)
    kernel.spawn("booster", booster, 50)
    kernel.run()
    assert log == ["slow", "booster"]


def test_task_that_lowers_its_priority_yields(kernel: Kernel, log: Log) -> None:
    def modest() -> None:
        kernel.set_priority(kernel.current, 100)
        log("modest")

    kernel.spawn("modest", modest, 10)
    kernel.spawn("other", log.writer("other"), 50)
    kernel.run()
    assert log == ["other", "modest"]


def test_changed_priority_of_a_waiter_moves_it_in_the_queue(kernel: Kernel, log: Log) -> None:
    queue = Queue(kernel, 2)
    tasks = {name: kernel.spawn(name, lambda name=name: log(f"{name}{queue.get()}"), 50) for name in "ab"}
    kernel.run(until_ns=0)
    kernel.set_priority(tasks["b"], 40)
    queue.put(0)
    queue.put(1)
    kernel.run()
    assert log == ["b0", "a1"]


def test_child_tasks_have_the_owner_of_their_parent(kernel: Kernel) -> None:
    owners: list[object] = []
    kernel.spawn("app", lambda: kernel.spawn("child", lambda: owners.append(kernel.current.owner)), owner="APP")
    kernel.run()
    assert owners == ["APP"]

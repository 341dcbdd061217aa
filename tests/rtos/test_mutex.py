"""Mutexes: recursion, transitive priority inheritance, hand-over, and the death of an owner."""

from __future__ import annotations

import pytest

from cfepy.rtos import DeadlockError, Kernel, Mutex, Semaphore
from tests.rtos.helpers import Log


def test_a_mutex_is_recursive(kernel: Kernel, log: Log) -> None:
    mutex = Mutex(kernel)

    def owner() -> None:
        mutex.take()
        mutex.take()
        mutex.give()
        log(f"owned {mutex.owner is kernel.current}")
        mutex.give()
        log(f"owned {mutex.owner is kernel.current}")

    kernel.spawn("owner", owner)
    kernel.run()
    assert log == ["owned True", "owned False"]


def test_mutex_can_be_given_only_by_its_owner(kernel: Kernel) -> None:
    mutex = Mutex(kernel)
    given: list[bool] = []

    def owner() -> None:
        mutex.take()
        kernel.delay(10)
        given.append(mutex.give())

    kernel.spawn("owner", owner)
    kernel.spawn("thief", lambda: given.append(mutex.give()))
    kernel.run()
    assert given == [False, True]


def test_most_urgent_waiter_gets_the_mutex_next(kernel: Kernel, log: Log) -> None:
    mutex = Mutex(kernel)

    def owner() -> None:
        mutex.take()
        kernel.delay(10)
        mutex.give()

    def user(name: str) -> None:
        kernel.delay(1)
        mutex.take()
        log(name)
        mutex.give()

    kernel.spawn("owner", owner, 40)
    for name, priority in (("c", 90), ("a", 50), ("b", 50)):
        kernel.spawn(name, lambda name=name: user(name), priority)
    kernel.run()
    assert log == ["a", "b", "c"]


def test_mutex_prevents_priority_inversion(kernel: Kernel, log: Log) -> None:
    """The less urgent owner must not be held up by a middle task while an urgent one waits for it."""
    mutex = Mutex(kernel)

    def low() -> None:
        mutex.take()
        kernel.charge(100)
        mutex.give()
        log("low")

    def middle() -> None:
        kernel.delay(10)
        log("middle")

    def high() -> None:
        kernel.delay(10)
        mutex.take()
        log("high")
        mutex.give()

    kernel.spawn("low", low, 200)
    kernel.spawn("middle", middle, 100)
    kernel.spawn("high", high, 10)
    kernel.run()
    assert log == ["high", "middle", "low"]


def test_inheritance_is_transitive(kernel: Kernel) -> None:
    first, second, third = (Mutex(kernel, name) for name in ("1", "2", "3"))
    seen: list[list[int]] = []

    def holder(own: Mutex, wanted: Mutex | None, hold_ns: int) -> None:
        own.take()
        kernel.delay(hold_ns)
        if wanted is not None:
            wanted.take()
            wanted.give()
        kernel.delay(100)
        own.give()

    tasks = [
        kernel.spawn("a", lambda: holder(first, None, 5), 200),
        kernel.spawn("b", lambda: holder(second, first, 5), 150),
        kernel.spawn("c", lambda: holder(third, second, 6), 100),
    ]

    def urgent() -> None:
        kernel.delay(10)
        third.take()
        third.give()

    kernel.spawn("urgent", urgent, 10)
    kernel.run(until_ns=20)
    seen.append([task.priority for task in tasks])
    kernel.run()
    seen.append([task.priority for task in tasks])
    assert seen == [[10, 10, 10], [200, 150, 100]]


def test_release_of_one_of_two_mutexes_lowers_only_its_share_of_the_priority(kernel: Kernel) -> None:
    first, second = Mutex(kernel), Mutex(kernel)
    seen: list[int] = []

    def owner() -> None:
        first.take()
        second.take()
        kernel.delay(10)
        seen.append(kernel.current.priority)
        second.give()
        seen.append(kernel.current.priority)
        first.give()
        seen.append(kernel.current.priority)

    def user(mutex: Mutex) -> None:
        kernel.delay(1)
        mutex.take()
        mutex.give()

    kernel.spawn("owner", owner, 100)
    kernel.spawn("middle", lambda: user(first), 50)
    kernel.spawn("urgent", lambda: user(second), 10)
    kernel.run()
    assert seen == [10, 50, 100]


def test_killed_waiter_no_longer_raises_the_owner(kernel: Kernel) -> None:
    mutex = Mutex(kernel)

    def owner() -> None:
        mutex.take()
        kernel.delay(100)
        mutex.give()

    low = kernel.spawn("low", owner, 200)
    high = kernel.spawn("high", lambda: (kernel.delay(1), mutex.take()), 10)
    kernel.run(until_ns=50)
    assert low.priority == 10
    kernel.kill(high)
    assert low.priority == 200
    kernel.run()
    assert mutex.owner is None


def test_lost_urgency_is_removed_from_the_whole_chain(kernel: Kernel) -> None:
    first, second = Mutex(kernel), Mutex(kernel)

    def holder(own: Mutex, wanted: Mutex | None) -> None:
        own.take()
        kernel.delay(5)
        if wanted is not None:
            wanted.take()
        kernel.delay(1000)

    low = kernel.spawn("low", lambda: holder(first, None), 200)
    middle = kernel.spawn("middle", lambda: holder(second, first), 150)
    high = kernel.spawn("high", lambda: (kernel.delay(10), second.take()), 10)
    kernel.run(until_ns=50)
    assert (low.priority, middle.priority) == (10, 10)
    kernel.kill(high)
    assert (low.priority, middle.priority) == (150, 150)


def test_set_priority_keeps_the_inherited_priority(kernel: Kernel) -> None:
    mutex = Mutex(kernel)

    def owner() -> None:
        mutex.take()
        kernel.delay(100)
        mutex.give()

    low = kernel.spawn("low", owner, 200)
    kernel.spawn("high", lambda: (kernel.delay(1), mutex.take(), mutex.give()), 10)
    kernel.run(until_ns=50)
    kernel.set_priority(low, 150)
    assert (low.priority, low.base_priority) == (10, 150)
    kernel.run()
    assert low.priority == 150


def test_raised_priority_of_a_waiter_is_inherited(kernel: Kernel) -> None:
    mutex = Mutex(kernel)

    def owner() -> None:
        mutex.take()
        kernel.delay(100)
        mutex.give()

    low = kernel.spawn("low", owner, 200)
    waiter = kernel.spawn("waiter", lambda: (kernel.delay(1), mutex.take(), mutex.give()), 150)
    kernel.run(until_ns=50)
    assert low.priority == 150
    kernel.set_priority(waiter, 5)
    assert low.priority == 5
    kernel.set_priority(waiter, 180)
    assert low.priority == 180


def test_owner_that_ends_passes_the_mutex_on(kernel: Kernel, log: Log) -> None:
    mutex = Mutex(kernel)
    kernel.spawn("forgetful", lambda: (mutex.take(), kernel.delay(5)), 10)
    kernel.spawn("next", lambda: (mutex.take(), log(f"next@{kernel.now}")), 20)
    kernel.run()
    assert log == ["next@5"]


def test_killed_owner_passes_the_mutex_on(kernel: Kernel, log: Log) -> None:
    mutex = Mutex(kernel)
    owner = kernel.spawn("owner", lambda: (mutex.take(), kernel.delay(1000)), 10)
    kernel.spawn("next", lambda: (mutex.take(), log(f"next@{kernel.now}")), 20)
    kernel.run(until_ns=7)
    kernel.kill(owner)
    kernel.run()
    assert log == ["next@7"]


def test_urgent_waiter_of_a_killed_owner_preempts_the_killer(kernel: Kernel, log: Log) -> None:
    mutex = Mutex(kernel)
    owner = kernel.spawn("owner", lambda: (mutex.take(), kernel.delay(1000)), 10)
    kernel.spawn("next", lambda: (mutex.take(), log("next")), 20)
    kernel.spawn("killer", lambda: (kernel.kill(owner), log("killer")), 30)
    kernel.run()
    assert log == ["next", "killer"]


def test_two_mutexes_taken_in_opposite_order_are_a_deadlock(kernel: Kernel) -> None:
    first, second = Mutex(kernel, "A"), Mutex(kernel, "B")

    def user(one: Mutex, other: Mutex) -> None:
        one.take()
        kernel.delay(10)
        other.take()

    kernel.spawn("t1", lambda: user(first, second))
    kernel.spawn("t2", lambda: user(second, first))
    with pytest.raises(DeadlockError, match=r"t2 takes mutex A, whose owner waits for t2(.|\n)*held by t2"):
        kernel.run()


def test_binary_semaphore_ignores_a_second_give(kernel: Kernel) -> None:
    semaphore = Semaphore(kernel, 0, 1)
    taken: list[bool] = []
    semaphore.give()
    semaphore.give()
    kernel.spawn("taker", lambda: taken.extend([semaphore.take(), semaphore.take(0), semaphore.take(5)]))
    kernel.run()
    assert taken == [True, False, False]
    assert kernel.now == 5


def test_flush_releases_all_waiters_and_keeps_the_count(kernel: Kernel, log: Log) -> None:
    semaphore = Semaphore(kernel, 0, 1)
    for name in "abc":
        kernel.spawn(name, lambda name=name: log(f"{name} {semaphore.take()}"))
    kernel.run(until_ns=1)
    semaphore.flush()
    kernel.run()
    assert log == ["a True", "b True", "c True"]
    assert semaphore.count == 0

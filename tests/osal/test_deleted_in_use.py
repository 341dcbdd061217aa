"""Objects and tasks that are deleted while a task uses them, as recorded on NASA's OSAL 7.0.0 on Linux.

A task that waits forever there waits forever here. A safe mission prevents it; each kind of object has tests of it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from cfepy.osal.limits import OS_PEND
from cfepy.osal.sockaddr import OS_SocketDomain_INET
from cfepy.osal.streams import OS_SocketType_DATAGRAM
from cfepy.status import OS_ERR_INVALID_ID, OS_ERR_NAME_TAKEN, OS_ERR_OBJECT_IN_USE, OS_SEM_FAILURE, OsalError
from tests.osal.helpers import MS, Bench
from tests.osal.sockets import address, bound
from tests.osal.test_queues import status_of

FOREVER = "waits"


class Calls:
    """Calls in tasks of their own, with the result of each and the virtual time in ms at which it returned."""

    def __init__(self, bench: Bench) -> None:
        self.bench = bench
        self.results: dict[str, Any] = {}

    def start(self, name: str, function: Callable[..., object], *arguments: Any) -> int:
        """Start a task that makes a call."""

        def call() -> None:
            self.results[name] = FOREVER
            status = 0
            try:
                function(*arguments)
            except OsalError as error:
                status = error.status
            self.results[name] = (status, self.bench.kernel.now // MS)

        task_id = self.bench.task(call, name=name)
        self.bench.kernel.run(self.bench.kernel.now + 100 * MS)
        return task_id

    def pass_ms(self, milliseconds: int) -> None:
        """Let time pass."""
        self.bench.kernel.run(self.bench.kernel.now + milliseconds * MS)


@pytest.fixture
def calls(bench: Bench) -> Calls:
    return Calls(bench)


@pytest.mark.parametrize("end", ["return", "exit", "delete"])
def test_mutex_of_a_task_that_ended_stays_locked(calls: Calls, end: str) -> None:
    os = calls.bench.os
    mutex = os.mut_sem_create("M")

    def hold() -> None:
        os.mut_sem_take(mutex)
        if end == "exit":
            os.task_exit()
        if end == "delete":
            os.task_delay(100_000)

    holder = calls.start("HOLDER", hold)
    if end == "delete":
        os.task_delete(holder)
    calls.start("TAKER", os.mut_sem_take, mutex)
    assert calls.results["TAKER"] == FOREVER
    assert status_of(os.mut_sem_delete, mutex) == OS_SEM_FAILURE, OsalError
    assert status_of(os.mut_sem_create, "M") == OS_ERR_NAME_TAKEN
    assert "held by HOLDER" in calls.bench.kernel.waiting()


def test_end_of_a_task_with_a_mutex_that_another_one_waits_for_aborts(calls: Calls) -> None:
    os, kernel = calls.bench.os, calls.bench.kernel
    mutex = os.mut_sem_create("M")

    def hold() -> None:
        os.mut_sem_take(mutex)
        os.task_delay(150)

    calls.start("HOLDER", hold)
    calls.start("TAKER", os.mut_sem_take, mutex)
    calls.pass_ms(1000)
    assert kernel.abortion is not None
    assert kernel.abortion.at_ns == 150 * MS
    assert kernel.abortion.text == (
        "HOLDER ended while it held mutex M, for which TAKER waits (assertion in pthread_mutex_lock)"
    )
    ran: list[int] = []
    calls.bench.task(lambda: ran.append(1), name="LATER")
    calls.pass_ms(1000)
    assert not ran


def test_two_tasks_that_take_two_mutexes_in_opposite_orders_wait_forever(calls: Calls) -> None:
    os, kernel = calls.bench.os, calls.bench.kernel
    first, second = os.mut_sem_create("A"), os.mut_sem_create("B")

    def take(one: int, other: int) -> None:
        os.mut_sem_take(one)
        os.task_delay(150)
        os.mut_sem_take(other)

    calls.start("X", take, first, second)
    calls.start("Y", take, second, first)
    calls.pass_ms(1000)
    assert calls.results == {"X": FOREVER, "Y": FOREVER}
    assert [[wait.task.name for wait in circle] for circle in kernel.deadlocked()] == [["X", "Y"]]


def test_readers_of_a_deleted_queue_wait_to_their_time_limit(calls: Calls) -> None:
    os = calls.bench.os
    queue = os.queue_create("Q", 2, 4)
    timed, endless = ("TIMED", os.queue_get, queue, 500), ("ENDLESS", os.queue_get, queue, OS_PEND)
    calls.start(*timed)
    calls.start(*endless)
    os.queue_delete(queue)
    os.queue_put(os.queue_create("Q", 2, 4), b"1234")
    calls.pass_ms(1000)
    assert calls.results == {"TIMED": (0, 500), "ENDLESS": FOREVER}
    assert "queue Q, which was deleted" in calls.bench.kernel.waiting()


def test_delete_of_a_semaphore_waits_for_the_tasks_that_wait_for_it(calls: Calls) -> None:
    os = calls.bench.os
    semaphore = os.bin_sem_create("S", 0)
    calls.start("TIMED", os.bin_sem_timed_wait, semaphore, 500)
    calls.start("DELETER", os.bin_sem_delete, semaphore)
    assert status_of(os.bin_sem_give, semaphore) == OS_ERR_INVALID_ID
    calls.pass_ms(1000)
    assert calls.results == {"TIMED": (0, 500), "DELETER": (0, 500)}
    semaphore = os.bin_sem_create("S", 0)
    calls.start("ENDLESS", os.bin_sem_take, semaphore)
    calls.start("STUCK", os.bin_sem_delete, semaphore)
    calls.pass_ms(1000)
    assert calls.results["ENDLESS"] == calls.results["STUCK"] == FOREVER
    assert "semaphore S, which STUCK is deleting" in calls.bench.kernel.waiting()


def test_object_that_is_being_deleted_is_not_listed(calls: Calls) -> None:
    os = calls.bench.os
    kept, deleted = os.bin_sem_create("KEPT", 0), os.bin_sem_create("DELETED", 0)
    calls.start("TAKER", os.bin_sem_take, deleted)
    calls.start("DELETER", os.bin_sem_delete, deleted)
    assert calls.results["DELETER"] == FOREVER
    found: list[int] = []
    os.for_each_object(0, lambda object_id, argument: found.append(object_id))
    assert kept in found
    assert deleted not in found


def test_delete_of_a_condition_variable_waits_for_the_tasks_that_wait_for_it(calls: Calls) -> None:
    os = calls.bench.os
    variable = os.cond_var_create("V")
    until = os.time_from_relative_milliseconds(500)

    def wait() -> None:
        os.cond_var_lock(variable)
        os.cond_var_timed_wait(variable, until)

    calls.start("WAITER", wait)
    calls.start("DELETER", os.cond_var_delete, variable)
    assert status_of(os.cond_var_broadcast, variable) == OS_ERR_INVALID_ID
    calls.pass_ms(1000)
    assert calls.results["DELETER"] == (0, 500)


def test_delete_of_a_semaphore_ends_when_its_waiting_task_is_deleted(calls: Calls) -> None:
    os = calls.bench.os
    semaphore = os.bin_sem_create("S", 0)
    waiter = calls.start("WAITER", os.bin_sem_take, semaphore)
    calls.start("DELETER", os.bin_sem_delete, semaphore)
    os.task_delete(waiter)
    calls.pass_ms(10)
    assert calls.results["DELETER"] == (0, 200)
    os.bin_sem_create("S", 0)


def test_takers_of_a_deleted_counting_semaphore_wait_to_their_time_limit(calls: Calls) -> None:
    os = calls.bench.os
    semaphore = os.count_sem_create("S", 0)
    calls.start("TIMED", os.count_sem_timed_wait, semaphore, 500)
    calls.start("ENDLESS", os.count_sem_take, semaphore)
    os.count_sem_delete(semaphore)
    calls.pass_ms(1000)
    assert calls.results == {"TIMED": (0, 500), "ENDLESS": FOREVER}


def test_lock_is_deleted_while_a_task_holds_it_and_its_waiters_wait_forever(calls: Calls) -> None:
    os = calls.bench.os
    lock = os.rw_lock_create("L")

    def hold() -> None:
        os.rw_lock_write_take(lock)
        os.task_delay(300)
        os.rw_lock_write_give(lock)

    calls.start("HOLDER", hold)
    calls.start("READER", os.rw_lock_read_take, lock)
    os.rw_lock_delete(lock)
    calls.pass_ms(1000)
    assert calls.results == {"HOLDER": (OS_ERR_INVALID_ID, 300), "READER": FOREVER}


def test_task_that_waits_for_a_mutex_ends_after_it_got_it(calls: Calls) -> None:
    os = calls.bench.os
    mutex = os.mut_sem_create("M")

    def hold() -> None:
        os.mut_sem_take(mutex)
        os.task_delay(400)
        os.mut_sem_give(mutex)

    def use() -> None:
        os.mut_sem_take(mutex)
        calls.results["has it"] = calls.bench.kernel.now // MS
        os.task_delay(100_000)

    calls.start("HOLDER", hold)
    victim = calls.start("VICTIM", use)
    calls.start("DELETER", os.task_delete, victim)
    assert calls.results["DELETER"] == FOREVER
    calls.pass_ms(300)
    assert calls.results["DELETER"] == (0, 400)
    assert calls.results["has it"] == 400
    calls.start("TAKER", os.mut_sem_take, mutex)
    assert calls.results["TAKER"] == FOREVER


def test_close_of_a_socket_at_which_a_task_waits_fails_after_300_ms(calls: Calls) -> None:
    os = calls.bench.os
    sock_id = bound(calls.bench, 5000)
    calls.start("READER", os.socket_recv_from, sock_id, 9)
    calls.start("CLOSER", os.close, sock_id)
    calls.pass_ms(500)
    assert calls.results == {"READER": FOREVER, "CLOSER": (OS_ERR_OBJECT_IN_USE, 400)}
    sender = os.socket_open(OS_SocketDomain_INET, OS_SocketType_DATAGRAM)
    os.socket_send_to(sender, b"1", address(5000))
    calls.pass_ms(1)
    assert calls.results["READER"] != FOREVER
    os.close(sock_id)


def test_socket_of_a_reader_that_was_deleted_can_never_be_closed(calls: Calls) -> None:
    os = calls.bench.os
    sock_id = bound(calls.bench, 5000)
    os.task_delete(calls.start("READER", os.socket_recv_from, sock_id, 9))
    for name in ("CLOSER", "AGAIN"):
        calls.start(name, os.close, sock_id)
        calls.pass_ms(500)
    assert [calls.results[name][0] for name in ("CLOSER", "AGAIN")] == [OS_ERR_OBJECT_IN_USE] * 2

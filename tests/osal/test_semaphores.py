"""OS_BinSem*, OS_CountSem*, OS_MutSem*, OS_CondVar*, OS_RwLock*."""

from __future__ import annotations

import pytest

from cfepy.osal.clock import time_from_total_milliseconds
from cfepy.osal.limits import SEM_VALUE_MAX
from cfepy.status import (
    OS_ERR_INVALID_ARGUMENT,
    OS_ERR_INVALID_ID,
    OS_ERR_NAME_TAKEN,
    OS_ERROR,
    OS_INVALID_SEM_VALUE,
    OS_SEM_FAILURE,
)
from tests.osal.helpers import MS, Bench
from tests.osal.test_queues import status_of


def test_second_give_of_a_binary_semaphore_is_lost(bench: Bench) -> None:
    sem_id = bench.os.bin_sem_create("S", 0)
    bench.os.bin_sem_give(sem_id)
    bench.os.bin_sem_give(sem_id)
    assert bench.os.bin_sem_get_info(sem_id).value == 1
    assert [bench.os.bin_sem_timed_wait(sem_id, 0) for _ in range(2)] == [True, False]


def test_initial_values(bench: Bench) -> None:
    assert bench.os.bin_sem_get_info(bench.os.bin_sem_create("A", 5)).value == 1
    assert bench.os.count_sem_get_info(bench.os.count_sem_create("A", 5)).value == 5
    assert status_of(bench.os.count_sem_create, "B", SEM_VALUE_MAX + 1) == OS_INVALID_SEM_VALUE
    assert status_of(bench.os.bin_sem_create, "B", -1) == OS_INVALID_SEM_VALUE
    assert status_of(bench.os.bin_sem_create, "A", 0) == OS_ERR_NAME_TAKEN


def test_counting_semaphore_has_a_maximum(bench: Bench) -> None:
    sem_id = bench.os.count_sem_create("S", SEM_VALUE_MAX)
    assert status_of(bench.os.count_sem_give, sem_id) == OS_SEM_FAILURE


@pytest.mark.parametrize("kind", ["bin", "count"])
def test_take_waits_for_a_give(bench: Bench, kind: str) -> None:
    create, give, take, timed = (
        getattr(bench.os, f"{kind}_sem_{name}") for name in ("create", "give", "take", "timed_wait")
    )
    sem_id = create("S", 0)

    def giver() -> None:
        bench.os.task_delay(30)
        give(sem_id)

    def body() -> list[object]:
        results = [timed(sem_id, 10), bench.kernel.now // MS]
        take(sem_id)
        return [*results, bench.kernel.now // MS]

    bench.task(giver)
    assert bench.run(body) == [False, 10, 30]
    assert status_of(timed, sem_id, -1) == OS_ERR_INVALID_ARGUMENT


@pytest.mark.parametrize("kind", ["bin", "count"])
def test_deleted_semaphore_wakes_its_waiters_with_an_error_in_a_safe_mission(safe_bench: Bench, kind: str) -> None:
    os = safe_bench.os
    sem_id = getattr(os, f"{kind}_sem_create")("S", 0)
    safe_bench.task(lambda: (os.task_delay(1), getattr(os, f"{kind}_sem_delete")(sem_id)), name="D")
    take = getattr(os, f"{kind}_sem_take")
    assert safe_bench.run(lambda: status_of(take, sem_id)) == OS_ERR_INVALID_ID
    assert status_of(take, sem_id) == OS_ERR_INVALID_ID


def test_flush_releases_all_waiters(bench: Bench) -> None:
    sem_id = bench.os.bin_sem_create("S", 0)
    for name in "abc":
        bench.task(lambda name=name: (bench.os.bin_sem_take(sem_id), bench.log.append(name)), name=name)

    def body() -> int:
        bench.os.task_delay(1)
        bench.os.bin_sem_flush(sem_id)
        bench.os.task_delay(1)
        return bench.os.bin_sem_get_info(sem_id).value

    assert bench.run(body) == 0
    assert bench.log == ["a", "b", "c"]


def test_mutex_belongs_to_its_taker(bench: Bench) -> None:
    mutex_id = bench.os.mut_sem_create("M")

    def owner() -> None:
        bench.os.mut_sem_take(mutex_id)
        bench.os.mut_sem_take(mutex_id)
        bench.os.task_delay(10)
        bench.os.mut_sem_give(mutex_id)
        bench.os.mut_sem_give(mutex_id)

    def body() -> list[int]:
        results = [
            status_of(bench.os.mut_sem_give, mutex_id),
            status_of(bench.os.mut_sem_delete, mutex_id),
        ]
        bench.os.mut_sem_take(mutex_id)
        bench.os.mut_sem_give(mutex_id)
        return [*results, status_of(bench.os.mut_sem_give, mutex_id), bench.kernel.now]

    bench.task(owner, 50)
    assert bench.run(body) == [OS_SEM_FAILURE, OS_SEM_FAILURE, OS_SEM_FAILURE, 10 * MS]
    bench.os.mut_sem_delete(mutex_id)
    assert status_of(bench.os.mut_sem_take, mutex_id) == OS_ERR_INVALID_ID


def test_condition_variable_loses_no_signal_between_unlock_and_wait(bench: Bench) -> None:
    var_id = bench.os.cond_var_create("C")

    def urgent_signaller() -> None:
        bench.os.task_delay(1)
        bench.os.cond_var_lock(var_id)  # waits until the other unlocks it by waiting, and runs at once then
        bench.log.append("signal")
        bench.os.cond_var_signal(var_id)
        bench.os.cond_var_unlock(var_id)

    def body() -> int:
        bench.os.cond_var_lock(var_id)
        bench.os.task_delay(2)
        bench.os.cond_var_wait(var_id)
        bench.log.append("woken")
        bench.os.cond_var_unlock(var_id)
        return bench.kernel.now

    bench.task(urgent_signaller, 10)
    assert bench.run(body) == 2 * MS
    assert bench.log == ["signal", "woken"]


def test_broadcast_wakes_all_waiters_one_after_another(bench: Bench) -> None:
    var_id = bench.os.cond_var_create("C")

    def waiter(name: str) -> None:
        bench.os.cond_var_lock(var_id)
        bench.os.cond_var_wait(var_id)
        bench.log.append((name, bench.kernel.now // MS))
        bench.os.task_delay(5)
        bench.os.cond_var_unlock(var_id)

    for name in "ab":
        bench.task(lambda name=name: waiter(name), name=name)
    bench.run(lambda: (bench.os.task_delay(1), bench.os.cond_var_broadcast(var_id)))
    assert bench.log == [("a", 1), ("b", 6)]


def test_timed_wait_ends_at_a_local_time_with_the_lock_held(bench: Bench) -> None:
    var_id = bench.os.cond_var_create("C")
    bench.os.set_local_time(time_from_total_milliseconds(1_000_000))

    def body() -> tuple[bool, int]:
        bench.os.cond_var_lock(var_id)
        woken = bench.os.cond_var_timed_wait(var_id, time_from_total_milliseconds(1_000_020))
        bench.os.cond_var_unlock(var_id)
        return woken, bench.kernel.now

    assert bench.run(body) == (False, 20 * MS)


def test_a_wait_without_the_lock_is_an_error(bench: Bench) -> None:
    var_id = bench.os.cond_var_create("C")
    assert bench.run(lambda: status_of(bench.os.cond_var_wait, var_id)) == OS_ERROR
    assert status_of(bench.os.cond_var_unlock, var_id) == OS_ERROR


def test_deleted_condition_variable_wakes_its_waiters_with_an_error_in_a_safe_mission(safe_bench: Bench) -> None:
    os = safe_bench.os
    var_id = os.cond_var_create("C")
    safe_bench.task(lambda: (os.task_delay(1), os.cond_var_delete(var_id)), name="D")
    assert safe_bench.run(lambda: (os.cond_var_lock(var_id), status_of(os.cond_var_wait, var_id))[1]) == (
        OS_ERR_INVALID_ID
    )


def test_lock_has_many_readers_or_one_writer(bench: Bench) -> None:
    lock = bench.os.rw_lock_create("L")

    def reader(name: str, start: int) -> None:
        bench.os.task_delay(start)
        bench.os.rw_lock_read_take(lock)
        bench.log.append((name, bench.kernel.now // MS))
        bench.os.task_delay(10)
        bench.os.rw_lock_read_give(lock)

    def writer() -> None:
        bench.os.task_delay(2)
        bench.os.rw_lock_write_take(lock)
        bench.log.append(("w", bench.kernel.now // MS))
        bench.os.task_delay(10)
        bench.os.rw_lock_write_give(lock)

    for name, start in (("r0", 0), ("r1", 1), ("r3", 3)):
        bench.task(lambda name=name, start=start: reader(name, start), name=name)
    bench.task(writer)
    bench.kernel.run()
    assert bench.log == [("r0", 0), ("r1", 1), ("w", 11), ("r3", 21)]
    assert status_of(bench.os.rw_lock_read_give, lock) == OS_ERROR
    assert status_of(bench.os.rw_lock_write_give, lock) == OS_ERROR
    bench.os.rw_lock_delete(lock)

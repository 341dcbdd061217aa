"""OS_Timer* and OS_TimeBase*: the times of callbacks, and the allowed callers."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from cfepy.status import (
    OS_ERR_INCORRECT_OBJ_STATE,
    OS_ERR_INVALID_ID,
    OS_ERR_NAME_TAKEN,
    OS_ERR_OBJECT_IN_USE,
    OS_INVALID_POINTER,
    OS_TIMER_ERR_INVALID_ARGS,
)
from tests.osal.helpers import MS, Bench
from tests.osal.test_queues import status_of


@pytest.fixture
def master(bench: Bench) -> int:
    """A time base of 10 ms that ticks from time 0."""
    timebase_id = bench.os.time_base_create("cFS-Master")
    bench.os.time_base_set(timebase_id, 10_000, 10_000)
    return timebase_id


def _noter(bench: Bench, name: str = "") -> Callable[[int, object], None]:
    return lambda timer_id, argument: bench.log.append(
        (name, bench.kernel.now // MS) if name else bench.kernel.now // MS
    )


@pytest.mark.parametrize(
    ("start_us", "interval_us", "expected"),
    [
        (10_000, 0, [10]),
        (15_000, 0, [20]),
        (1, 0, [10]),
        (30_000, 20_000, [30, 50, 70, 90]),
        (0, 40_000, [40, 80]),
        (25_000, 25_000, [30, 50, 80, 100]),
        (100_000, 1_000_000, [100]),
        (95_000, 5_000, [100, 100]),
    ],
)
def test_expiries_are_at_ticks(bench: Bench, master: int, start_us: int, interval_us: int, expected: list[int]) -> None:
    timer_id = bench.os.timer_add("T", master, _noter(bench))
    bench.os.timer_set(timer_id, start_us, interval_us)
    bench.kernel.run(until_ns=100 * MS)
    assert bench.log == expected


def test_a_timer_set_between_ticks_counts_from_the_last_tick(bench: Bench, master: int) -> None:
    timer_id = bench.os.timer_add("T", master, _noter(bench))
    bench.kernel.run(until_ns=17 * MS)
    bench.os.timer_set(timer_id, 10_000, 0)
    bench.kernel.run(until_ns=100 * MS)
    assert bench.log == [20]


def test_idle_time_base_costs_nothing(bench: Bench, master: int) -> None:
    bench.kernel.run(until_ns=1)
    events = len(bench.kernel.trace.records) if bench.kernel.trace else 0
    bench.kernel.run(until_ns=3_600_000 * MS)
    assert bench.kernel.trace is not None
    assert len(bench.kernel.trace.records) == events
    assert bench.os.time_base_get_free_run(master) == 3_600_000_000


def test_a_timer_that_is_set_earlier_wakes_the_time_base(bench: Bench, master: int) -> None:
    late, early = (bench.os.timer_add(name, master, _noter(bench, name)) for name in ("late", "early"))
    bench.os.timer_set(late, 100_000, 0)
    bench.kernel.run(until_ns=15 * MS)
    bench.os.timer_set(early, 30_000, 0)
    bench.kernel.run(until_ns=200 * MS)
    assert bench.log == [("early", 40), ("late", 100)]


def test_timers_due_at_one_tick_run_newest_first(bench: Bench, master: int) -> None:
    for name in "abc":
        bench.os.timer_set(bench.os.timer_add(name, master, _noter(bench, name)), 50_000, 0)
    bench.kernel.run(until_ns=100 * MS)
    assert bench.log == [("c", 50), ("b", 50), ("a", 50)]


def test_single_timer_has_its_own_time_base(bench: Bench) -> None:
    timer_id = bench.os.timer_create("T", lambda given: bench.log.append((given == timer_id, bench.kernel.now // MS)))
    bench.os.timer_set(timer_id, 7_000, 13_000)
    bench.kernel.run(until_ns=40 * MS)
    assert bench.log == [(True, 7), (True, 20), (True, 33)]
    bench.os.timer_set(timer_id, 100_000, 0)
    bench.kernel.run(until_ns=400 * MS)
    assert bench.log[3:] == [(True, 140)]
    assert bench.os.timer_get_info(timer_id)[:4:2] == ("T", 0)
    bench.os.timer_delete(timer_id)
    assert not bench.kernel.tasks


def test_timer_of_its_own_that_starts_at_0_never_expires(bench: Bench) -> None:
    timer_id = bench.os.timer_create("T", lambda timer_id: bench.log.append(bench.kernel.now // MS))
    bench.os.timer_set(timer_id, 0, 10_000)
    bench.kernel.run(100 * MS)
    assert bench.log == []
    bench.os.timer_set(timer_id, 20_000, 10_000)
    bench.kernel.run(135 * MS)
    assert bench.log == [120, 130]


def test_time_base_that_starts_at_0_stops(bench: Bench, master: int) -> None:
    timer_id = bench.os.timer_add("T", master, _noter(bench))
    bench.os.timer_set(timer_id, 10_000, 10_000)
    bench.kernel.run(25 * MS)
    bench.os.time_base_set(master, 0, 10_000)
    bench.kernel.run(100 * MS)
    assert bench.log == [10, 20]
    assert bench.os.time_base_get_free_run(master) == 20_000


def test_timer_on_a_time_base_that_starts_at_0_expires_after_one_interval(bench: Bench, master: int) -> None:
    timer_id = bench.os.timer_add("T", master, _noter(bench))
    bench.os.timer_set(timer_id, 0, 30_000)
    bench.kernel.run(70 * MS)
    assert bench.log == [30, 60]


def test_the_argument_of_a_timer(bench: Bench, master: int) -> None:
    timer_id = bench.os.timer_add("T", master, lambda timer_id, argument: bench.log.append(argument), "argument")
    bench.os.timer_set(timer_id, 1, 0)
    bench.kernel.run(until_ns=100 * MS)
    assert bench.log == ["argument"]


def test_callback_runs_before_other_tasks_of_that_instant(bench: Bench, master: int) -> None:
    bench.task(lambda: (bench.os.task_delay(20), bench.log.append("task")), priority=0, name="T")
    bench.os.timer_set(bench.os.timer_add("T", master, lambda *_: bench.log.append("callback")), 20_000, 0)
    bench.task(lambda: (bench.os.task_delay(20), bench.log.append("lesser")), priority=1, name="L")
    bench.kernel.run(until_ns=100 * MS)
    assert set(bench.log[:2]) == {"task", "callback"}
    assert bench.log[2] == "lesser"


def test_callbacks_may_give_semaphores_and_put_messages_but_not_manage_timers(bench: Bench, master: int) -> None:
    sem_id = bench.os.bin_sem_create("S", 0)

    def callback(timer_id: int, argument: object) -> None:
        bench.os.bin_sem_give(sem_id)
        bench.log.append(bench.os.task_get_id())
        for call in (
            lambda: bench.os.timer_set(timer_id, 1, 1),
            lambda: bench.os.timer_delete(timer_id),
            lambda: bench.os.timer_add("U", master, callback),
            lambda: bench.os.timer_create("U", bool),
            lambda: bench.os.timer_get_info(timer_id),
            lambda: bench.os.timer_get_id_by_name("T"),
            lambda: bench.os.time_base_set(master, 1, 1),
            lambda: bench.os.time_base_delete(master),
            lambda: bench.os.time_base_get_info(master),
            lambda: bench.os.time_base_get_id_by_name("cFS-Master"),
        ):
            bench.log.append(status_of(call))

    bench.os.timer_set(bench.os.timer_add("T", master, callback), 10_000, 0)
    bench.run(lambda: bench.os.bin_sem_take(sem_id))
    assert bench.log == [master] + [OS_ERR_INCORRECT_OBJ_STATE] * 10


def test_error_in_a_callback_belongs_to_its_application_and_the_time_base_continues(bench: Bench, master: int) -> None:
    class App:
        name = "APP"

    app = App()

    def hook(task: object, error: BaseException) -> bool:
        bench.log.append((task.owner, str(error)))  # type: ignore[attr-defined]  # a kernel task
        return True

    def fail(*_: object) -> None:
        raise ValueError("in a callback")

    bench.kernel.on_task_error = hook
    bench.task(lambda: bench.os.timer_set(bench.os.timer_add("BAD", master, fail), 10_000, 0), name="MAKER", owner=app)
    bench.kernel.run(until_ns=1)
    bench.os.timer_set(bench.os.timer_add("GOOD", master, _noter(bench)), 20_000, 0)
    bench.kernel.run(until_ns=100 * MS)
    assert bench.log == [(app, "in a callback"), 20]


def test_an_external_sync_drives_a_time_base(bench: Bench) -> None:
    def sync(timebase_id: int) -> int:
        bench.os.task_delay(100)
        return 250

    timebase_id = bench.os.time_base_create("EXT", sync)
    bench.os.timer_set(bench.os.timer_add("T", timebase_id, _noter(bench)), 500, 1000)
    bench.kernel.run(until_ns=1000 * MS)
    assert bench.log == [200, 600, 1000]
    assert bench.os.time_base_get_free_run(timebase_id) == 2500
    assert bench.os.time_base_get_info(timebase_id).accuracy == 0


def test_accuracy_is_that_of_linux_then_the_interval_without_seconds(bench: Bench) -> None:
    timebase_id = bench.os.time_base_create("OWN")

    def accuracy() -> int:
        return bench.os.time_base_get_info(timebase_id).accuracy

    found = [accuracy()]
    for start, interval in ((1, 250), (1, 2_000_500), (1, 3_000_000), (700, 0)):
        bench.os.time_base_set(timebase_id, start, interval)
        found.append(accuracy())
    assert found == [10_000, 250, 500, 0, 700]
    assert bench.os.timer_get_info(bench.os.timer_create("T", _noter(bench))).accuracy == 10_000


def test_sync_that_never_waits_is_slowed_down(bench: Bench) -> None:
    calls: list[int] = []
    bench.os.time_base_create("BAD", lambda timebase_id: calls.append(bench.kernel.now) or 0)
    bench.kernel.run(until_ns=100 * MS)
    assert 10 <= len(calls) <= 20


def test_invalid_arguments_are_refused(bench: Bench, master: int) -> None:
    timer_id = bench.os.timer_add("T", master, _noter(bench))
    assert status_of(bench.os.timer_set, timer_id, 0, 0) == OS_TIMER_ERR_INVALID_ARGS
    assert status_of(bench.os.timer_set, timer_id, -1, 5) == OS_TIMER_ERR_INVALID_ARGS
    assert status_of(bench.os.timer_set, timer_id, 1 << 31, 5) == OS_TIMER_ERR_INVALID_ARGS
    assert status_of(bench.os.timer_set, 0, 1, 1) == OS_ERR_INVALID_ID
    assert status_of(bench.os.timer_add, "T", master, _noter(bench)) == OS_ERR_NAME_TAKEN
    assert status_of(bench.os.timer_add, "U", 0, _noter(bench)) == OS_ERR_INVALID_ID
    assert status_of(bench.os.timer_add, "U", master, None) == OS_INVALID_POINTER
    assert status_of(bench.os.time_base_set, master, 1_000_000_000, 1) == OS_TIMER_ERR_INVALID_ARGS
    assert status_of(bench.os.time_base_delete, master) == OS_ERR_OBJECT_IN_USE
    assert status_of(bench.os.timer_create, "cFS-Master", bool) == OS_ERR_NAME_TAKEN
    bench.os.timer_delete(timer_id)
    bench.os.time_base_delete(master)
    assert status_of(bench.os.time_base_get_info, master) == OS_ERR_INVALID_ID
    bench.kernel.run(until_ns=50 * MS)
    assert bench.log == []


def test_a_failed_timer_create_leaves_no_time_base(bench: Bench) -> None:
    bench.os.timer_create("T", bool)
    bench.os.time_base_create("OTHER")
    timer_id = bench.os.timer_get_id_by_name("T")
    bench.os.time_base_delete(bench.os.time_base_get_id_by_name("OTHER"))
    assert status_of(bench.os.timer_create, "T", bool) == OS_ERR_NAME_TAKEN
    bench.os.timer_delete(timer_id)
    assert len(bench.os._time_bases) == 0

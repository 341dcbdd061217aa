"""OS_Task*: ids, names, priorities, delays, ends and delete handlers."""

from __future__ import annotations

import pytest

from cfepy.config.platform import PlatformConfig
from cfepy.ids import OS_TASK_BASE, get_base
from cfepy.osal.tasks import TaskProperties
from cfepy.rtos import CpuCosts
from cfepy.status import (
    OS_ERR_INVALID_ARGUMENT,
    OS_ERR_INVALID_ID,
    OS_ERR_INVALID_PRIORITY,
    OS_ERR_INVALID_SIZE,
    OS_ERR_NAME_NOT_FOUND,
    OS_ERR_NAME_TAKEN,
    OS_ERR_NAME_TOO_LONG,
    OS_ERR_NO_FREE_IDS,
    OS_INVALID_POINTER,
    OsalError,
)
from tests.osal.helpers import MS, Bench


def _nothing() -> None:
    pass


def test_task_gets_its_own_id_and_name(bench: Bench) -> None:
    def body() -> tuple[int, str]:
        task_id = bench.os.task_get_id()
        return task_id, bench.os.get_resource_name(task_id)

    task_id, name = bench.run(body)
    assert get_base(task_id) == OS_TASK_BASE
    assert name == "MAIN"
    assert bench.os.task_get_id() == 0


@pytest.mark.parametrize(
    ("name", "entry", "stack", "priority", "status"),
    [
        ("A", None, 100, 1, OS_INVALID_POINTER),
        ("A" * 20, _nothing, 100, 1, OS_ERR_NAME_TOO_LONG),
        ("A", _nothing, 0, 1, OS_ERR_INVALID_SIZE),
        ("A", _nothing, 1 << 31, 1, OS_ERR_INVALID_SIZE),
        ("A", _nothing, 100, 256, OS_ERR_INVALID_PRIORITY),
        ("A", _nothing, 100, -1, OS_ERR_INVALID_PRIORITY),
        ("TAKEN", _nothing, 100, 1, OS_ERR_NAME_TAKEN),
    ],
)
def test_bad_arguments_of_task_create(
    bench: Bench, name: str, entry: object, stack: int, priority: int, status: int
) -> None:
    bench.os.task_create("TAKEN", _nothing, 100, 1)
    with pytest.raises(OsalError) as caught:
        bench.os.task_create(name, entry, stack, priority)  # type: ignore[arg-type]  # that is the point
    assert caught.value.status == status


def test_there_are_as_many_tasks_as_configured() -> None:
    bench = Bench(config=PlatformConfig(os_max_tasks=3))
    with bench.kernel:
        for number in range(3):
            bench.task(_nothing, name=f"T{number}")
        with pytest.raises(OsalError) as caught:
            bench.task(_nothing, name="T3")
        assert caught.value.status == OS_ERR_NO_FREE_IDS
        bench.kernel.run(until_ns=1)
        bench.task(_nothing, name="T3")


def test_task_get_info_and_id_by_name(bench: Bench) -> None:
    def body() -> None:
        child = bench.os.task_create("CHILD", lambda: bench.os.task_delay(1), 2048, 120)
        bench.log += [bench.os.task_get_id_by_name("CHILD") == child, bench.os.task_get_info(child)]
        bench.log.append(bench.os.task_get_id())

    bench.run(body)
    assert bench.log == [True, TaskProperties("CHILD", bench.log[2], 2048, 120), bench.log[2]]


def test_ended_task_is_unknown(bench: Bench) -> None:
    task_id = bench.task(_nothing)
    bench.kernel.run(until_ns=1)
    for call in (bench.os.task_get_info, bench.os.task_delete, bench.os.get_resource_name):
        with pytest.raises(OsalError) as caught:
            call(task_id)
        assert caught.value.status == OS_ERR_INVALID_ID
    with pytest.raises(OsalError) as caught:
        bench.os.task_get_id_by_name("_nothing")
    assert caught.value.status == OS_ERR_NAME_NOT_FOUND


def test_delay_in_virtual_milliseconds(bench: Bench) -> None:
    bench.run(lambda: (bench.os.task_delay(250), bench.log.append(bench.kernel.now)))
    assert bench.log == [250 * MS]


def test_delay_of_0_ms_lets_equal_tasks_run_and_no_less_urgent_ones(bench: Bench) -> None:
    def main() -> None:
        for turn in range(3):
            bench.log.append(turn)
            bench.os.task_delay(0)
        bench.os.task_delay(1)

    def equal() -> None:
        bench.log.append("equal")

    def lower() -> None:
        bench.log.append("lower")

    bench.task(main, 100)
    bench.task(equal, 100)
    bench.task(lower, 101)
    bench.kernel.run(until_ns=10 * MS)
    assert bench.log == [0, "equal", 1, 2, "lower"]
    assert bench.kernel.now >= 3


def test_a_negative_delay_is_refused(bench: Bench) -> None:
    with pytest.raises(OsalError) as caught:
        bench.os.task_delay(-1)
    assert caught.value.status == OS_ERR_INVALID_ARGUMENT


def test_set_priority_changes_the_running_task(bench: Bench) -> None:
    def body() -> None:
        lazy = bench.task(lambda: bench.log.append("lazy"), 200, "LAZY")
        bench.os.task_set_priority(lazy, 10)
        bench.log.append("main")

    bench.run(body)
    assert bench.log == ["lazy", "main"]


def test_delete_unwinds_the_task_and_calls_its_handler(bench: Bench) -> None:
    def victim() -> None:
        bench.os.task_install_delete_handler(lambda: bench.log.append("handler"))
        try:
            bench.os.task_delay(10_000)
        finally:
            bench.log.append("finally")

    def body() -> None:
        task_id = bench.task(victim, 50)
        bench.os.task_delete(task_id)
        bench.log.append("deleted")

    bench.run(body)
    assert bench.log == ["finally", "handler", "deleted"]


def test_task_that_deletes_itself_calls_its_handler_and_ends(bench: Bench) -> None:
    def suicide() -> None:
        bench.os.task_install_delete_handler(lambda: bench.log.append("handler"))
        bench.os.task_delete(bench.os.task_get_id())
        bench.log.append("alive")

    bench.task(suicide)
    bench.kernel.run()
    assert bench.log == ["handler"]


def test_exit_calls_no_handler(bench: Bench) -> None:
    def leaver() -> None:
        bench.os.task_install_delete_handler(lambda: bench.log.append("handler"))
        bench.os.task_exit()

    bench.task(leaver)
    bench.kernel.run()
    assert bench.log == []


def test_task_deleted_before_it_began_frees_its_name(bench: Bench) -> None:
    bench.os.task_delete(bench.task(_nothing, name="EARLY"))
    bench.task(_nothing, name="EARLY")


def test_objects_of_a_deleted_task_are_kept(bench: Bench) -> None:
    def maker() -> None:
        bench.os.queue_create("LEFT", 1, 1)
        bench.os.task_delay(1000)

    bench.run(lambda: bench.os.task_delete(bench.task(maker, 10)))
    assert bench.os.queue_get_id_by_name("LEFT")


def test_find_id_by_system_data(bench: Bench) -> None:
    task_id = bench.task(_nothing)
    assert bench.os.task_find_id_by_system_data(bench.kernel.tasks[-1]) == task_id
    with pytest.raises(OsalError) as caught:
        bench.os.task_find_id_by_system_data(bench.kernel.host)
    assert caught.value.status == OS_ERR_NAME_NOT_FOUND


def test_calls_cost_virtual_time_on_a_board() -> None:
    bench = Bench(costs=CpuCosts(call_ns=1500, byte_ps=8333))
    with bench.kernel:
        queue_id = bench.os.queue_create("Q", 2, 100)

        def body() -> int:
            before = bench.kernel.now
            bench.os.queue_put(queue_id, bytes(100))
            bench.os.queue_get(queue_id)
            return bench.kernel.now - before

        assert bench.run(body) == 2 * (1500 + 833)

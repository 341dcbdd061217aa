"""The frame around flight software: events about objects, the idle loop, the end, memory, the BSP's values."""

from __future__ import annotations

from typing import Any

from cfepy.osal.limits import (
    OS_EVENT_RESOURCE_ALLOCATED,
    OS_EVENT_RESOURCE_CREATED,
    OS_EVENT_RESOURCE_DELETED,
    OS_EVENT_TASK_STARTUP,
)
from cfepy.status import (
    OS_ERR_INCORRECT_OBJ_STATE,
    OS_ERR_INVALID_SIZE,
    OS_ERR_NOT_IMPLEMENTED,
    OS_ERR_TRY_AGAIN,
    OS_ERROR,
    OS_INVALID_POINTER,
)
from tests.osal.helpers import Bench, Ledger
from tests.osal.test_queues import status_of


def test_events_about_objects(bench: Bench) -> None:
    os = bench.os
    events: list[tuple[int, str]] = []

    def handler(event: int, object_id: int, data: Any) -> int:
        known = event != OS_EVENT_RESOURCE_DELETED
        events.append((event, os.get_resource_name(object_id) if known else ""))
        return 0

    os.register_event_handler(handler)
    os.queue_delete(os.queue_create("Q", 1, 4))
    bench.task(lambda: None, name="T")
    bench.kernel.run(until_ns=1)
    assert events == [
        (OS_EVENT_RESOURCE_ALLOCATED, "Q"),
        (OS_EVENT_RESOURCE_CREATED, "Q"),
        (OS_EVENT_RESOURCE_DELETED, ""),
        (OS_EVENT_RESOURCE_ALLOCATED, "T"),
        (OS_EVENT_RESOURCE_CREATED, "T"),
        (OS_EVENT_TASK_STARTUP, "T"),
        (OS_EVENT_RESOURCE_DELETED, ""),
    ]


def test_an_event_handler_may_refuse_an_object(bench: Bench) -> None:
    os = bench.os
    os.register_event_handler(lambda event, object_id, data: OS_ERR_TRY_AGAIN)
    assert status_of(os.bin_sem_create, "S", 0) == OS_ERR_TRY_AGAIN
    os.register_event_handler(lambda event, object_id, data: None)
    os.bin_sem_create("S", 0)
    assert status_of(os.register_event_handler, None) == OS_INVALID_POINTER


def test_the_idle_loop_lasts_until_the_shutdown(bench: Bench) -> None:
    os, log = bench.os, bench.log
    bench.task(lambda: (os.application_run(), log.append(bench.kernel.now)), name="IDLE")
    bench.task(lambda: (os.task_delay(10), os.application_shutdown(False), os.task_delay(10)), name="NO")
    bench.task(lambda: (os.task_delay(50), os.application_shutdown(True)), name="YES")
    bench.kernel.run(until_ns=1_000_000_000)
    assert log == [50_000_000]
    os.idle_loop()  # over once and for all


def test_teardown_deletes_everything(bench: Bench) -> None:
    os, log = bench.os, bench.log
    os.api_init()
    queue = os.queue_create("Q", 1, 4)
    os.task_create("OTHER", lambda: (os.task_delay(100), log.append("alive")), 4096, 10)
    bench.task(lambda: (os.task_delay(1), os.api_teardown(), log.append("torn down")), name="MAIN")
    bench.kernel.run(until_ns=1_000_000_000)
    assert log == ["torn down"]
    assert status_of(os.queue_get_info, queue)
    os.idle_loop()


def test_objects_cannot_be_made_between_a_teardown_and_an_init(bench: Bench) -> None:
    os = bench.os
    os.printf_disable()
    os.register_event_handler(lambda event, object_id, data: bench.log.append(event))
    os.api_teardown()
    del bench.log[:]
    assert status_of(os.queue_create, "Q", 1, 4) == OS_ERR_INCORRECT_OBJ_STATE
    assert status_of(os.mkfs, "/ramdev1", "RAM1", 512, 4) == OS_ERR_INCORRECT_OBJ_STATE
    os.api_init()
    assert os.queue_get_info(os.queue_create("Q", 1, 4)).name == "Q"
    assert bench.log == [], "the handler is forgotten"
    os.printf("again")
    assert os.console.lines[-1] == "again"


def test_file_systems_are_removed_by_a_new_init(bench: Bench) -> None:
    os = bench.os
    os.api_teardown()
    assert os.files.mount_points()
    os.api_init()
    assert not os.files.mount_points()
    os.mkfs("/ramdev0", "RAM", 512, 4)


def test_application_exit_does_not_return(bench: Bench) -> None:
    os, log = bench.os, bench.log
    bench.task(lambda: (os.task_delay(5), os.application_exit(-1), log.append("back")), name="T")
    bench.kernel.run(until_ns=1_000_000_000)
    assert (log, bench.kernel.now, os.exit_code) == ([], 5_000_000, 1)
    os.application_exit(0)
    assert os.exit_code == 0


def test_heap_info_is_the_free_memory_of_the_board() -> None:
    os = Bench(memory=Ledger(free=5000)).os
    assert os.heap_get_info() == (5000, 1, 5000)
    os.mkfs("/ramdev1", "RAM1", 1000, 5)
    assert os.heap_get_info() == (0, 0, 0)


def test_heap_info_is_not_implemented_on_a_board_without_limits(bench: Bench) -> None:
    assert status_of(bench.os.heap_get_info) == OS_ERR_NOT_IMPLEMENTED


def test_values_of_the_board_support(bench: Bench) -> None:
    os = bench.os
    assert (os.bsp_get_argc(), os.bsp_get_argv()) == (1, ("core-cpu1",))
    assert os.bsp_get_resource_type_config(1) == 0
    os.bsp_set_resource_type_config(1, 0x30)
    assert os.bsp_get_resource_type_config(1) == 0x30
    os.bsp_set_exit_code(7)
    assert os.exit_code == 7


def test_the_name_of_the_computer(bench: Bench) -> None:
    os = bench.os
    assert (os.network_get_id(), os.network_get_host_name(), os.network_get_host_name(5)) == (1, "cpu1", "cpu1")
    assert status_of(os.network_get_host_name, 0) == OS_ERR_INVALID_SIZE
    assert status_of(os.network_get_host_name, 4) == OS_ERROR


def test_strnlen(bench: Bench) -> None:
    assert [bench.os.strnlen(text, 4) for text in (b"ab\0c", b"abcdef", b"", b"abc\0de")] == [2, 4, 0, 3]

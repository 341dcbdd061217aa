"""OS_Queue*: order, limits, time-outs and deletion."""

from __future__ import annotations

import pytest

from cfepy.osal.limits import OS_CHECK, OS_PEND
from cfepy.status import (
    OS_ERR_INVALID_ID,
    OS_ERR_INVALID_SIZE,
    OS_ERR_NAME_NOT_FOUND,
    OS_ERR_NAME_TAKEN,
    OS_ERR_NAME_TOO_LONG,
    OS_ERR_NO_FREE_IDS,
    OS_ERROR,
    OS_QUEUE_FULL,
    OS_QUEUE_INVALID_SIZE,
)
from tests.osal.helpers import MS, Bench
from tests.statuses import status_of


def test_messages_are_read_in_order(bench: Bench) -> None:
    queue_id = bench.os.queue_create("Q", 3, 8)
    for text in (b"a", b"bb", b"ccc"):
        bench.os.queue_put(queue_id, text)
    assert [bench.os.queue_get(queue_id, OS_CHECK) for _ in range(4)] == [b"a", b"bb", b"ccc", None]


def test_a_put_never_waits(bench: Bench) -> None:
    queue_id = bench.os.queue_create("Q", 1, 8)
    bench.os.queue_put(queue_id, b"a")
    assert status_of(bench.os.queue_put, queue_id, b"b") == OS_QUEUE_FULL
    assert bench.os.queue_get(queue_id) == b"a"


def test_changed_buffer_does_not_change_the_message(bench: Bench) -> None:
    queue_id = bench.os.queue_create("Q", 1, 8)
    buffer = bytearray(b"old")
    bench.os.queue_put(queue_id, buffer)
    buffer[:] = b"new"
    assert bench.os.queue_get(queue_id) == b"old"


def test_bad_arguments(bench: Bench) -> None:
    create = bench.os.queue_create
    queue_id = create("Q", 1, 4)
    assert status_of(create, "Q" * 20, 1, 4) == OS_ERR_NAME_TOO_LONG
    assert status_of(create, "Q", 1, 4) == OS_ERR_NAME_TAKEN
    assert status_of(create, "R", 1, 0) == OS_ERR_INVALID_SIZE
    assert status_of(create, "R", 51, 4) == OS_QUEUE_INVALID_SIZE
    assert status_of(create, "Q", 0, 4) == OS_ERR_NAME_TAKEN
    assert status_of(create, "R", 0, 4) == OS_ERROR
    assert status_of(bench.os.queue_put, queue_id, b"12345") == OS_QUEUE_INVALID_SIZE
    assert status_of(bench.os.queue_put, queue_id, b"") == OS_ERR_INVALID_SIZE
    assert status_of(bench.os.queue_put, 0, b"1") == OS_ERR_INVALID_ID
    assert status_of(bench.os.queue_get, queue_id + 1) == OS_ERR_INVALID_ID
    assert status_of(bench.os.queue_get, queue_id, 0, 3) == OS_QUEUE_INVALID_SIZE
    assert bench.os.queue_get(queue_id, 0, size=4) is None
    assert status_of(bench.os.queue_get_id_by_name, "R") == OS_ERR_NAME_NOT_FOUND
    assert status_of(bench.os.queue_get_info, 0x10001) == OS_ERR_INVALID_ID


def test_queue_refused_by_the_system_uses_up_an_id(bench: Bench) -> None:
    first = bench.os.queue_create("Q", 1, 1)
    status_of(bench.os.queue_create, "R", 51, 1)
    status_of(bench.os.queue_create, "R", 0, 1)
    assert bench.os.queue_create("R", 1, 1) == first + 2


def test_there_are_as_many_queues_as_configured(bench: Bench) -> None:
    for number in range(bench.os.config.os_max_queues):
        bench.os.queue_create(f"Q{number}", 1, 1)
    assert status_of(bench.os.queue_create, "ONE_MORE", 1, 1) == OS_ERR_NO_FREE_IDS


def test_id_of_a_deleted_queue_is_not_reused_at_once(bench: Bench) -> None:
    first = bench.os.queue_create("Q", 1, 1)
    bench.os.queue_delete(first)
    assert bench.os.queue_create("Q", 1, 1) != first


@pytest.mark.parametrize(("timeout_ms", "elapsed_ms"), [(OS_CHECK, 0), (1, 1), (250, 250)])
def test_time_outs(bench: Bench, timeout_ms: int, elapsed_ms: int) -> None:
    queue_id = bench.os.queue_create("Q", 1, 1)

    def body() -> tuple[bytes | None, int]:
        return bench.os.queue_get(queue_id, timeout_ms), bench.kernel.now

    assert bench.run(body) == (None, elapsed_ms * MS)


def test_pending_reader_gets_a_later_message(bench: Bench) -> None:
    queue_id = bench.os.queue_create("Q", 1, 4)

    def writer() -> None:
        bench.os.task_delay(5000)
        bench.os.queue_put(queue_id, b"late")

    bench.task(writer)
    assert bench.run(lambda: (bench.os.queue_get(queue_id, OS_PEND), bench.kernel.now)) == (b"late", 5000 * MS)


def test_deleted_queue_wakes_its_readers_with_an_error_in_a_safe_mission(safe_bench: Bench) -> None:
    queue_id = safe_bench.os.queue_create("Q", 1, 4)

    def deleter() -> None:
        safe_bench.os.task_delay(5)
        safe_bench.os.queue_delete(queue_id)

    safe_bench.task(deleter)
    assert safe_bench.run(lambda: status_of(safe_bench.os.queue_get, queue_id, OS_PEND)) == OS_ERR_INVALID_ID


def test_info_names_the_creator(bench: Bench) -> None:
    def body() -> tuple[object, int]:
        return bench.os.queue_get_info(bench.os.queue_create("Q", 1, 1)), bench.os.task_get_id()

    info, creator = bench.run(body)
    assert info == ("Q", creator)

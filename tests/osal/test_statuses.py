"""The statuses that the public unit tests of NASA's OSAL require of every kind of object, and of single functions."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import pytest

from cfepy.osal import Osal
from cfepy.status import (
    OS_ERR_INCORRECT_OBJ_STATE,
    OS_ERR_INVALID_ID,
    OS_ERR_INVALID_SIZE,
    OS_ERR_NAME_NOT_FOUND,
    OS_ERR_NAME_TAKEN,
    OS_ERR_NAME_TOO_LONG,
    OS_ERR_NO_FREE_IDS,
    OS_INVALID_POINTER,
    OS_QUEUE_FULL,
    OS_QUEUE_INVALID_SIZE,
    OS_TIMER_ERR_INVALID_ARGS,
)
from tests.osal.helpers import Bench
from tests.osal.test_queues import status_of

Make = Callable[[Osal, str], int]
NO_IDS = (0, 0xFFFFFFFF, 0x00050123)  # undefined, incorrect, and of a file


class Family(NamedTuple):
    """One kind of object: how its functions begin, how one is made, and how many there can be."""

    prefix: str
    make: Make
    most: int
    others: tuple[str, ...] = ()  # functions of one argument, the id

    def function(self, os: Osal, name: str) -> Callable[..., object]:
        """One of its functions."""
        found: Callable[..., object] = getattr(os, f"{self.prefix}_{name}")
        return found


def _timer(os: Osal, name: str) -> int:
    base = os.time_base_create("BASE") if "BASE" not in _names(os) else os.time_base_get_id_by_name("BASE")
    return os.timer_add(name, base, lambda timer_id, argument: None)


def _names(os: Osal) -> list[str]:
    found: list[str] = []
    os.for_each_object(0, lambda object_id, argument: found.append(os.get_resource_name(object_id)))
    return found


FAMILIES = [
    Family("task", lambda os, name: os.task_create(name, lambda: os.task_delay(1000), 4096, 100), 64),
    Family("queue", lambda os, name: os.queue_create(name, 10, 4), 64),
    Family(
        "bin_sem",
        lambda os, name: os.bin_sem_create(name, 1),
        20,
        ("bin_sem_give", "bin_sem_take", "bin_sem_flush"),
    ),
    Family("count_sem", lambda os, name: os.count_sem_create(name, 1), 20, ("count_sem_give", "count_sem_take")),
    Family("mut_sem", lambda os, name: os.mut_sem_create(name), 20, ("mut_sem_give", "mut_sem_take")),
    Family("cond_var", lambda os, name: os.cond_var_create(name), 4, ("cond_var_lock", "cond_var_signal")),
    Family("rw_lock", lambda os, name: os.rw_lock_create(name), 20, ("rw_lock_read_take", "rw_lock_write_give")),
    Family("time_base", lambda os, name: os.time_base_create(name), 5, ("time_base_get_free_run",)),
    Family("timer", _timer, 10),
]
each_family = pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.prefix)


@each_family
def test_names(bench: Bench, family: Family) -> None:
    os = bench.os
    by_name = family.function(os, "get_id_by_name")
    made = family.make(os, "DUPLICATE")
    assert by_name("DUPLICATE") == made
    assert os.get_resource_name(made) == "DUPLICATE"
    assert status_of(family.make, os, "DUPLICATE") == OS_ERR_NAME_TAKEN
    assert status_of(family.make, os, "n" * 20) == OS_ERR_NAME_TOO_LONG
    assert status_of(by_name, "n" * 20) == OS_ERR_NAME_TOO_LONG
    assert status_of(by_name, "NotFound") == OS_ERR_NAME_NOT_FOUND
    assert by_name("DUPLICATE") == family.make(os, "n" * 19) - 1


@each_family
def test_ids(bench: Bench, family: Family) -> None:
    os = bench.os
    made = family.make(os, "Good")
    family.function(os, "get_info")(made)
    family.function(os, "delete")(made)
    functions = [family.function(os, name) for name in ("delete", "get_info")]
    for function in functions + [getattr(os, name) for name in family.others]:
        for bad in (made, *NO_IDS):
            assert status_of(function, bad) == OS_ERR_INVALID_ID


@each_family
def test_number_of_objects_is_limited(bench: Bench, family: Family) -> None:
    for number in range(family.most):
        family.make(bench.os, f"N{number}")
    assert status_of(family.make, bench.os, "OneTooMany") == OS_ERR_NO_FREE_IDS
    family.function(bench.os, "delete")(family.function(bench.os, "get_id_by_name")("N0"))
    family.make(bench.os, "Good")


def test_queues(bench: Bench) -> None:
    os = bench.os
    queue = os.queue_create("Q", 2, 4)
    assert status_of(os.queue_create, "X", 10, 0) == OS_ERR_INVALID_SIZE
    assert status_of(os.queue_create, "X", 51, 4) == OS_QUEUE_INVALID_SIZE
    assert status_of(os.queue_put, queue, b"12345") == OS_QUEUE_INVALID_SIZE
    assert status_of(os.queue_put, queue, b"") == OS_ERR_INVALID_SIZE
    os.queue_put(queue, b"1234")
    os.queue_put(queue, b"1234")
    assert status_of(os.queue_put, queue, b"1234") == OS_QUEUE_FULL


def test_timers_and_time_bases(bench: Bench) -> None:
    os = bench.os
    base = os.time_base_create("BASE")
    timer = os.timer_add("TIMER", base, lambda timer_id, argument: None)
    os.time_base_set(base, 0, 0)
    for start, interval in ((1 << 32, 1 << 32), (-1000, -1000), (1000, -1000), (-1000, 1000)):
        assert status_of(os.time_base_set, base, start, interval) == OS_TIMER_ERR_INVALID_ARGS
    assert status_of(os.timer_set, timer, 0, 0) == OS_TIMER_ERR_INVALID_ARGS
    for bad in NO_IDS:
        assert status_of(os.timer_set, bad, 10, 10) == OS_ERR_INVALID_ID
        assert status_of(os.time_base_set, bad, 10, 10) == OS_ERR_INVALID_ID
        assert status_of(os.timer_add, "T", bad, lambda timer_id, argument: None) == OS_ERR_INVALID_ID
    assert status_of(os.timer_add, "T", base, None) == OS_INVALID_POINTER


def test_time_bases_cannot_be_managed_from_a_sync_function(bench: Bench) -> None:
    os = bench.os
    seen: list[int] = []

    def sync(base_id: int) -> int:
        if not seen:
            seen.extend(
                (
                    status_of(os.time_base_create, "X"),
                    status_of(os.time_base_delete, base_id),
                    status_of(os.time_base_set, base_id, 100, 100),
                    status_of(os.time_base_get_id_by_name, "BASE"),
                    status_of(os.time_base_get_info, base_id),
                )
            )
        bench.kernel.delay(1_000_000)
        return 1000

    os.time_base_create("BASE", sync)
    bench.kernel.run(until_ns=5_000_000)
    assert seen == [OS_ERR_INCORRECT_OBJ_STATE] * 5


@pytest.mark.parametrize("function", ["object_id_to_array_index", "convert_to_array_index", "get_resource_name"])
def test_unknown_ids_are_refused(bench: Bench, function: str) -> None:
    kind = (1,) if function == "object_id_to_array_index" else ()
    for bad in (0, 0xFFFFFFFF):
        assert status_of(getattr(bench.os, function), *kind, bad) == OS_ERR_INVALID_ID
    queue = bench.os.queue_create("Q", 1, 4)
    assert status_of(bench.os.object_id_to_array_index, 1, queue) == OS_ERR_INVALID_ID


def test_functions_for_tasks_are_refused_elsewhere(bench: Bench) -> None:
    assert status_of(bench.os.task_install_delete_handler, lambda: None) == OS_ERR_INVALID_ID
    assert status_of(bench.os.task_create, "T", None, 4096, 100) == OS_INVALID_POINTER
    assert status_of(bench.os.task_create, "T", lambda: None, 0, 100) == OS_ERR_INVALID_SIZE
    for bad in NO_IDS:
        assert status_of(bench.os.task_set_priority, bad, 100) == OS_ERR_INVALID_ID

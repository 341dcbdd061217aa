"""Ids of any kind, error names, OS_printf, and the clean-up after an application."""

from __future__ import annotations

import pytest

from cfepy.ids import OS_MUTEX_BASE, OS_QUEUE_BASE, OS_TASK_BASE
from cfepy.osal import OS_FILE_FLAG_CREATE, OS_WRITE_ONLY, Osal
from cfepy.rtos import Kernel
from cfepy.status import OS_ERR_INVALID_ID, OS_QUEUE_FULL, OS_SEM_FAILURE
from tests.osal.helpers import Bench
from tests.osal.test_queues import status_of


class App:
    """Stands for an application."""

    def __init__(self, name: str) -> None:
        self.name = name


def test_identify_and_index(bench: Bench) -> None:
    ids = [bench.os.queue_create(f"Q{number}", 1, 1) for number in range(3)]
    assert {bench.os.identify_object(queue_id) for queue_id in ids} == {OS_QUEUE_BASE}
    assert len({bench.os.convert_to_array_index(queue_id) for queue_id in ids}) == 3
    assert all(0 <= bench.os.convert_to_array_index(queue_id) < bench.os.config.os_max_queues for queue_id in ids)
    assert bench.os.object_id_to_array_index(OS_QUEUE_BASE, ids[0]) == bench.os.convert_to_array_index(ids[0])
    assert status_of(bench.os.object_id_to_array_index, OS_TASK_BASE, ids[0]) == OS_ERR_INVALID_ID
    assert status_of(bench.os.convert_to_array_index, 0) == OS_ERR_INVALID_ID
    assert bench.os.identify_object(0x110001) == 0x11
    assert bench.os.identify_object(0) == 0


def test_names_of_objects(bench: Bench) -> None:
    assert bench.os.get_resource_name(bench.os.mut_sem_create("M")) == "M"
    bench.os.mkdir("/cf/folder")
    file = bench.os.open_create("/cf/a.txt", OS_FILE_FLAG_CREATE, OS_WRITE_ONLY)
    assert bench.os.get_resource_name(file) == "/cf/a.txt"
    assert bench.os.get_resource_name(bench.os.directory_open("/cf/folder")) == "/cf/folder"
    assert status_of(bench.os.get_resource_name, 0) == OS_ERR_INVALID_ID
    assert status_of(bench.os.get_resource_name, OS_MUTEX_BASE << 16 | 9) == OS_ERR_INVALID_ID


def test_id_helpers(bench: Bench) -> None:
    assert bench.os.object_id_defined(5)
    assert not bench.os.object_id_defined(0)
    assert bench.os.object_id_equal(5, bench.os.object_id_from_integer(bench.os.object_id_to_integer(5)))


def test_for_each_object(bench: Bench) -> None:
    def body() -> int:
        bench.os.queue_create("MINE", 1, 1)
        bench.os.mut_sem_create("MINE")
        return bench.os.task_get_id()

    bench.os.queue_create("HOSTS", 1, 1)
    creator = bench.run(body)
    mine: list[str] = []
    everything: list[str] = []
    bench.os.for_each_object(creator, lambda object_id, into: into.append(bench.os.get_resource_name(object_id)), mine)
    bench.os.for_each_object(0, lambda object_id, into: into.append(bench.os.get_resource_name(object_id)), everything)
    assert mine == ["MINE", "MINE"]
    assert sorted(everything) == ["", "/cf", "/ramdev0", "HOSTS", "MINE", "MINE"]  # the console has no name


@pytest.mark.parametrize(
    ("status", "name"), [(0, "OS_SUCCESS"), (OS_QUEUE_FULL, "OS_QUEUE_FULL"), (-999, "OS_UNKNOWN(-999)")]
)
def test_error_names(bench: Bench, status: int, name: str) -> None:
    assert bench.os.get_error_name(status) == name


def test_printf(bench: Bench) -> None:
    bench.os.printf("one\n")
    bench.os.printf_disable()
    bench.os.printf("two")
    bench.os.printf_enable()
    bench.os.printf("x" * 500)
    assert bench.console.lines == ["one", "x" * 171]


def test_pieces_are_cut_and_lines_are_not(bench: Bench) -> None:
    for each in ("a" * 500, "é" * 100):
        bench.os.printf_piece(each)
    bench.os.printf_disable()
    bench.os.printf_piece("\n")
    bench.os.printf_enable()
    assert bench.console.lines == []
    bench.os.printf_piece("\ntwo\nthr")
    bench.os.printf_piece("ee\n")
    cut = b"\xc3".decode("utf-8", "surrogateescape")
    assert bench.console.lines == ["a" * 171 + "é" * 85 + cut, "two", "three"]


def test_version(bench: Bench) -> None:
    assert bench.os.get_version_string() == "v7.0.0+dev0"
    assert bench.os.get_version_code_name() == "Draco"
    assert bench.os.get_version_number() == (7, 0, 0, 0)
    assert bench.os.get_build_number() == 0


def test_an_application_leaves_nothing_behind_in_a_safe_mission(safe_bench: Bench) -> None:
    app, other = App("APP"), App("OTHER")
    os = safe_bench.os
    master = os.time_base_create("cFS-Master")

    def make_everything() -> None:
        name = safe_bench.kernel.current.name
        os.queue_create(name, 1, 1)
        os.bin_sem_create(name, 0)
        os.count_sem_create(name, 0)
        os.mut_sem_take(os.mut_sem_create(name))
        os.cond_var_create(name)
        os.rw_lock_create(name)
        os.timer_create(f"{name}_OWN", bool)
        os.timer_add(name, master, lambda *_: None)
        os.files.write_file(f"/ram/{name}", b"")
        os.open_create(f"/ram/{name}")
        os.directory_open("/ram")
        os.task_delay(10_000)

    def main() -> None:
        safe_bench.task(make_everything, name="CHILD")
        make_everything()

    safe_bench.task(main, name="APP", owner=app)
    safe_bench.task(make_everything, name="OTHER", owner=other)
    safe_bench.kernel.run(until_ns=1)
    assert os.delete_objects_of(app) == []
    left: list[str] = []
    os.for_each_object(0, lambda object_id, _: left.append(os.get_resource_name(object_id)))
    assert set(left) == {
        "/ram/OTHER",
        "/ram",
        "OTHER",
        "OTHER_OWN",
        "cFS-Master",
        "/cf",
        "/ramdev0",
        "",
    }
    assert (left.count("/ram/OTHER"), left.count("/ram")) == (1, 1)  # of others, open
    assert {task.name for task in safe_bench.kernel.tasks} == {"OTHER", "OTHER_OWN", "cFS-Master"}
    assert os.files.exists("/ram/APP")


def test_object_that_cannot_be_deleted_is_reported(bench: Bench) -> None:
    app = App("APP")

    def borrower() -> None:
        bench.os.task_delay(1)
        bench.os.mut_sem_take(bench.os.mut_sem_get_id_by_name("LENT"))
        bench.os.task_delay(10_000)

    bench.task(lambda: (bench.os.mut_sem_create("LENT"), bench.os.task_delay(10_000)), name="LENDER", owner=app)
    bench.task(borrower)
    bench.kernel.run(until_ns=5_000_000)
    leftovers = {(left.object_id, left.error.status) for left in bench.os.delete_objects_of(app)}
    assert leftovers == {(bench.os.mut_sem_get_id_by_name("LENT"), OS_SEM_FAILURE)}


def test_caller_survives_its_own_cleanup(bench: Bench) -> None:
    app = App("APP")

    def body() -> None:
        bench.os.queue_create("Q", 1, 1)
        bench.os.delete_objects_of(app)
        bench.log.append(bench.os.task_get_id_by_name("APP") == bench.os.task_get_id())

    bench.task(body, name="APP", owner=app)
    bench.kernel.run()
    assert bench.log == [True]


def test_delete_all_objects(bench: Bench) -> None:
    bench.os.timer_create("T", bool)
    bench.os.queue_create("Q", 1, 1)
    bench.task(lambda: bench.os.task_delay(1))
    bench.kernel.run(until_ns=1)
    bench.os.delete_all_objects()
    assert not bench.kernel.tasks


def test_an_osal_needs_only_a_kernel() -> None:
    with Kernel("thread") as kernel:
        assert Osal(kernel).queue_create("Q", 1, 1)

"""Requests of applications to Executive Services, each behaviour in a booted mission."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from cfepy.app import Cfe
from cfepy.es.packets import RESTART_APP as RESTART_APP_COMMAND
from cfepy.es.records import APP_ERROR, APP_RUN, LATE_INIT, RUNNING, SYS_RESTART, SYSTEM_OPERATIONAL
from cfepy.status import (
    CFE_ES_BAD_ARGUMENT,
    CFE_ES_BUFFER_NOT_IN_POOL,
    CFE_ES_ERR_CHILD_TASK_CREATE,
    CFE_ES_ERR_CHILD_TASK_DELETE_MAIN_TASK,
    CFE_ES_ERR_DUPLICATE_NAME,
    CFE_ES_ERR_MEM_BLOCK_SIZE,
    CFE_ES_ERR_NAME_NOT_FOUND,
    CFE_ES_ERR_RESOURCEID_NOT_VALID,
    CFE_ES_POOL_BLOCK_INVALID,
    CFE_STATUS_EXTERNAL_RESOURCE_FAIL,
    CfeError,
)
from cfepy.units import NS_PER_S
from tests.es.harness import Lab

Result = dict[str, Any]


@pytest.fixture
def make_lab(tmp_path: Path) -> Iterator[Callable[..., Lab]]:
    labs: list[Lab] = []

    def make(tasks: str = "thread", **mains: Any) -> Lab:
        labs.append(Lab(tmp_path, tasks, **mains))
        return labs[-1]

    yield make
    for lab in labs:
        lab.mission.close()


def status_of(call: Callable[[], object]) -> int:
    try:
        call()
    except CfeError as error:
        return error.status
    return 0


def test_app_is_running_once_it_calls_run_loop(make_lab: Callable[..., Lab]) -> None:
    def one(cfe: Cfe) -> None:
        states.append(cfe.es.calling_app().state)
        while cfe.es.run_loop():
            states.append(cfe.es.calling_app().state)
            cfe.os.task_delay(100)

    states: list[int] = []
    lab = make_lab(one=one)
    lab.start("one")
    lab.mission.run_for(0.3)
    assert states == [1, RUNNING, RUNNING, RUNNING]
    app_id = lab.es.get_app_id_by_name("ONE")
    assert lab.es.get_app_info(app_id).execution_counter == 3
    assert lab.es.get_app_name(app_id) == "ONE"


@pytest.mark.parametrize("status", [0, 2, 3, 99])
def test_run_loop_with_another_status_returns_false(make_lab: Callable[..., Lab], status: int) -> None:
    def one(cfe: Cfe) -> None:
        answers.append(cfe.es.run_loop(status))
        answers.append(cfe.es.calling_app().state)

    answers: list[object] = []
    lab = make_lab(one=one)
    lab.start("one")
    lab.mission.run_for(0.2)
    assert answers == [False, 1]


def test_a_restart_request_ends_the_loop(make_lab: Callable[..., Lab]) -> None:
    def one(cfe: Cfe) -> None:
        starts.append(cfe.es.get_app_id())
        while cfe.es.run_loop(APP_RUN):
            cfe.os.task_delay(100)
        requests.append(cfe.es.control_request())
        cfe.es.exit_app(APP_ERROR)

    starts: list[int] = []
    requests: list[int] = []
    lab = make_lab(one=one)
    first = lab.start("one")
    lab.mission.run_for(1)
    lab.es.restart_app(first)
    lab.mission.run_for(8)
    assert requests == [SYS_RESTART]
    assert len(starts) == 2
    assert starts[1] > first
    assert f"Restart Application ONE Completed, AppID={starts[1]}" in lab.log()
    assert status_of(lambda: lab.es.get_app_name(first)) == CFE_ES_ERR_RESOURCEID_NOT_VALID


def test_ending_of_an_app_takes_as_long_as_on_nasas_cfe(make_lab: Callable[..., Lab]) -> None:
    """NASA's cFE took 6.2497 s and 6.2494 s from the command to the start; 5 s of it are the kill timeout."""

    def one(cfe: Cfe) -> None:
        starts.append(cfe.es.kernel.now / NS_PER_S)
        while cfe.es.run_loop():
            cfe.os.task_delay(50)
        cfe.es.exit_app()

    starts: list[float] = []
    lab = make_lab(one=one)
    lab.start("one")
    lab.mission.run_for(2.3)
    commanded = lab.es.kernel.now / NS_PER_S
    lab.cfe.sb.transmit_msg(RESTART_APP_COMMAND.packet(Application="ONE"))
    lab.mission.run_for(8)
    assert starts[1] - commanded == pytest.approx(6.25 + 0.05, abs=0.005)  # a task starts 50 ms after its creation


def test_control_of_core_and_unknown_apps_is_refused(make_lab: Callable[..., Lab]) -> None:
    lab = make_lab(idle=lambda cfe: cfe.os.task_delay(100_000))
    app_id = lab.start("idle")
    lab.mission.run_for(1)
    evs = lab.es.get_app_id_by_name("CFE_EVS")
    for control in (lab.es.restart_app, lab.es.delete_app):
        for one in (app_id, evs, 0x110099):  # the first never reached its run loop
            assert status_of(lambda: control(one)) == CFE_ES_ERR_RESOURCEID_NOT_VALID  # noqa: B023
    assert "CFE_ES_LockUserAppRecord: Cannot Restart Application IDLE, It is not running." in lab.log()
    assert "CFE_ES_LockUserAppRecord: Cannot Delete a CORE Application: CFE_EVS." in lab.log()
    assert "CFE_ES_LockUserAppRecord: Invalid Application ID received for Delete, AppID = 1114265" in lab.log()


def test_invalid_starts_of_apps_are_refused(make_lab: Callable[..., Lab]) -> None:
    lab = make_lab(idle=lambda cfe: cfe.os.task_delay(100_000))
    lab.start("idle")
    assert status_of(lambda: lab.start("idle")) == CFE_ES_ERR_DUPLICATE_NAME
    assert status_of(lambda: lab.start("missing")) == CFE_STATUS_EXTERNAL_RESOURCE_FAIL
    assert status_of(lambda: lab.start("n" * 20)) == CFE_ES_BAD_ARGUMENT
    assert "CFE_ES_LoadModule: Could not load file:/cf/missing.so. EC = -1" in lab.log()


def test_id_of_an_app_or_library_that_fails_is_used_up(make_lab: Callable[..., Lab]) -> None:
    lab = make_lab(idle=lambda cfe: cfe.os.task_delay(100_000), lib=lambda cfe: 0, bad=lambda cfe: -1)
    assert status_of(lambda: lab.start("missing")) == CFE_STATUS_EXTERNAL_RESOURCE_FAIL
    assert status_of(lambda: lab.es.load_library("BAD", "/cf/bad.so", "init")) == -1
    assert lab.start("idle") == 0x110007  # after five core applications and one that failed
    assert lab.es.load_library("LIB", "/cf/lib.so", "init") == 0x120002
    assert len(lab.es.apps) == 6
    assert len(lab.es.libs) == 1


def test_child_tasks(make_lab: Callable[..., Lab]) -> None:
    def child(cfe: Cfe) -> None:
        seen["owner"] = cfe.es.get_app_name(cfe.es.get_app_id())
        seen["begun_at"] = cfe.es.kernel.now
        seen["grandchild"] = status_of(lambda: cfe.es.create_child_task("TOO_DEEP", print, 4096, 60))
        cfe.es.exit_child_task()

    def one(cfe: Cfe) -> None:
        cfe.es.run_loop()
        seen["created_at"] = cfe.es.kernel.now
        task_id = cfe.es.create_child_task("CHILD", lambda: child(cfe), 4096, 60)
        seen["name"] = cfe.es.get_task_name(task_id)
        seen["info"] = cfe.es.get_task_info(task_id)
        cfe.os.task_delay(200)
        seen["gone"] = status_of(lambda: cfe.es.get_task_name(task_id))
        nameless = cfe.es.create_child_task("", lambda: cfe.os.task_delay(10**6), 4096, 60)
        seen["nameless"] = cfe.es.get_task_name(nameless)
        seen["second nameless"] = status_of(lambda: cfe.es.create_child_task("", print, 4096, 60))
        seen["no name"] = status_of(lambda: cfe.es.create_child_task(None, print, 4096, 60))  # type: ignore[arg-type]
        sleeper = cfe.es.create_child_task("SLEEPER", lambda: cfe.os.task_delay(10**6), 4096, 60)
        cfe.os.task_delay(100)
        cfe.es.delete_child_task(sleeper)
        seen["deleted"] = status_of(lambda: cfe.es.get_task_name(sleeper))
        seen["main"] = status_of(lambda: cfe.es.delete_child_task(cfe.es.get_task_id()))
        cfe.os.task_delay(10**6)

    seen: Result = {}
    lab = make_lab(one=one)
    lab.start("one")
    lab.mission.run_for(2)
    assert seen["owner"] == "ONE"
    assert seen["name"] == "CHILD"
    assert seen["begun_at"] - seen["created_at"] == 50_000_000
    assert (seen["info"].app_name, seen["info"].priority, seen["info"].stack_size) == ("ONE", 60, 4096)
    assert seen["grandchild"] == CFE_ES_ERR_CHILD_TASK_CREATE
    assert seen["gone"] == seen["deleted"] == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert seen["main"] == CFE_ES_ERR_CHILD_TASK_DELETE_MAIN_TASK
    assert (seen["nameless"], seen["second nameless"]) == ("", CFE_STATUS_EXTERNAL_RESOURCE_FAIL)
    assert seen["no name"] == CFE_ES_BAD_ARGUMENT
    assert "CFE_ES_CreateChildTask: Error: Cannot call from a Child Task (for Task 'TOO_DEEP')." in lab.log()


def test_waiting_for_a_system_state(make_lab: Callable[..., Lab]) -> None:
    def one(cfe: Cfe) -> None:
        cfe.es.wait_for_system_state(SYSTEM_OPERATIONAL, 1000)
        seen.append(cfe.es.calling_app().state)
        begin = cfe.es.kernel.now
        cfe.es.wait_for_startup_sync(100)
        cfe.es.system_state = LATE_INIT
        cfe.es.wait_for_startup_sync(120)
        seen.append((cfe.es.kernel.now - begin) // 10**6)

    seen: list[int] = []
    lab = make_lab(one=one)
    lab.start("one")
    lab.mission.run_for(1)
    assert seen == [RUNNING, 120]


def test_memory_pools(make_lab: Callable[..., Lab]) -> None:
    def one(cfe: Cfe) -> None:
        es = cfe.es
        pool, other = es.pool_create(600), es.pool_create(600)
        block = es.get_pool_buf(pool, 100)
        seen["size"] = len(block.memory)
        seen["too_big"] = status_of(lambda: es.get_pool_buf(pool, 100_000))
        seen["full"] = [status_of(lambda: es.get_pool_buf(pool, 100)) for _ in range(4)]
        seen["foreign"] = status_of(lambda: es.put_pool_buf(other, block))
        seen["given"] = es.put_pool_buf(pool, block)
        seen["twice"] = status_of(lambda: es.put_pool_buf(pool, block))
        seen["again"] = status_of(lambda: es.get_pool_buf(pool, 128))
        seen["stats"] = es.get_mem_pool_stats(pool)
        seen["bad"] = status_of(lambda: es.get_mem_pool_stats(pool + 7))
        es.pool_delete(other)
        cfe.os.task_delay(10**6)

    seen: Result = {}
    lab = make_lab(one=one)
    booked = lab.mission.memory.used
    lab.start("one")
    lab.mission.run_for(1)
    assert seen["size"] == seen["given"] == 100
    assert seen["too_big"] == CFE_ES_ERR_MEM_BLOCK_SIZE
    assert seen["full"] == [0, 0, CFE_ES_ERR_MEM_BLOCK_SIZE, CFE_ES_ERR_MEM_BLOCK_SIZE]
    assert seen["foreign"] == CFE_ES_BUFFER_NOT_IN_POOL
    assert seen["twice"] == CFE_ES_POOL_BLOCK_INVALID
    assert seen["again"] == 0
    assert seen["bad"] == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert seen["stats"]["CheckErrCtr"] == 1
    assert lab.mission.memory.used == booked + 600 + 8192


def test_unknown_names_are_not_found(make_lab: Callable[..., Lab]) -> None:
    lab = make_lab()
    for look_up in (lab.es.get_app_id_by_name, lab.es.get_task_id_by_name, lab.es.get_lib_id_by_name):
        assert status_of(lambda: look_up("NOBODY")) == CFE_ES_ERR_NAME_NOT_FOUND  # noqa: B023
    assert lab.es.get_task_name(lab.es.get_task_id_by_name("ES_BG_TASK")) == "ES_BG_TASK"


def test_libraries(make_lab: Callable[..., Lab]) -> None:
    lab = make_lab(good=lambda cfe: 0, bad=lambda cfe: -5)
    lib_id = lab.es.load_library("GOOD_LIB", "/cf/good.so", "init")
    assert lab.es.get_lib_name(lib_id) == "GOOD_LIB"
    assert status_of(lambda: lab.es.load_library("BAD_LIB", "/cf/bad.so", "init")) == -5
    assert status_of(lambda: lab.es.load_library("GOOD_LIB", "/cf/good.so", "init")) == CFE_ES_ERR_DUPLICATE_NAME
    assert status_of(lambda: lab.es.load_library("CFE_ES", "/cf/good.so", "init")) == CFE_ES_ERR_DUPLICATE_NAME
    assert "CFE_ES_LoadLibrary: Load Shared Library Init Error = 0xfffffffb" in lab.log()
    assert len(lab.es.libs) == 1


def test_death_of_a_child_task_restarts_its_app(make_lab: Callable[..., Lab]) -> None:
    def child() -> None:
        raise RuntimeError("child")

    def one(cfe: Cfe) -> None:
        cfe.es.create_child_task("CHILD", child, 4096, 60)
        while cfe.es.run_loop():
            cfe.os.task_delay(100)

    lab = make_lab(one=one)
    lab.start("one")
    lab.mission.run_for(1.5)
    assert lab.es.history["ONE"].restarts == 1
    assert "RuntimeError: child" in lab.log()

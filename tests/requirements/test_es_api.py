"""NASA's requirements for what applications ask of Executive Services (cES13xx): who is who, control, child tasks."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from cfepy.app import Cfe
from cfepy.es.records import APP_EXIT, CORE, EXTERNAL, LIBRARY, SYS_DELETE, SYS_RELOAD, SYS_RESTART
from cfepy.fs import CRC_8, CRC_16, CRC_32, CRC_NONE
from cfepy.status import (
    CFE_ES_BAD_ARGUMENT,
    CFE_ES_ERR_CHILD_TASK_CREATE,
    CFE_ES_ERR_CHILD_TASK_DELETE_MAIN_TASK,
    CFE_ES_ERR_NAME_NOT_FOUND,
    CFE_ES_ERR_RESOURCEID_NOT_VALID,
    CFE_ES_FILE_IO_ERR,
    CFE_ES_OPERATION_TIMED_OUT,
    CFE_STATUS_EXTERNAL_RESOURCE_FAIL,
    CfeError,
)
from tests.es.harness import Lab
from tests.requirements.covers import covers
from tests.requirements.ground import Ground

Make = Callable[..., Lab]


@pytest.fixture
def make_lab(tmp_path: Path) -> Iterator[Make]:
    labs: list[Lab] = []

    def make(**mains: Any) -> Lab:
        labs.append(Lab(tmp_path, **mains))
        return labs[-1]

    yield make
    for lab in labs:
        lab.mission.close()


def status_of(call: Callable[..., object], *arguments: object) -> int:
    with pytest.raises(CfeError) as caught:
        call(*arguments)
    return caught.value.status


def idle(cfe: Cfe) -> None:
    while cfe.es.run_loop():
        cfe.os.task_delay(100)


def ask(make_lab: Make, question: Callable[[Cfe], Any], seconds: float = 1) -> tuple[Any, Lab]:
    """What an application finds out, and the mission."""
    found: list[Any] = []

    def one(cfe: Cfe) -> None:
        cfe.es.run_loop()
        found.append(question(cfe))
        idle(cfe)

    lab = make_lab(one=one, idle=idle, lib=lambda cfe: 0)
    lab.es.load_library("LIB", "/cf/lib.so", "lib_init")
    lab.start("idle")
    lab.mission.run(0.3)
    lab.start("one")
    lab.mission.run(seconds)
    assert found, "the application died"
    return found[0], lab


# -- who is who --------------------------------------------------------------------------------------------------------


@covers("cES1301", "cES1301.1")
def test_cES1301_the_type_of_the_last_reset(make_lab: Make) -> None:
    found, _ = ask(make_lab, lambda cfe: cfe.es.get_reset_type())
    assert found == (2, 1)


@covers("cES1304", "cES1306", "cES1307")
def test_cES1304_an_application_is_told_its_id_and_names(make_lab: Make) -> None:
    def question(cfe: Cfe) -> tuple[object, ...]:
        es = cfe.es
        mine = es.get_app_id()
        assert status_of(es.get_app_id_by_name, "NOBODY") == CFE_ES_ERR_NAME_NOT_FOUND
        assert status_of(es.get_app_name, 0) == CFE_ES_ERR_RESOURCEID_NOT_VALID
        return mine, es.get_app_id_by_name("ONE"), es.get_app_name(mine), es.app_id_to_index(mine)

    (mine, by_name, name, index), lab = ask(make_lab, question)
    assert mine == by_name == lab.es.app_named("ONE").app_id  # type: ignore[union-attr]  # None fails as well
    assert (name, index) == ("ONE", mine & 0xFFFF)
    assert status_of(lab.es.get_app_id) == CFE_ES_ERR_RESOURCEID_NOT_VALID  # the host is no application
    assert status_of(lab.es.app_id_to_index, 0x120001) == CFE_ES_ERR_RESOURCEID_NOT_VALID


def test_cES1305_a_task_is_described(make_lab: Make) -> None:
    def question(cfe: Cfe) -> Any:
        es = cfe.es
        task_id = es.get_task_id()
        assert es.get_task_id_by_name("ONE") == task_id
        assert es.get_task_name(task_id) == "ONE"
        assert es.task_id_to_index(task_id) == task_id & 0x3F
        assert status_of(es.get_task_info, 0) == CFE_ES_ERR_RESOURCEID_NOT_VALID
        assert status_of(es.get_task_name, 0) == CFE_ES_ERR_RESOURCEID_NOT_VALID
        assert status_of(es.get_task_id_by_name, "NOBODY") == CFE_ES_ERR_NAME_NOT_FOUND
        return es.get_task_info(task_id), es.get_app_info(es.get_app_id())

    (task, app), lab = ask(make_lab, question)
    assert (task.task_name, task.app_name, task.task_id, task.app_id) == (
        "ONE",
        "ONE",
        app.main_task_id,
        app.resource_id,
    )
    assert (task.priority, task.stack_size, task.execution_counter) == (50, 8192, 1)
    assert "CFE_ES_GetTaskInfo: Task ID Not Active: 0" in lab.log()
    assert status_of(lab.es.get_task_id) == CFE_ES_ERR_RESOURCEID_NOT_VALID


def test_cES1336_an_application_is_described(make_lab: Make) -> None:
    info, lab = ask(make_lab, lambda cfe: cfe.es.get_app_info(cfe.es.get_app_id()))
    assert (info.type, info.name, info.entry_point, info.file_name) == (EXTERNAL, "ONE", "one_main", "/cf/one.so")
    assert (info.stack_size, info.priority, info.exception_action) == (8192, 50, 0)
    assert (info.main_task_name, info.num_of_child_tasks, info.execution_counter) == ("ONE", 0, 1)
    core = lab.es.get_app_info(lab.es.get_app_id_by_name("CFE_ES"))
    assert (core.type, core.name, core.entry_point, core.file_name) == (CORE, "CFE_ES", "", "")
    assert (core.exception_action, core.priority, core.num_of_child_tasks) == (1, 68, 1)
    assert lab.es.get_module_info(core.resource_id).name == "CFE_ES"
    assert status_of(lab.es.get_app_info, 0) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert status_of(lab.es.get_module_info, 0) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert "CFE_ES_GetAppInfo: App ID not active: 0" in lab.log()
    assert "CFE_ES_GetModuleInfo: Resource ID not valid: 0" in lab.log()


def test_cES1344_a_library_is_described(make_lab: Make) -> None:
    def question(cfe: Cfe) -> Any:
        es = cfe.es
        lib_id = es.get_lib_id_by_name("LIB")
        assert es.get_lib_name(lib_id) == "LIB"
        assert es.lib_id_to_index(lib_id) == 1
        assert es.get_module_info(lib_id) == es.get_lib_info(lib_id)
        for call in (es.get_lib_info, es.get_lib_name, es.lib_id_to_index):
            assert status_of(call, 0) == CFE_ES_ERR_RESOURCEID_NOT_VALID
        assert status_of(es.get_lib_id_by_name, "NOBODY") == CFE_ES_ERR_NAME_NOT_FOUND
        return es.get_lib_info(lib_id)

    info, _ = ask(make_lab, question)
    assert (info.type, info.name, info.entry_point, info.file_name) == (LIBRARY, "LIB", "lib_init", "/cf/lib.so")
    assert (info.stack_size, info.priority, info.main_task_id, info.main_task_name) == (0, 0, 0, "")


# -- the run loop and waiting ------------------------------------------------------------------------------------------


@covers("cES1333", "cES1337")
def test_cES1333_the_run_loop_counts_and_answers(make_lab: Make) -> None:
    def question(cfe: Cfe) -> list[object]:
        es, task_id = cfe.es, cfe.es.get_task_id()
        before = es.get_task_info(task_id).execution_counter
        answers: list[object] = [es.run_loop(), es.run_loop(1)]
        es.increment_task_counter()
        answers.append(es.run_loop(0))
        return [*answers, es.get_task_info(task_id).execution_counter - before, es.control_request()]

    found, _ = ask(make_lab, question)
    assert found == [True, True, False, 4, 1]


@covers("cES1334", "cES1335")
def test_cES1334_waiting_for_the_state_of_the_system(make_lab: Make) -> None:
    def question(cfe: Cfe) -> list[int]:
        es, begin = cfe.es, cfe.es.kernel.now
        for state in range(6):
            es.wait_for_system_state(state, 10_000)
        es.wait_for_startup_sync(10_000)
        waits = [es.kernel.now - begin]
        es.system_state = 4
        begin = es.kernel.now
        es.wait_for_startup_sync(120)
        waits.append(es.kernel.now - begin)
        assert status_of(es.wait_for_system_state, 5, 60) == CFE_ES_OPERATION_TIMED_OUT
        return waits

    found, _ = ask(make_lab, question)
    assert found == [0, 120_000_000]


# -- control -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("action", "request_code", "event"),
    [("delete", SYS_DELETE, "8: Stop"), ("restart", SYS_RESTART, "10: Restart"), ("reload", SYS_RELOAD, "12: Reload")],
)
@covers("cES1309", "cES1310", "cES1332")
def test_cES1309_applications_control_applications(make_lab: Make, action: str, request_code: int, event: str) -> None:
    def question(cfe: Cfe) -> int:
        target = cfe.es.get_app_id_by_name("IDLE")
        call = {"delete": cfe.es.delete_app, "restart": cfe.es.restart_app}.get(action)
        if call is not None:
            call(target)
        else:
            cfe.es.reload_app(target, "/cf/idle.so")
        return cfe.es.app(target).control_request

    found, lab = ask(make_lab, question, 8)
    assert found == request_code
    assert f"CFE_ES {event} Application IDLE Completed" in lab.log()
    assert (lab.es.app_named("IDLE") is None) == (action == "delete")


@covers("cES1309.1", "cES1310.1", "cES1310.2", "cES1310.3")
def test_cES1309_1_control_that_cannot_be(make_lab: Make) -> None:
    def question(cfe: Cfe) -> list[int]:
        es, mine = cfe.es, cfe.es.get_app_id()
        core = es.get_app_id_by_name("CFE_TBL")
        es.loader.mains.pop("/cf/idle.so")  # type: ignore[attr-defined]  # the file is gone
        return [
            status_of(es.delete_app, 0),
            status_of(es.restart_app, 0),
            status_of(es.reload_app, 0, "/cf/idle.so"),
            status_of(es.delete_app, core),
            status_of(es.restart_app, es.get_app_id_by_name("IDLE")),
            status_of(es.reload_app, mine, "/cf/nowhere.so"),
        ]

    found, lab = ask(make_lab, question)
    assert found == [CFE_ES_ERR_RESOURCEID_NOT_VALID] * 4 + [CFE_ES_FILE_IO_ERR] * 2
    for text in (
        "CFE_ES_LockUserAppRecord: Invalid Application ID received for Delete, AppID = 0",
        "CFE_ES_LockUserAppRecord: Invalid Application ID received for Restart, AppID = 0",
        "CFE_ES_LockUserAppRecord: Cannot Delete a CORE Application: CFE_TBL.",
        "CFE_ES_RestartApp: Cannot Restart Application IDLE, File /cf/idle.so does not exist.",
        "CFE_ES_ReloadApp: Cannot Reload Application ONE, File /cf/nowhere.so does not exist.",
    ):
        assert text in lab.log()


def test_cES1319_an_application_ends_itself(make_lab: Make) -> None:
    def ends(cfe: Cfe) -> None:
        cfe.es.run_loop()
        cfe.sb.create_pipe(4, "ENDS_PIPE")
        cfe.os.queue_create("ENDS_QUEUE", 3, 8)
        cfe.es.create_child_task("ENDS_CHILD", lambda: cfe.os.task_delay(10**6), 4096, 60)
        cfe.os.task_delay(300)
        cfe.es.exit_app(APP_EXIT)

    lab = make_lab(ends=ends)
    tasks, booked = len(lab.es.tasks()), lab.mission.memory.used
    lab.start("ends")
    lab.mission.run(3)
    assert lab.es.app_named("ENDS") is None
    assert (len(lab.es.tasks()), lab.mission.memory.used) == (tasks, booked)
    assert status_of(lab.cfe.sb.get_pipe_id_by_name, "ENDS_PIPE")
    assert "CFE_ES_ExitApp: Application ENDS called CFE_ES_ExitApp" in lab.log()
    assert "CFE_ES 13: Exit Application ENDS Completed." in lab.log()


def test_cES1319_an_odd_status_counts_as_an_error(make_lab: Make) -> None:
    lab = make_lab(odd=lambda cfe: cfe.es.exit_app(99))
    lab.start("odd")
    lab.mission.run(3)
    assert "CFE_ES_ExitApp: Called with invalid status (99)." in lab.log()
    assert "CFE_ES 14: Exit Application ODD Completed." in lab.log()


# -- child tasks -------------------------------------------------------------------------------------------------------


def test_cES1311_a_child_task_belongs_to_its_application(make_lab: Make) -> None:
    counts: list[int] = []

    def child(cfe: Cfe) -> None:
        while True:
            counts.append(cfe.es.get_app_id())
            cfe.os.task_delay(100)

    def question(cfe: Cfe) -> tuple[int, int, str]:
        task_id = cfe.es.create_child_task("CHILD", lambda: child(cfe), 4096, 60)
        cfe.os.task_delay(500)
        return cfe.es.get_app_id(), task_id, cfe.es.get_task_info(task_id).app_name

    (app_id, task_id, owner), lab = ask(make_lab, question)
    assert {*counts} == {app_id}
    assert owner == "ONE"
    assert lab.es.get_task_id_by_name("CHILD") == task_id


@covers("cES1311.1", "cES1311.2")
def test_cES1311_1_child_tasks_that_cannot_be(make_lab: Make) -> None:
    nested: list[int] = []

    def child(cfe: Cfe) -> None:
        nested.append(status_of(cfe.es.create_child_task, "DEEP", print, 4096, 60))
        nested.append(status_of(cfe.es.delete_child_task, cfe.es.get_app_info(cfe.es.get_app_id()).main_task_id))

    def question(cfe: Cfe) -> list[int]:
        cfe.es.create_child_task("CHILD", lambda: child(cfe), 4096, 60)
        cfe.os.task_delay(10)
        return [
            status_of(cfe.es.create_child_task, "CHILD", print, 4096, 60),
            status_of(cfe.es.create_child_task, "NO_STACK", print, 0, 60),
            status_of(cfe.es.create_child_task, "", print, 4096, 60),
        ]

    found, lab = ask(make_lab, question)
    assert found == [CFE_STATUS_EXTERNAL_RESOURCE_FAIL, CFE_STATUS_EXTERNAL_RESOURCE_FAIL, CFE_ES_BAD_ARGUMENT]
    assert nested == [CFE_ES_ERR_CHILD_TASK_CREATE, CFE_ES_ERR_CHILD_TASK_DELETE_MAIN_TASK]
    host = status_of(lab.es.create_child_task, "LONELY", print, 4096, 60)
    assert host == CFE_ES_ERR_RESOURCEID_NOT_VALID
    for text in (
        "CFE_ES_StartAppTask: AppCreate Error: TaskCreate CHILD Failed. EC = -15!",
        "CFE_ES_CreateChildTask: Error: Cannot call from a Child Task (for Task 'DEEP').",
        "CFE_ES_CreateChildTask: Invalid calling context when creating Task 'LONELY'",
        "CFE_ES_CreateChildTask: TaskName Parameter is NULL",
    ):
        assert text in lab.log()


@covers("cES1312", "cES1312.1")
def test_cES1312_a_child_task_is_deleted_but_no_main_task(make_lab: Make) -> None:
    counts: list[int] = []

    def child(cfe: Cfe) -> None:
        while True:
            counts.append(1)
            cfe.os.task_delay(100)

    def question(cfe: Cfe) -> list[int]:
        es = cfe.es
        task_id = es.create_child_task("CHILD", lambda: child(cfe), 4096, 60)
        cfe.os.task_delay(500)
        es.delete_child_task(task_id)
        counted = len(counts)
        cfe.os.task_delay(300)
        assert len(counts) == counted == 5
        return [
            status_of(es.delete_child_task, es.get_task_id()),
            status_of(es.delete_child_task, task_id),
            status_of(es.delete_child_task, 0),
        ]

    found, lab = ask(make_lab, question, 2)
    assert found == [
        CFE_ES_ERR_CHILD_TASK_DELETE_MAIN_TASK,
        CFE_ES_ERR_RESOURCEID_NOT_VALID,
        CFE_ES_ERR_RESOURCEID_NOT_VALID,
    ]
    main = lab.es.get_task_id_by_name("ONE")
    assert f"CFE_ES_DeleteChildTask: Error: Task {main} is a cFE Main Task." in lab.log()
    assert "CFE_ES_DeleteChildTask: Error: Invalid Task ID: 0" in lab.log()


@covers("cES1314", "cES1314.1")
def test_cES1314_a_child_task_ends_itself_but_no_main_task(make_lab: Make) -> None:
    reached: list[str] = []

    def child(cfe: Cfe) -> None:
        reached.append("begun")
        cfe.es.exit_child_task()
        reached.append("never")

    def question(cfe: Cfe) -> int:
        task_id = cfe.es.create_child_task("CHILD", lambda: child(cfe), 4096, 60)
        cfe.os.task_delay(200)
        cfe.es.exit_child_task()
        return status_of(cfe.es.get_task_name, task_id)

    found, lab = ask(make_lab, question)
    assert found == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert reached == ["begun"]
    main = lab.es.get_task_id_by_name("ONE")
    assert f"CFE_ES_ExitChildTask: Error: Cannot Call from a cFE App Main Task. ID = {main}" in lab.log()


# -- check values and exceptions ---------------------------------------------------------------------------------------


def test_cES1323_check_values_over_data(make_lab: Make) -> None:
    """With the values of NASA's functional test; algorithms other than CRC-16/ARC are names only, and give 0."""
    data = b"123456789"

    def question(cfe: Cfe) -> list[int]:
        crc = cfe.es.calculate_crc
        assert crc(data[4:], crc(data[:4])) == crc(data) == crc(data, 0, CRC_16)
        assert [crc(data, 1, kind) for kind in (CRC_NONE, CRC_8, CRC_32, 99)] == [0, 0, 0, 0]
        return [crc(data), crc(b"Random Stuff"), crc(data, 345353), crc(b"", 345353)]

    found, _ = ask(make_lab, question)
    assert found == [0xBB3D, 0x11E3, 0xE493, 345353]


def test_cES1017_an_exception_is_dealt_with_at_once(make_lab: Make) -> None:
    """CFE_ES_ProcessAsyncEvent wakes the background task, which scans for exceptions."""

    def dies(cfe: Cfe) -> None:
        cfe.es.run_loop()
        cfe.os.task_delay(777)
        raise RuntimeError("gone")

    lab = make_lab(dies=dies)
    lab.start("dies")
    lab.mission.run(0.9)
    (line,) = [line for line in lab.lines if "CFE_ES_RunExceptionScan" in line]
    assert line.startswith("1980-012-14:03:21.827")
    assert Ground(lab.mission).lines("CFE_ES_RestartApp") == ["CFE_ES_RestartApp: Restart Application DIES Initiated"]

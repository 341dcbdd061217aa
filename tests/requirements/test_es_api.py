"""NASA's requirements for requests of applications to Executive Services (cES13xx): identity, running, waiting."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from cfepy.app import Cfe
from cfepy.es.records import (
    APP_EXIT,
    APP_RUN,
    CORE,
    EXTERNAL,
    LIBRARY,
    SYS_DELETE,
    SYSTEM_APPS_INIT,
    SYSTEM_OPERATIONAL,
    SYSTEM_SHUTDOWN,
)
from cfepy.fs import CRC_8, CRC_16, CRC_32, CRC_NONE
from cfepy.mission import Mission
from cfepy.status import CFE_ES_ERR_NAME_NOT_FOUND, CFE_ES_ERR_RESOURCEID_NOT_VALID, CFE_ES_OPERATION_TIMED_OUT
from cfepy.writing.console import Console
from tests.mission.flights import write_mission
from tests.requirements.asking import Make, ask, idle
from tests.requirements.covers import covers
from tests.requirements.ground import Ground
from tests.statuses import status_of

# -- identity ----------------------------------------------------------------------------------------------------------


@covers("cES1304", "cES1306", "cES1307")
def test_cES1304_an_application_gets_its_id_and_names(make_lab: Make) -> None:
    def question(cfe: Cfe) -> tuple[object, ...]:
        es = cfe.es
        mine = es.get_app_id()
        assert status_of(es.get_app_id_by_name, "NOBODY") == CFE_ES_ERR_NAME_NOT_FOUND
        assert status_of(es.get_app_name, 0) == CFE_ES_ERR_RESOURCEID_NOT_VALID
        return mine, es.get_app_id_by_name("ONE"), es.get_app_name(mine), es.app_id_to_index(mine)

    (mine, by_name, name, index), lab = ask(make_lab, question)
    assert mine == by_name == lab.es.app_named("ONE").app_id  # type: ignore[union-attr]  # None fails as well
    assert (name, index) == ("ONE", mine & 0xFFFF)
    assert status_of(lab.es.get_app_id) == CFE_ES_ERR_RESOURCEID_NOT_VALID  # the host is not an application
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


def test_cES1333_run_loop_counts_and_returns_the_requested_end(make_lab: Make) -> None:
    ends: list[int] = []

    def main(cfe: Cfe) -> None:
        idle(cfe)
        ends.append(cfe.es.control_request())

    def question(cfe: Cfe) -> list[object]:
        es, task_id = cfe.es, cfe.es.get_task_id()
        before = es.get_task_info(task_id).execution_counter
        answers: list[object] = [es.run_loop(), es.run_loop(APP_RUN), es.run_loop(APP_EXIT)]
        es.delete_app(es.get_app_id_by_name("IDLE"))
        return [*answers, es.get_task_info(task_id).execution_counter - before, es.control_request()]

    found, _ = ask(make_lab, question, idle=main)
    assert found == [True, True, False, 3, APP_RUN]
    assert ends == [SYS_DELETE]


def test_cES1337_a_task_counts_its_cycles(make_lab: Make) -> None:
    def question(cfe: Cfe) -> int:
        es, task_id = cfe.es, cfe.es.get_task_id()
        before = es.get_task_info(task_id).execution_counter
        for _ in range(3):
            es.increment_task_counter()
        return es.get_task_info(task_id).execution_counter - before

    assert ask(make_lab, question)[0] == 3


@pytest.mark.parametrize("wait", ["wait_for_system_state(5, 10_000)", "wait_for_startup_sync(10_000)"])
@covers("cES1334", "cES1335")
def test_cES1334_an_application_waits_until_the_mission_is_operational(tmp_path: Path, wait: str) -> None:
    startup = "CFE_APP,waits,main,WAITS,50,8192,0,0; CFE_APP,slow,main,SLOW,50,8192,0,0;!"
    waits = f"""
        def main(cfe):
            cfe.os.printf("WAITS begins")
            cfe.es.{wait}
            cfe.os.printf(f"WAITS goes on in state {{cfe.es.system_state}}")
    """
    slow = """
        def main(cfe):
            cfe.os.task_delay(700)
            cfe.os.printf("SLOW is ready")
            while cfe.es.run_loop():
                cfe.os.task_delay(100)
    """
    with Mission(write_mission(tmp_path, startup, waits=waits, slow=slow), console=Console(quiet=True)) as mission:
        mission.run_for(3)
        said = [line.partition(" ")[2] if "entering" in line else line for line in mission.console.lines]
    order = [line for line in said if line.startswith(("WAITS", "SLOW")) or "OPERATIONAL" in line]
    assert order == [
        "WAITS begins",
        "SLOW is ready",
        "CFE_ES_Main: CFE_ES_Main entering OPERATIONAL state",
        "WAITS goes on in state 5",
    ]


@covers("cES1334", "cES1335")
def test_cES1334_waiting_ends_after_its_time(make_lab: Make) -> None:
    def question(cfe: Cfe) -> list[int]:
        es, begin = cfe.es, cfe.es.kernel.now
        es.wait_for_system_state(SYSTEM_OPERATIONAL, 10_000)
        es.wait_for_startup_sync(10_000)
        times = [es.kernel.now - begin]
        assert status_of(es.wait_for_system_state, SYSTEM_SHUTDOWN, 60) == CFE_ES_OPERATION_TIMED_OUT
        times.append(es.kernel.now - begin)
        es.system_state = SYSTEM_APPS_INIT  # as if the mission were still starting up
        es.wait_for_startup_sync(120)
        return [*times, es.kernel.now - begin]

    found, _ = ask(make_lab, question)
    assert found == [0, 60_000_000, 180_000_000]


# -- check values and exceptions ---------------------------------------------------------------------------------------


def test_check_values_over_data(make_lab: Make) -> None:
    """The values are from NASA's functional test. Algorithms other than CRC-16/ARC are names only, and give 0."""
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
    lab.mission.run_for(0.9)
    (line,) = [line for line in lab.lines if "CFE_ES_RunExceptionScan" in line]
    assert line.startswith("1980-012-14:03:21.827")
    assert Ground(lab.mission).lines("CFE_ES_RestartApp") == ["CFE_ES_RestartApp: Restart Application DIES Initiated"]

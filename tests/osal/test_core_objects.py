"""cFE's own OSAL objects: those that NASA's cFE 7.0.1 has on Linux, with one application, once it is OPERATIONAL."""

from __future__ import annotations

from pathlib import Path

from cfepy.mission import Mission
from cfepy.status import OS_ERR_NAME_TAKEN, OS_ERR_NO_FREE_IDS
from cfepy.writing.console import Console
from tests.mission.flights import write_mission
from tests.osal.test_queues import status_of

IDLE = "def idle_main(cfe):\n    cfe.evs.register()\n    while cfe.es.run_loop():\n        cfe.os.task_delay(1000)\n"
STARTUP = "CFE_APP, idle, idle_main, OBJECTS, 50, 16384, 0x0, 0;\n!"
RECORDED = """
    10001 CFE_ES, 10002 ES_BG_TASK, 10003 CFE_EVS, 10004 CFE_SB, 10005 CFE_TBL, 10006 CFE_TIME, 10007 TIME_TONE_TASK,
    10008 TIME_ONEHZ_TASK, 10009 OBJECTS, 20001 ES_CMD_PIPE, 20002 EVS_CMD_PIPE, 20003 SB_CMD_PIPE, 20004 TBL_CMD_PIPE,
    20005 TIME_CMD_PIPE, 40001 ES_BG_SEM, 40002 TIME_TONE_SEM, 40003 TIME_ONEHZ_SEM, 50001 DriverMutex-01,
    50002 DriverMutex-02, 50003 DriverMutex-03, 50004 DriverMutex-04, 50005 DriverMutex-05, 50006 DriverMutex-06,
    50007 DriverMutex-07, 50008 ES_DATA_MUTEX, 50009 ES_PERF_MUTEX, 5000a CDS_MUTEX, 5000b CFE_EVS_DataMutex,
    5000c CFE_FS_SharedMutex, 5000d CFE_SB_DataMutex, 5000e TBL_REG_MUT, 5000f TBL_WRK_MUT, 50010 Pool00140002,
    80001 cFS-Master, 90001 cFS-1Hz, a0001 OBJECTS, b0001 /cf, b0002 /ramdev0, c0001
"""
MORE = "CFE_APP, idle, idle_main, A{0}, 50, 8192, 0x0, 0;\n"


def flown(folder: Path, startup: str) -> Mission:
    """Return a mission of applications that only wait, after its start."""
    mission = Mission(write_mission(folder, startup, idle=IDLE), console=Console(quiet=True))
    mission.run_for(2)
    return mission


def test_booted_cfe_has_the_same_objects_as_nasas(tmp_path: Path) -> None:
    found: list[str] = []
    with flown(tmp_path, STARTUP) as mission:
        os = mission.cfe.os
        os.for_each_object(0, lambda each, _: found.append(f"{each:x} {os.get_resource_name(each)}".strip()))
    assert found == [" ".join(each.split()) for each in RECORDED.split(",")]


def test_pipe_and_queue_cannot_have_one_name(tmp_path: Path) -> None:
    with flown(tmp_path, STARTUP) as mission:
        assert status_of(mission.cfe.os.queue_create, "ES_CMD_PIPE", 1, 4) == OS_ERR_NAME_TAKEN


def test_deleted_pipe_frees_its_queue(tmp_path: Path) -> None:
    with flown(tmp_path, STARTUP) as mission:
        os, sb = mission.cfe.os, mission.cfe.sb
        free = os.config.os_max_queues - 5
        pipes = [sb.create_pipe(1, f"P{number}") for number in range(free)]
        assert status_of(os.queue_create, "Q", 1, 4) == OS_ERR_NO_FREE_IDS
        sb.delete_pipe(pipes[0])
        os.queue_create("Q", 1, 4)


def test_application_beyond_the_modules_of_osal_is_not_loaded(tmp_path: Path) -> None:
    with flown(tmp_path, "".join(MORE.format(number) for number in range(21)) + "!") as mission:
        lines = [line for line in mission.console.lines if "Could not load" in line]
        assert [line.partition("CFE_ES_LoadModule: ")[2] for line in lines] == [
            f"Could not load file:/cf/idle.so. EC = {OS_ERR_NO_FREE_IDS}"
        ]
        es = mission.cfe.es
        es.delete_app(es.get_app_id_by_name("A0"))
        mission.run_for(8)
        es.create_app("A20", es.app(es.get_app_id_by_name("A1")).params)

"""Applications that end while they use OSAL objects: events, logs and leftovers of NASA's cFE 7.0.1 on Linux."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import pytest

from cfepy.mission import Mission, endless_waits
from cfepy.pilot import problems_of
from cfepy.writing.console import Console
from tests.mission.flights import write_mission

STARTUP = """\
CFE_APP, other, other_main, OTHER, 50, 16384, 0x0, 0;
CFE_APP, victim, victim_main, VICTIM, 50, 16384, 0x0, 0;
!
"""
OTHER = "def other_main(cfe):\n    while cfe.es.run_loop():\n        cfe.os.task_delay(1000)\n"
VICTIM = """
def victim_main(cfe):
    os = cfe.os

    def make(what, function, *arguments):
        try:
            made = function(*arguments)
        except Exception as error:
            os.printf(f"R {{what}} {{error.status}}")
            return 0
        os.printf(f"R {{what}} 0")
        return made

    mutex, semaphore = make("mutex", os.mut_sem_create, "VM"), make("semaphore", os.bin_sem_create, "VB", 0)

    def holds():
        os.mut_sem_take(mutex)
        os.task_delay(10**6)

    cfe.es.wait_for_startup_sync(5000)
    {body}
    os.task_delay(10**6)
"""
FAILED = "CFE_ES_CleanupObjectCallback: Call to OSAL Delete Object (ID:327697) failed. RC=-6"
NOT_CLEAN = "CFE_ES_CleanUpApp: CleanUpTaskResources for Task ID:65546 returned Error: 0xC400001B"
KEPT_A_MUTEX = [FAILED] * 3 + [NOT_CLEAN, "41: Restart Application VICTIM Failed: CleanUpApp Error 0xC4000023."]
CLEAN = ["10: Restart Application VICTIM Completed, AppID=1114120"]


class Case(NamedTuple):
    """The last lines of an application, and the log and the application's own lines from its restart on."""

    body: str
    log: list[str]
    again: list[str]


CASES = {
    "holds a mutex": Case("os.mut_sem_take(mutex)", KEPT_A_MUTEX, ["mutex -15", "semaphore 0"]),
    "child holds its mutex": Case(
        "cfe.es.create_child_task('CHILD', holds, 8192, 60)", KEPT_A_MUTEX, ["mutex -15", "semaphore 0"]
    ),
    "waits with a time limit": Case("os.bin_sem_timed_wait(semaphore, 2000)", CLEAN, ["mutex 0", "semaphore 0"]),
    "has objects that ES does not delete": Case(
        "make('condition', os.cond_var_create, 'V'), make('lock', os.rw_lock_create, 'V'), "
        "make('folder', os.directory_open, '/ram'), make('time base', os.time_base_create, 'V')",
        CLEAN,
        ["mutex 0", "semaphore 0", "condition -15", "lock -15", "folder 0", "time base -15"],
    ),
    "reads a socket": Case(
        "sock = os.socket_open(1, 1); where = os.socket_addr_init(1); "
        "os.socket_addr_set_port(where, 5678); os.socket_bind(sock, where); os.socket_recv_from(sock, 9)",
        [
            *["CFE_ES_CleanupObjectCallback: Call to OSAL Delete Object (ID:393217) failed. RC=-33"] * 3,
            "CFE_ES_CleanUpApp: CleanUpTaskResources for Task ID:65546 returned Error: 0xC4000023",
            "41: Restart Application VICTIM Failed: CleanUpApp Error 0xC4000023.",
        ],
        ["mutex 0", "semaphore 0"],
    ),
}


def flown(folder: Path, body: str, safe: bool = False) -> Mission:
    """Return a mission in which the application VICTIM was restarted after a second."""
    settings = "safe: true\n" if safe else ""
    sources = {"other": OTHER, "victim": VICTIM.format(body=body), "mission_yaml": settings}
    mission = Mission(write_mission(folder, STARTUP, **sources), console=Console(quiet=True))
    mission.run_for(1.5)
    es = mission.cfe.es
    es.restart_app(es.get_app_id_by_name("VICTIM"))
    mission.run_for(8)
    return mission


def log_of(mission: Mission) -> list[str]:
    """Return the lines of the console about the end of applications, without their times."""
    words = ("Call to OSAL Delete", "CleanUpTaskResources", "Restart Application VICTIM C", "Application VICTIM Failed")
    lines = [line for line in mission.console.lines if any(word in line for word in words)]
    return [line.partition("/CFE_ES ")[2] or line.partition(" ")[2] for line in lines]


def own_lines(mission: Mission) -> list[str]:
    """Return the lines of the application."""
    return [line[2:] for line in mission.console.lines if line.startswith("R ")]


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_restarted_application_leaves_the_same_as_under_nasas_es(tmp_path: Path, case: Case) -> None:
    with flown(tmp_path, case.body) as mission:
        assert log_of(mission) == case.log
        lines = own_lines(mission)
    assert lines[len(lines) // 2 :] == case.again


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_restart_in_a_safe_mission_leaves_nothing(tmp_path: Path, case: Case) -> None:
    with flown(tmp_path, case.body, safe=True) as mission:
        assert log_of(mission) == CLEAN
        lines = own_lines(mission)
    half = len(lines) // 2
    assert lines[:half] == lines[half:]


def test_restart_of_an_application_that_waits_for_its_semaphore_stops_es(tmp_path: Path) -> None:
    with flown(tmp_path, "os.bin_sem_take(semaphore)") as mission:
        es = mission.cfe.es
        assert log_of(mission) == []
        es.delete_app(es.get_app_id_by_name("OTHER"))
        mission.run_for(8)
        es.get_app_id_by_name("OTHER")  # it is still there
        texts = [each.text for each in problems_of(mission, endless_waits(mission))]
    assert len(texts) == 1
    assert texts[0].startswith("VICTIM waits forever for semaphore VB, which ES_BG_TASK is deleting at victim.py:")


def test_restart_of_an_application_whose_tasks_share_a_mutex_aborts_the_flight_software(tmp_path: Path) -> None:
    body = "cfe.es.create_child_task('CHILD', holds, 8192, 60); os.task_delay(200); os.mut_sem_take(mutex)"
    with flown(tmp_path, body) as mission:
        assert mission.over
        texts = [each.text for each in problems_of(mission, endless_waits(mission))]
    assert texts[0].startswith("the flight software aborts at ")
    assert "as NASA's process on Linux does: CHILD ended while it held mutex VM, for which VICTIM waits" in texts[0]

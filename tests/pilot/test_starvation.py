"""The report of a run names applications that use the CPU without waiting, and the tasks that cannot run then."""

from __future__ import annotations

from pathlib import Path

from cfepy.mission import Mission
from cfepy.pilot.idleness import starved_tasks
from cfepy.writing.console import Console
from tests.mission.flights import write_mission

STARTUP = """\
CFE_APP, poller, poller_main, POLLER, 50, 8192, 0x0, 0;
CFE_APP, worker, worker_main, WORKER, 60, 8192, 0x0, 0;
!
"""
POLLER = """
def poller_main(cfe):
    pipe = cfe.sb.create_pipe(5, "POLLED")
    while cfe.es.run_loop():
        cfe.sb.receive_buffer(pipe, 0)
"""
WORKER = """
def worker_main(cfe):
    while cfe.es.run_loop():
        cfe.os.printf("worked")
        cfe.os.task_delay(100)
"""


def flown(folder: Path, settings: str = "") -> tuple[list[str], int]:
    """Return the lines about starved tasks after three seconds, and how often WORKER worked."""
    sources = {"poller": POLLER, "worker": WORKER, "mission_yaml": f"board: rx64m\n{settings}"}
    with Mission(write_mission(folder, STARTUP, **sources), console=Console(quiet=True)) as mission:
        mission.run_for(3)
        return starved_tasks(mission), mission.console.lines.count("worked")


def test_polling_application_and_the_tasks_that_it_keeps_from_running_are_named(tmp_path: Path) -> None:
    lines, worked = flown(tmp_path)
    assert len(lines) == 1
    assert lines[0].startswith("POLLER used ")
    assert "of the CPU, and kept tasks of less urgent priority ready without running: " in lines[0]
    assert "WORKER (" in lines[0]
    assert worked == 0


def test_fair_scheduling_lets_the_others_run(tmp_path: Path) -> None:
    lines, worked = flown(tmp_path, "scheduling: fair\n")
    assert lines == []
    assert worked > 10

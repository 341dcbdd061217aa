"""Priority inversions: cases that are inversions, cases that are not, and the report."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.mission import Mission
from cfepy.monitors import InversionWatch
from cfepy.monitors.record import Inversion, InversionRecord
from cfepy.writing.console import Console
from tests.mission.flights import write_mission

STARTUP = """
    CFE_APP, apps, URGENT_Main, URGENT, 40,  16384, 0, 0;
    CFE_APP, apps, MEDIUM_Main, MEDIUM, 80,  16384, 0, 0;
    CFE_APP, apps, IDLE_Main,   IDLE,   120, 16384, 0, 0;
    !
"""
APPS = """
    LOCK = "LOCK"

    def URGENT_Main(cfe):
        cfe.os.{create}
        cfe.os.task_delay(600)
        for _ in range({urgent}):
            cfe.os.task_delay(10)
            lock = cfe.os.{kind}_get_id_by_name(LOCK)
            cfe.os.{take}
            cfe.os.{give}
        cfe.es.run_loop()
        cfe.os.task_delay(10000)

    def MEDIUM_Main(cfe):
        cfe.os.task_delay(605)
        cfe.psp.compute(20000)
        cfe.os.task_delay(10000)

    def IDLE_Main(cfe):
        lock = cfe.os.{kind}_get_id_by_name(LOCK)
        cfe.os.{take}
        {back}
        cfe.os.task_delay(600)
        {again}
        cfe.psp.compute(7000)
        cfe.os.{give}
        cfe.os.task_delay(10000)
"""


def inversions(
    folder: Path,
    kind: str = "bin_sem",
    create: str = "bin_sem_create(LOCK, 1)",
    take: str = "take(lock)",
    is_lock: bool = True,
    shortest_ns: int = 1_000_000,
) -> list[Inversion]:
    """Return the inversions of a run: IDLE has the lock when MEDIUM begins to compute, and URGENT then wants it."""
    take, give = f"{kind}_{take}", f"{kind}_give(lock)"
    back, again = (f"cfe.os.{give}", f"cfe.os.{take}") if is_lock else ("pass", "pass")
    apps = APPS.format(kind=kind, create=create, take=take, give=give, back=back, again=again, urgent=1)
    path = write_mission(folder, STARTUP, apps=apps)
    watch = InversionWatch(shortest_ns)
    with Mission(path, console=Console(quiet=True), attachments=[watch]) as mission:
        mission.run_for(2)
        mission.shut_down_nodes()
        return list(mission.record.part(InversionRecord))


@pytest.mark.parametrize(
    ("kind", "create", "take"),
    [
        ("bin_sem", "bin_sem_create(LOCK, 1)", "take(lock)"),
        ("bin_sem", "bin_sem_create(LOCK, 1)", "timed_wait(lock, 1000)"),
        ("count_sem", "count_sem_create(LOCK, 1)", "take(lock)"),
    ],
)
def test_semaphore_used_as_a_lock_has_inversions(tmp_path: Path, kind: str, create: str, take: str) -> None:
    (found,) = inversions(tmp_path, kind, create, take)
    assert (found.victim, found.holder, found.others) == ("URGENT", "IDLE", (("MEDIUM", 80, 15_000_000),))
    assert found.waited_ns == 17_000_000  # IDLE has 2 ms of its own work left, which is not an inversion
    assert found.text == (
        "URGENT (priority 40) waited 17 ms for semaphore LOCK held by IDLE (priority 120) while MEDIUM (priority 80) "
        "ran for 15 ms"
    )


def test_mutex_inherits_priority(tmp_path: Path) -> None:
    assert inversions(tmp_path, "mut_sem", "mut_sem_create(LOCK)") == []


def test_semaphore_that_is_made_full_is_a_lock_from_its_first_take(tmp_path: Path) -> None:
    (found,) = inversions(tmp_path, is_lock=False)
    assert (found.victim, found.holder, found.waited_ns) == ("URGENT", "IDLE", 17_000_000)


@pytest.mark.parametrize("create", ["bin_sem_create(LOCK, 0)", "bin_sem_create(LOCK, 1)"])
def test_semaphore_that_another_task_gives_is_a_signal(tmp_path: Path, create: str) -> None:
    create = f"{create}; cfe.os.bin_sem_give(cfe.os.bin_sem_get_id_by_name(LOCK))"
    assert inversions(tmp_path, create=create, is_lock=False) == []


def test_semaphore_that_is_made_empty_is_a_lock_when_its_taker_has_given_it_back(tmp_path: Path) -> None:
    create = "bin_sem_create(LOCK, 0); cfe.os.bin_sem_give(cfe.os.bin_sem_get_id_by_name(LOCK))"
    assert len(inversions(tmp_path, create=create)) == 1


def test_shorter_inversions_are_not_kept(tmp_path: Path) -> None:
    assert len(inversions(tmp_path, shortest_ns=15_000_000)) == 1
    assert inversions(tmp_path, shortest_ns=15_000_001) == []

"""Possible preemptions while schedules are explored: before each call of an app, and after calls that release an
object."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from cfepy.attachment import Attachment
from cfepy.mission.call_points import GIVING
from cfepy.osal import Osal
from cfepy.pilot.pilot import fly
from cfepy.pilot.plan import RunPlan
from cfepy.sb import SoftwareBus
from cfepy.schedules.schedule import Schedule
from cfepy.tbl import TableServices

LETS_GO_TOO_EARLY = """
NUMBER = [0]

def worker(cfe, mutex):
    cfe.os.mut_sem_take(mutex)
    NUMBER[0] += 1
    mine = NUMBER[0]
    cfe.os.mut_sem_give(mutex)
    assert NUMBER[0] == mine, "somebody else counts on"

def main(cfe):
    mutex = cfe.os.mut_sem_create("NUMBER")
    for name in ("ONE", "TWO"):
        cfe.es.create_child_task(name, lambda: worker(cfe, mutex), 4096, 50)
    cfe.os.task_delay(100)
"""


@pytest.mark.parametrize("policy", ["random:{}", "pct:{}:2:60"])
def test_preemption_right_after_a_release_is_found(tmp_path: Path, policy: str) -> None:
    (tmp_path / "counting.py").write_text(LETS_GO_TOO_EARLY, encoding="utf-8")
    (tmp_path / "startup.scr").write_text(
        "CFE_APP, counting, main, COUNTING, 50, 16384, 0x0, 0;\n!\n", encoding="utf-8"
    )
    schedules = [Schedule.parse(policy.format(seed)) for seed in range(20)]
    found = [fly(RunPlan((str(tmp_path),), seconds=0.8, schedule=each)).results for each in schedules]
    assert any("somebody else counts on" in problem for results in found for problem in results.problems)
    assert not fly(RunPlan((str(tmp_path),), seconds=0.8)).results.problems


def test_calls_that_release_are_functions_of_services() -> None:
    known = {name for service in (Osal, SoftwareBus, TableServices) for name in dir(service)}
    assert known >= GIVING


class Listener(Attachment):
    """Keeps the notifications of the kernel's observer."""

    def __init__(self) -> None:
        self.told: list[tuple[str, str]] = []

    def begin(self, mission: Any) -> None:
        mission.kernel.watch(self)

    def called(self, subject: Any, call: str, args: tuple[Any, ...]) -> None:
        self.told.append(("called", call))

    def returned(self, subject: Any, call: str, args: tuple[Any, ...], result: Any) -> None:
        self.told.append(("returned", call))


LOCKS = """
import threading, time
lock = threading.RLock()
with lock:
    pass
"""


def test_observer_is_notified_of_calls_to_services_and_locks(tmp_path: Path) -> None:
    (tmp_path / "counting.py").write_text(LETS_GO_TOO_EARLY, encoding="utf-8")
    (tmp_path / "locking.py").write_text(LOCKS, encoding="utf-8")
    lines = (
        "CFE_APP, counting, main, COUNTING, 50, 16384, 0x0, 0;",
        "CFE_APP, locking.py, __main__, LOCKING, 50, 16384, 0, 0;",
    )
    (tmp_path / "startup.scr").write_text("\n".join([*lines, "!\n"]), encoding="utf-8")
    plan = RunPlan((str(tmp_path),), seconds=0.8, schedule=Schedule("at"))
    bare, listener = fly(plan), Listener()
    assert fly(plan, attachments=[listener]).trace == bare.trace
    told = listener.told
    for call in ("mut_sem_create", "mut_sem_take", "mut_sem_give", "__init__", "__enter__", "__exit__"):
        assert told.index(("called", call)) < told.index(("returned", call))

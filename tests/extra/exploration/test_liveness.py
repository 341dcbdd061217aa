"""Starving tasks, livelocked applications, and fair schedules, under which no task waits forever."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.exploration import Trial
from cfepy.monitors import Limits
from cfepy.pilot import RunPlan
from cfepy.rtos import Decision, Fair, Policy, Task
from cfepy.schedules import Schedule
from cfepy.status import UsageError
from cfepy.units import NS_PER_MS
from tests.mission.flights import write_mission

STARTUP = """
    CFE_APP, apps, HOG_Main,  HOG,  60, 16384, 0, 0;
    CFE_APP, apps, MEEK_Main, MEEK, 90, 16384, 0, 0;
    !
"""
STARVING = """
    def HOG_Main(cfe):
        cfe.es.run_loop()
        cfe.os.task_delay(500)
        for _ in range(5):
            cfe.psp.compute(20_000)
        cfe.os.task_delay(10000)

    def MEEK_Main(cfe):
        cfe.es.run_loop()
        while True:
            cfe.os.task_delay(10)
"""
LIVELOCK = """
    from cfepy.msg import Layout, Telemetry

    HELLO = Telemetry("HELLO", 0x0883, Layout("hello", []))

    def HOG_Main(cfe):
        cfe.es.run_loop()
        while True:
            cfe.os.task_delay(2)

    def MEEK_Main(cfe):
        cfe.es.run_loop()
        while True:
            cfe.os.task_delay(2)
            cfe.sb.transmit_msg(HELLO.packet())
"""


def failures(folder: Path, apps: str, limits: Limits) -> list[tuple[str, str, int | None]]:
    """Return kind, text and instant of failures by default in two virtual seconds."""
    plan = RunPlan((str(write_mission(folder, STARTUP, apps=apps)),), seconds=2)
    found = Trial(plan, liveness=limits).run(Schedule()).failures
    return [(each.kind, each.text, each.at_ns) for each in found]


def test_ready_task_that_does_not_run_is_starved(tmp_path: Path) -> None:
    ((kind, text, at_ns),) = failures(tmp_path, STARVING, Limits(starved_ns=80 * NS_PER_MS))
    assert kind == "starved"
    assert text.startswith("MEEK (priority 90) was ready for ")
    assert text.endswith("; HOG (priority 60) ran last")
    assert at_ns == 1_130_000_000  # HOG begins at 1.05 s


def test_shorter_wait_is_not_starvation(tmp_path: Path) -> None:
    assert failures(tmp_path, STARVING, Limits(starved_ns=100 * NS_PER_MS)) == []


def test_starvation_until_the_end_of_the_run_is_reported(tmp_path: Path) -> None:
    for_ever = STARVING.replace("range(5)", "range(5000)")
    ((kind, text, _),) = failures(tmp_path, for_ever, Limits(starved_ns=300 * NS_PER_MS))
    assert (kind, text.partition(" was ready")[0]) == ("starved", "MEEK (priority 90)")


def test_application_that_runs_without_messages_is_livelocked(tmp_path: Path) -> None:
    ((kind, text, at_ns),) = failures(tmp_path, LIVELOCK, Limits(livelock_ns=500 * NS_PER_MS))
    assert kind == "livelock"
    assert "neither sent nor took a message" in text
    assert at_ns is not None
    assert at_ns > 1_000_000_000


def test_rarely_running_application_is_idle(tmp_path: Path) -> None:
    assert failures(tmp_path, LIVELOCK.replace("task_delay(2)", "task_delay(20)"), Limits(0, 500 * NS_PER_MS)) == []


class _Last(Policy):
    """Always the last of the candidates."""

    def choose(self, decision: Decision) -> int:
        return decision.width - 1


def test_fair_schedule_limits_how_often_a_task_is_passed_over() -> None:
    tasks = [Task(name, number, None, 50) for number, name in enumerate("ABC")]
    fair = Fair(_Last(), 3)
    ran = "".join("ABC"[fair.choose(Decision(number, 0, tasks, False, False, None))] for number in range(12))
    assert ran == "CCCABCCABCCA"
    for name in "ABC":
        assert f"{name}" in ran
        assert all(len(part) <= 4 for part in ran.split(name))


def test_a_fair_schedule_is_a_text() -> None:
    schedule = Schedule.parse("random:3:any:fair=20:hold=1ms")
    assert (schedule.fair, schedule.text()) == (20, "random:3:any:fair=20:hold=1ms")
    assert isinstance(schedule.policy(), Fair)
    for wrong in ("random:3:fair=0", "random:3:fair=x"):
        with pytest.raises(UsageError, match="at least 1"):
            Schedule.parse(wrong)

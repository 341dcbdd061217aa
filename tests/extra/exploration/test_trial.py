"""A trial flies a mission under a schedule and reports failures."""

from __future__ import annotations

import pickle
from dataclasses import replace
from pathlib import Path

import pytest

from cfepy.extra.exploration.trial import Trial
from cfepy.extra.exploration.verdict import (
    DEADLINE,
    DEADLOCK,
    DIED,
    ENDED,
    EVENT,
    EXPECTATION,
    INVARIANT,
    RAISED,
    RESET,
    RESULTS,
    Verdict,
)
from cfepy.pilot.plan import RunPlan
from cfepy.schedules import Schedule
from cfepy.status import UsageError
from tests.extra.exploration import missions

PAID = """
    invariants: {all paid: {topic: /total, holds: "msg.data == 6"}}
    results: {/total: last}
"""
LOST = Schedule.parse("at:4=1,7=1")


def trial(folder: Path, seconds: float = 0.7, **plan: object) -> Trial:
    return Trial(replace(RunPlan((str(folder),), seconds=seconds), **plan))  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def bank(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return missions.write(tmp_path_factory.mktemp("bank"), {"BANK": missions.LOST_UPDATE}, PAID)


def test_default_schedule_passes_and_counts_decisions(bank: Path) -> None:
    verdict, results, *_ = trial(bank).fly(Schedule())
    assert not verdict.failed
    assert not verdict.trouble
    assert verdict.decisions > 10
    assert verdict.deviations == ()
    assert [(each.name, each.text) for each in results] == [("/total (last)", "data: 6")]


def test_failure_is_reproduced_on_threads_and_greenlets(bank: Path) -> None:
    results = trial(bank).fly(Schedule()).results
    verdict = trial(bank).against(results).run(LOST)
    assert [failure.kind for failure in verdict.failures] == [INVARIANT, RESULTS]
    assert verdict.failures[0].text == "msg.data == 6 does not hold; msg.data is 3"
    assert verdict.failures[0].who == "all paid"
    assert verdict.failures[1].text == "data: 3; under fifo data: 6"
    assert verdict.preemptions == 2
    assert verdict.deviations == ((4, 1), (7, 1))
    assert trial(bank).against(results).run(LOST) == verdict
    assert trial(bank, tasks="greenlet").against(results).run(LOST) == verdict


def test_trials_and_verdicts_can_be_pickled(bank: Path) -> None:
    results = trial(bank).fly(Schedule()).results
    sent = pickle.loads(pickle.dumps(trial(bank).against(results)))
    verdict = sent.run(LOST)
    assert Verdict.from_dict(verdict.to_dict()) == verdict
    assert pickle.loads(pickle.dumps(verdict)) == verdict


def test_command_replays_its_schedule(bank: Path) -> None:
    assert trial(bank).command(LOST) == f"cfepy run --for 0.7 --schedule {LOST} {bank}"


def test_a_deadlock_is_a_failure(tmp_path: Path) -> None:
    locks = missions.write(tmp_path, {"LOCKS": missions.LOCK_ORDER})
    assert not trial(locks).run(Schedule()).failed
    failures = trial(locks).run(Schedule.parse("at:4=1,8=1")).failures
    assert [(failure.kind, failure.who) for failure in failures] == [(DEADLOCK, "LOCKS")]
    assert "held by LOCKS.locks.2.2" in failures[0].text


def test_exception_in_a_thread_is_a_failure_with_its_traceback(tmp_path: Path) -> None:
    stock = missions.write(tmp_path, {"STOCK": missions.CHECK_THEN_ACT})
    assert not trial(stock).run(Schedule()).failed
    (failure,) = trial(stock).run(Schedule.parse("at:4=1,7=1")).failures
    assert (failure.kind, failure.who) == (RAISED, "stock")
    assert failure.text == "IndexError: pop from empty list (stock.py:11)"
    assert failure.detail.startswith("Traceback (most recent call last):")
    assert "items.pop()" in failure.detail


APPS = """
def Dies(cfe):
    cfe.evs.register()
    raise ValueError("number 17")


def GivesUp(cfe):
    cfe.es.exit_app(3)


def Waits(cfe):
    while cfe.es.run_loop(1):
        cfe.os.task_delay(100)


def Complains(cfe):
    cfe.evs.register()
    cfe.evs.send_err(5, "something is wrong")
    while cfe.es.run_loop(1):
        cfe.os.task_delay(100)


def Slips(cfe):
    cfe.evs.register()
    cfe.es.wait_for_startup_sync(1000)
    cfe.sb.transmit_msg(cfe.msg.telemetry(0x0890, bytes(4)))
    for number in range(3):
        cfe.os.task_delay(100 + number)
        cfe.evs.send_err(5, "late for the %d. time" % number)
    while cfe.es.run_loop(1):
        cfe.os.task_delay(1000)
"""


HALF_MADE = """
import rospy
from std_msgs.msg import String


class Echo:
    def __init__(self):
        rospy.Subscriber("/in", String, self.on_message)
        self.prefix = rospy.get_param("~prefix", "echo ")

    def on_message(self, message):
        rospy.loginfo(self.prefix + message.data)


rospy.init_node("echo")
rospy.Publisher("/in", String, latch=True, queue_size=1).publish("a")
Echo()
rospy.sleep(0.2)
"""


@pytest.mark.slow
def test_message_may_arrive_before_the_constructor_ends(tmp_path: Path) -> None:
    echo = missions.write(tmp_path, {"ECHO": HALF_MADE})
    assert not trial(echo, 0.8).run(Schedule()).failed
    found = [trial(echo, 0.8).run(Schedule("random", seed)).failures for seed in range(10)]
    assert {failure.text for failures in found for failure in failures} == {
        "AttributeError: 'Echo' object has no attribute 'prefix' (echo.py:11)"
    }


MUTEXES = """
def Ring(cfe):
    power, bus = (cfe.os.mut_sem_create(name) for name in ("power", "bus"))

    def child(first, second):
        cfe.os.mut_sem_take(first)
        cfe.os.mut_sem_take(second)
        cfe.os.mut_sem_give(second)
        cfe.os.mut_sem_give(first)

    cfe.es.create_child_task("radio", lambda: child(power, bus), 4096, 50)
    cfe.es.create_child_task("heater", lambda: child(bus, power), 4096, 50)
    while cfe.es.run_loop(1):
        cfe.os.task_delay(100)
"""


@pytest.mark.slow
def test_circle_of_mutexes_is_one_deadlock_for_any_last_waiter(tmp_path: Path) -> None:
    (tmp_path / "apps.py").write_text(MUTEXES, encoding="utf-8")
    (tmp_path / "startup.scr").write_text("CFE_APP, apps, Ring, RING, 50, 8192, 0, 0;\n!\n", encoding="utf-8")
    verdicts = [trial(tmp_path, 1.0).run(Schedule("random", seed)) for seed in range(30)]
    found = [verdict.failures[0] for verdict in verdicts if verdict.failed]
    assert {(failure.kind, failure.who, failure.text) for failure in found} == {
        (DEADLOCK, "RING", "radio waits for mutex bus, held by heater; heater waits for mutex power, held by radio")
    }
    assert {failure.task for failure in found} == {"heater"}, "the task that the text names last"
    assert all(failure.detail.count(" at apps.py:7, since ") == 2 for failure in found)


def app(tmp_path: Path, name: str, action: int = 0, yaml: str = "") -> Trial:
    if yaml:
        (tmp_path / "mission.yaml").write_text(yaml, encoding="utf-8")
    (tmp_path / "apps.py").write_text(APPS, encoding="utf-8")
    (tmp_path / "startup.scr").write_text(
        f"CFE_APP, apps, {name}, {name.upper()}, 50, 8192, 0, {action};\n!\n", encoding="utf-8"
    )
    return trial(tmp_path, 1.0)


def test_death_of_an_app_is_a_failure(tmp_path: Path) -> None:
    failure, reset = app(tmp_path, "Dies", action=1).run(Schedule()).failures
    assert (failure.kind, failure.who, failure.text) == (DIED, "DIES", "ValueError: number 17 (apps.py:4)")
    assert failure.at_ns == 550_000_000
    assert 'raise ValueError("number 17")' in failure.detail
    assert (reset.kind, reset.text) == (RESET, "DIES: ValueError: number 17 (apps.py:4)")


def test_app_that_ends_with_an_error_is_a_failure(tmp_path: Path) -> None:
    (failure,) = app(tmp_path, "GivesUp").run(Schedule()).failures
    assert (failure.kind, failure.who) == (ENDED, "GIVESUP")


def test_missed_deadline_is_a_failure(tmp_path: Path) -> None:
    yaml = "deadlines: {apps: {SLIPS: {period: 100 ms, jitter: 100 us}}}\n"
    (failure,) = replace(app(tmp_path, "Slips", yaml=yaml), events="none").run(Schedule()).failures
    assert (failure.kind, failure.who) == (DEADLINE, "SLIPS")
    assert failure.text == "period 100 ms +- 100 us was missed"
    assert failure.at_ns is not None
    assert 700_000_000 < failure.at_ns < 900_000_000


def test_failures_are_sorted_by_time_and_grouped_without_numbers(tmp_path: Path) -> None:
    yaml = 'invariants: {nothing: {packet: 0x0890, holds: "False"}}\n'
    violated, event = app(tmp_path, "Slips", yaml=yaml).run(Schedule()).failures
    assert (violated.kind, event.kind) == (INVARIANT, EVENT)
    assert event.text == "ERROR event 5: late for the 0. time"


@pytest.mark.parametrize(("level", "count"), [("error", 1), ("critical", 0), ("none", 0)])
def test_level_selects_the_events_that_are_failures(tmp_path: Path, level: str, count: int) -> None:
    failures = replace(app(tmp_path, "Complains"), events=level).run(Schedule()).failures
    assert len(failures) == count
    for failure in failures:
        assert (failure.kind, failure.text) == (EVENT, "ERROR event 5: something is wrong")


def test_failed_step_of_the_script_is_a_failure(tmp_path: Path) -> None:
    script = tmp_path / "checks.txt"
    script.write_text("expect app COMPLAINS RUNNING within 1\nexpect event COMPLAINS 6 within 1\n", encoding="utf-8")
    found = app(tmp_path, "Complains")
    found = replace(found, plan=replace(found.plan, script=str(script), seconds=None), events="none")
    (failure,) = found.run(Schedule()).failures
    assert (failure.kind, failure.who) == (EXPECTATION, "checks.txt:2")


def test_unreadable_mission_has_no_verdict(tmp_path: Path) -> None:
    with pytest.raises(UsageError):
        trial(tmp_path / "nothing").run(Schedule())


def test_error_of_cfepy_is_not_a_failure(bank: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object, **__: object) -> object:
        raise AssertionError("a bug in cfepy")

    monkeypatch.setattr("cfepy.extra.exploration.trial.fly", broken)
    verdict = trial(bank).run(Schedule())
    assert not verdict.failed
    assert "a bug in cfepy" in verdict.trouble


def test_verdict_has_the_widths_of_a_systematic_search(bank: Path) -> None:
    verdict = replace(trial(bank), keep_widths=True).run(Schedule("at"))
    assert len(verdict.widths) == verdict.decisions
    assert all(abs(width) > 1 for width in verdict.widths)


@pytest.mark.parametrize("action", [0, 1])
def test_injected_crash_is_not_a_failure(tmp_path: Path, action: int) -> None:
    app(tmp_path, "Waits", action)
    (tmp_path / "plan.yaml").write_text("faults: [{crash: WAITS, at: 0.7}]", encoding="utf-8")
    plan = RunPlan((str(tmp_path),), seconds=1.0, faults=str(tmp_path / "plan.yaml"))
    assert Trial(plan).run(Schedule()).failures == ()


def test_injected_crash_of_a_node_is_not_a_failure(tmp_path: Path) -> None:
    node = missions.write(tmp_path, {"ECHO": HALF_MADE})
    (node / "plan.yaml").write_text("faults: [{crash: ECHO, at: 0.6}]", encoding="utf-8")
    plan = RunPlan((str(node),), seconds=1.0, faults=str(node / "plan.yaml"))
    assert Trial(plan).run(Schedule()).failures == ()


def test_task_that_does_not_give_up_the_cpu_is_a_failure_of_its_schedule(tmp_path: Path) -> None:
    (tmp_path / "startup.scr").write_text("CFE_APP, app, main, SPIN, 50, 16384, 0x0, 0;\n!\n", encoding="utf-8")
    (tmp_path / "app.py").write_text("def main(cfe):\n    while True:\n        pass\n", encoding="utf-8")
    plan = RunPlan((str(tmp_path),), seconds=1, stall=0.2)
    found = Trial(plan).run(Schedule())
    assert [failure.kind for failure in found.failures] == ["stalled"]
    assert found.failures[0].group == "stalled|SPIN|SPIN does not give up the CPU (app.py:2)"
    assert found.failures[0].detail.endswith("app.py:2 in main: while True:")
    assert found.trace == ""

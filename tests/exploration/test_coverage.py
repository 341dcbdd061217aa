"""What runs cover: how it is kept, counted and told, and what a run of a mission comes to."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from cfepy.exploration.coverage import LINES, MOST, OUTCOMES, USES, Coverage, Covered, ThingUse, kept_of, number_of_line
from cfepy.exploration.trial import Trial, Tried
from cfepy.exploration.verdict import Verdict
from cfepy.pilot import RunPlan
from cfepy.rtos import Schedule
from tests.exploration import missions

FILE = "/robot/nodes/arm.py"
BANK = """
    import sys
    import threading

    import rospy

    lock = threading.Lock()
    balance = 0


    def read():
        with lock:
            return balance


    def pay():
        global balance
        before = read()
        with lock:
            balance = before + 1
        if before < 0:
            rospy.logwarn("never")


    rospy.init_node("bank")
    threads = [threading.Thread(target=pay) for _ in range(2)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    if balance != 2:
        sys.exit(f"the balance is {balance}")
"""
MISSED = Schedule.parse("aims:0:BANK.1@bank.py/11=BANK.2@bank.py/18")


@pytest.fixture(scope="module")
def trial(tmp_path_factory: pytest.TempPathFactory) -> Trial:
    folder = missions.write(tmp_path_factory.mktemp("bank"), {"BANK": BANK})
    return Trial(RunPlan((str(folder),), seconds=0.6, tasks="greenlet"), usual=frozenset())


@pytest.fixture(scope="module")
def fifo(trial: Trial) -> Tried:
    return trial.fly(Schedule("at"))


def test_of_a_run_each_thing_is_kept_once_and_not_what_is_usual() -> None:
    found = [Covered("locks", 3, 7), Covered("locks", 3, 9), Covered("locks", 1, 8), Covered(OUTCOMES, 1, 9)]
    assert kept_of(found, frozenset([("locks", 1)])) == (Covered("locks", 3, 7), Covered(OUTCOMES, 1, 9))
    many = [Covered("locks", number, 0) for number in range(MOST + 5)]
    assert [each.number for each in kept_of(reversed(many))] == list(range(MOST))


def test_what_is_new_rare_and_never_executed_is_known() -> None:
    usual = frozenset([(LINES, number_of_line(FILE, 1)), ("locks", 9)])
    coverage = Coverage({FILE: [1, 2, 3, 5, 6, 7]}, usual)
    once = [Covered("locks", 4, 0), Covered(LINES, number_of_line("/copy/nodes/arm.py", 2), 5)]
    assert coverage.take(0, once) == once
    assert coverage.take(1, [Covered("locks", 4, 0), Covered("locks", 5, 0)]) == [Covered("locks", 5, 0)]
    assert coverage.take(2, [Covered("locks", 9, 0)]) == []
    assert coverage.rarity(Covered("locks", 4, 0)) == 0.5
    assert coverage.has(("locks", 9))
    assert not coverage.has(("locks", 8))
    assert coverage.pairs == {"locks": 3}
    assert coverage.lines() == [
        "covered: 3 ordered pairs (3 of locks), 0 outcomes, 2 of 6 lines; the last new one in schedule 2 of 3",
        "never executed: arm.py:3,5-7",
    ]
    plain = coverage.to_dict()
    assert (plain["never"], plain["last_new"], plain["lines"]) == ({FILE: [3, 5, 6, 7]}, {"locks": 1, "lines": 0}, 2)


def test_a_verdict_goes_through_a_file_with_what_its_run_covers() -> None:
    use = ThingUse("locks", "self.lock (bank.py:4)", "BANK.1", "has", "bank.py", 12, False)
    verdict = Verdict(Schedule("random", 3), covered=(Covered("lines", 5, 9), Covered("locks", 4, 2)), uses=(use,))
    assert Verdict.from_dict(json.loads(json.dumps(verdict.to_dict()))) == verdict


def test_a_run_is_the_same_when_it_is_looked_at(trial: Trial) -> None:
    for schedule in (Schedule("random", 3), Schedule("random", 3, points="attributes")):
        seen, plain = (replace(trial, usual=usual).run(schedule) for usual in (frozenset(), None))
        assert seen.trace == plain.trace
        assert seen.covered
        assert not plain.covered


def test_pairs_outcomes_and_lines_of_a_mission(trial: Trial, fifo: Tried) -> None:
    coverage = Coverage.beside(fifo.verdict.covered, fifo.code)
    assert coverage.lines()[1] == "never executed: bank.py:21,31"
    first, then = (
        ThingUse("locks", "lock (bank.py:6)", f"BANK.{task}", "has", "bank.py", line, False)
        for task, line in ((1, 11), (2, 11))
    )
    assert {first, then} < set(fifo.verdict.uses)
    assert not coverage.has(first.before(then))
    verdict = replace(trial, usual=coverage.usual).run(MISSED)
    assert [each.who for each in verdict.failures] == ["BANK"]
    new = coverage.take(0, verdict.covered)
    assert {each.kind for each in new} == {LINES, OUTCOMES, "locks", "variables", USES}
    assert coverage.lines()[1] == "never executed: bank.py:21"
    assert coverage.counts()[OUTCOMES] == 2


def test_what_needs_no_more_is_not_told(trial: Trial, fifo: Tried) -> None:
    usual = frozenset(each[:2] for each in fifo.verdict.covered)
    again = replace(trial, usual=usual).run(Schedule("at"))
    assert (again.covered, again.uses) == ((), ())


def test_code_that_is_gone_has_no_lines(tmp_path: Path) -> None:
    assert Coverage.beside([], [(str(tmp_path / "gone.py"), True)]).code == {}

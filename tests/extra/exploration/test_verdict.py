"""Failures are grouped by their common features."""

from __future__ import annotations

import json
from dataclasses import asdict, fields

import pytest

from cfepy.extra.exploration.verdict import DIED, EVENT, INVARIANT, RESULTS, Failure, Finding, Findings, Verdict
from cfepy.schedules import Schedule


def died(text: str) -> Failure:
    return Failure(DIED, "ARM", text, 1)


def test_numbers_are_not_part_of_the_group() -> None:
    assert (
        died("ValueError: 17 of 20.5 at 0x1F (arm.py:12)").group
        == died("ValueError: 3 of 1e-9 at 0x2 (arm.py:12)").group
    )


def test_values_in_quotes_are_not_part_of_the_group() -> None:
    assert died("KeyError: 'left' (arm.py:12)").group == died("KeyError: 'right' (arm.py:12)").group
    assert died("it isn't so").group != died("it isn't there").group


def test_cause_replaces_the_text_in_the_group() -> None:
    assert (
        Failure(EVENT, "ARM", "joint left", cause="event 5").group
        == Failure(EVENT, "ARM", "x", 7, cause="event 5").group
    )
    assert Failure(EVENT, "ARM", "x", cause="event 5").group != Failure(EVENT, "ARM", "x", cause="event 6").group


def test_source_line_is_part_of_the_group() -> None:
    assert died("KeyError: 1 (arm.py:12)").group != died("KeyError: 1 (arm.py:13)").group


def test_kind_and_task_are_part_of_the_group() -> None:
    groups = {Failure(kind, who, "x").group for kind in (DIED, INVARIANT) for who in ("A", "B")}
    assert len(groups) == 4


def test_plain_data_has_the_schedule_as_text() -> None:
    schedule = Schedule.parse("pct:3:2:60:hold=1ms")
    verdict = Verdict(schedule, (died("x"),), deviations=((3, 1),), widths=(2, -2))
    plain = verdict.to_dict()
    assert list(plain) == [each.name for each in fields(Verdict)]
    assert plain["schedule"] == "pct:3:2:60:hold=1ms"
    assert plain["failures"] == (asdict(died("x")),)
    assert Verdict.from_dict(json.loads(json.dumps(plain))) == verdict


def test_failure_is_found_once_with_its_first_schedule() -> None:
    findings = Findings(Verdict(Schedule()))
    bad = Verdict(Schedule("random", 2), (died("x"), Failure(RESULTS, "/total", "other")))
    assert not findings.take(0, Verdict(Schedule("random", 0)))
    assert findings.take(2, bad)
    assert findings.take(7, bad)
    (finding,) = findings.all()
    assert (finding.number, finding.numbers) == (2, [2, 7])
    assert finding.others == ("results differ: /total: other",)


@pytest.mark.parametrize(
    ("numbers", "done", "text"),
    [
        ([4, 6], 60, "2 of 60 schedules, first number 4; one in 30"),
        ([3], 8, "1 of 8 schedules, first number 3; one in 8"),
        (list(range(54)), 100, "54 of 100 schedules, first number 0; one in 1.9"),
        ([0, 1], 2, "2 of 2 schedules, first number 0; one in 1"),
        ([9], 12_345, "1 of 12345 schedules, first number 9; one in 12,345"),
    ],
)
def test_frequency_counts_the_schedules_after_the_last_failure(numbers: list[int], done: int, text: str) -> None:
    finding = Finding(died("x"), numbers[0], Verdict(Schedule()), numbers)
    assert finding.frequency(done) == text


def test_runs_with_the_fewest_preemptions_are_shrunk() -> None:
    findings = Findings(Verdict(Schedule()))
    for number, preemptions in enumerate((5, 2, 3, 7, 4)):
        findings.take(number, Verdict(Schedule("random", number), (died("x"),), preemptions=preemptions))
    (finding,) = findings.all()
    assert finding.verdict.schedule == Schedule("random", 0)
    assert [each.schedule.seed for each in finding.simplest] == [1, 2, 4]


def test_failure_under_fifo_does_not_hide_others() -> None:
    known, new = died("always"), died("sometimes")
    findings = Findings(Verdict(Schedule(), (known,)))
    assert not findings.take(0, Verdict(Schedule("random", 0), (known,)))
    assert findings.take(1, Verdict(Schedule("random", 1), (known, new)))
    assert [(each.failure.text, each.in_reference) for each in findings.all()] == [
        ("always", True),
        ("sometimes", False),
    ]


def test_errors_of_cfepy_are_counted_separately() -> None:
    findings = Findings(Verdict(Schedule()))
    findings.take(0, Verdict(Schedule("random", 0), trouble="Traceback"))
    assert findings.all() == []
    assert [each.schedule for each in findings.troubles] == [Schedule("random", 0)]

"""The extent of an exploration."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.exploration.extent import OTHER, Breadth, PointCounter, kind_of
from cfepy.extra.exploration.trial import Trial
from cfepy.extra.exploration.verdict import Verdict
from cfepy.pilot import RunPlan
from cfepy.rtos import Policy
from cfepy.schedules import Schedule

LOCKS = str(Path(__file__).parents[2] / "quality" / "missions" / "lock_order")


def looked(*texts: str, tasks: int = 4) -> Breadth:
    found = Breadth({"locks": 3, "messages": 5}, tasks)
    for number, text in enumerate(texts):
        found.take(Verdict(Schedule.parse(text), trace=f"{number % 2}", decisions=10))
    return found


def test_bound_matches_pct() -> None:
    found = looked("pct:0:1:10", "pct:1:1:10", "pct:2:2:10", "random:3")
    assert found.chance(1) == pytest.approx(1 - (1 - 1 / 4) ** 2)
    assert found.chance(2) == pytest.approx(1 / 40)
    assert found.chance(3) == 0
    assert len(found.orders) == 2


def test_the_longest_run_counts() -> None:
    found = looked("pct:0:2:7")
    assert found.steps == 10
    assert looked("pct:0:2:70").steps == 70


def test_one_task_has_one_order() -> None:
    assert looked("pct:0:1:10", tasks=1).chance(1) == 1


def test_extent_is_reported_in_a_few_lines() -> None:
    assert looked("pct:0:1:10").lines() == [
        "1 order",
        "under fifo others can get in at 8 points: 5 at messages, 3 at locks",
        "probability that a bug was found, at least: 0.25 at depth 1 (PCT's bound for 4 tasks and 10 points)",
    ]
    assert looked("random:0").lines()[1:] == ["under fifo others can get in at 8 points: 5 at messages, 3 at locks"]


def test_points_are_counted_by_kind_of_call() -> None:
    plan = RunPlan((LOCKS,), seconds=1.3, tasks="greenlet")
    counter = PointCounter(Policy())
    counted = Trial(plan).fly(Schedule("at"), policy=counter)
    assert sum(counter.kinds.values()) == counted.verdict.decisions
    assert counter.kinds["locks"] > 5
    assert counter.kinds["messages"] > 10
    assert counted.verdict.trace == Trial(plan).run(Schedule("at")).trace
    assert counted.tasks > 10


def test_call_of_an_unknown_kind_counts_as_other() -> None:
    assert kind_of(None) == OTHER

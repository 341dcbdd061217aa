"""Races between callbacks of ROS 2 nodes, planted in small missions, are found by exploring.

`answer_before_the_note` has the form of ros2/rclpy#1123: a call that is noted after it was sent never completes.
"""

from __future__ import annotations

from pathlib import Path

import pytest

import cfepy

pytestmark = pytest.mark.slow
RACES = Path(__file__).parent / "races"
FAILURES = {
    "answer_before_the_note": "a future never completes",
    "count_in_a_reentrant_group": "an update was lost",
    "late_joiner": "the map never came",
    "transition_against_a_timer": "'NoneType' object has no attribute 'publish'",
}
SEEDS = 120


def test_every_mission_is_listed() -> None:
    assert sorted(path.name for path in RACES.iterdir() if (path / "startup.scr").exists()) == sorted(FAILURES)


@pytest.mark.parametrize("name", FAILURES)
def test_mission_passes_in_the_usual_order(name: str) -> None:
    assert not cfepy.run(str(RACES / name), seconds=2).problems


@pytest.mark.parametrize("name", FAILURES)
def test_explore_finds_the_race(name: str) -> None:
    found = cfepy.explore(str(RACES / name), seeds=SEEDS, seconds=2, jobs=1, shrink=0, until_failure=True)
    assert [FAILURES[name] in each.title for each in found.failures] == [True]

"""Tests with @given: missions of their own for each example, small failures, and the command that does one again."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.testing.conftest import Suite, given_verbatim, told_command

BIG = """
from hypothesis import given, settings
from cfepy.testing.strategies import messages, schedules

@settings(max_examples=20, derandomize=True, database=None, deadline=None)
@given(message=messages("std_msgs/Int32"), schedule=schedules())
def test_small(mission, message, schedule):
    flight = mission("talk", schedule=schedule)
    flight.run_until_operational()
    flight.publish("/jump", message)
    flight.expect_message("/count", lambda count: 0 <= count.data < 1000, data=message.data, within=0.05)
"""


@pytest.fixture
def failed(suite: Suite) -> pytest.RunResult:
    """A run of a suite in which messages from 1000 on and below 0 are too much."""
    result = suite(BIG)
    result.assert_outcomes(failed=1)
    return result


def test_the_failing_example_is_small(failed: pytest.RunResult) -> None:
    text = failed.stdout.str()
    assert re.search(r"message=data: (1000|-1),", text)
    assert re.search(r"schedule='fifo'", text)


def test_the_command_fails_in_the_same_way(failed: pytest.RunResult, missions: Path) -> None:
    command = told_command(failed)
    assert "--cfepy-example" in command
    again = given_verbatim(command, missions)
    assert again.returncode == 1
    said = [re.findall(r"E +instead: .*|E +message=.*", text) for text in (failed.stdout.str(), again.stdout)]
    assert said[0] == said[1] != []


def test_a_journal_of_the_failing_example_is_kept(suite: Suite, missions: Path) -> None:
    suite(BIG, "--cfepy-record", "kept").assert_outcomes(failed=1)
    assert [each.name for each in (missions / "kept").iterdir()] == ["test_it.py-test_small.cfepy"]


def test_each_example_has_its_own_missions(suite: Suite) -> None:
    result = suite(
        """
        from hypothesis import given, settings
        from hypothesis import strategies as st

        kept = []

        class TestMethods:
            @settings(max_examples=4, deadline=None)
            @given(number=st.integers())
            def test_it(self, mission, number):
                assert all(flight.closed for flight in kept)
                kept.append(mission("talk"))
                assert kept[-1].now == 0

        def test_there_were_some():
            assert len(kept) == 4
            assert all(flight.closed for flight in kept)
        """
    )
    result.assert_outcomes(passed=2)


def test_an_example_that_is_none(suite: Suite) -> None:
    suite(BIG, "--cfepy-example", "nonsense").stdout.fnmatch_lines(["*is no example; take it as the failure told it*"])

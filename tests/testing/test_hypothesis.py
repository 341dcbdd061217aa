"""Tests with @given: a separate mission for each example, small failures, and the command that repeats one."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.testing.conftest import Suite, given_verbatim, told_command

BIG = """
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from cfepy.testing.strategies import messages, schedules

@settings(max_examples=20, derandomize=True, database=None, deadline=None, phases=[Phase.generate, Phase.shrink])
@given(message=messages("std_msgs/Int32", data=st.integers(0, 200)), schedule=schedules())
def test_small(mission, message, schedule):
    flight = mission("talk", schedule=schedule, tasks="greenlet")
    flight.run_until_operational()
    flight.publish("/jump", message)
    flight.expect_message("/count", lambda count: count.data < 100, data=message.data, within=0.05)
"""


@pytest.mark.slow
def test_failing_example_is_small_and_can_be_repeated(suite: Suite, missions: Path) -> None:
    result = suite(BIG)
    result.assert_outcomes(failed=1)
    text = result.stdout.str()
    assert re.search(r"message=data: 100,", text)
    assert re.search(r"schedule='fifo'", text)
    assert "hypothesis_tests.py" not in text
    command = told_command(result)
    assert "--cfepy-example" in command
    again = given_verbatim(command, missions)
    assert again.returncode == 1
    assert f"to reproduce: {command}" in again.stdout
    said = [re.findall(r"E +instead: .*", each) for each in (text, again.stdout)]
    assert said[0] == said[1] != []


@pytest.mark.slow
def test_a_journal_of_the_failing_example_is_kept(suite: Suite, missions: Path) -> None:
    result = suite(
        """
        from hypothesis import given, settings
        from hypothesis import strategies as st

        @settings(max_examples=4, database=None, deadline=None)
        @given(number=st.integers(0, 3))
        def test_it(mission, number):
            mission("talk").run_for(0.1)
            assert number < 3
        """,
        "--cfepy-record",
        "kept",
    )
    result.assert_outcomes(failed=1)
    assert [each.name for each in (missions / "kept").iterdir()] == ["test_it.py-test_it.cfepy"]


def test_invalid_folder_for_journals_is_refused(suite: Suite, missions: Path) -> None:
    (missions / "kept").write_text("", encoding="utf-8")
    result = suite("def test_it(mission):\n    mission('talk')\n", "--cfepy-record", "kept")
    result.assert_outcomes(errors=1)
    result.stdout.fnmatch_lines(["*UsageError: kept: --cfepy-record: cannot be made: File exists; name a folder*"])


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


def test_invalid_example_is_refused(suite: Suite) -> None:
    suite(BIG, "--cfepy-example", "nonsense").stdout.fnmatch_lines(
        ["*not a valid example; copy the string printed with the failure*"]
    )

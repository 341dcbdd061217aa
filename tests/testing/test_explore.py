"""@explore: a race is found, shrunk, reported, and found again by the reported command."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

from cfepy.extra.exploration import Shrinker, Trial, budget_of, in_tests
from cfepy.extra.exploration.in_tests import MORE, schedules_of
from cfepy.extra.exploration.verdict import Findings, Verdict
from cfepy.journal import read_journal, replay
from cfepy.pilot import RunPlan
from cfepy.schedules import Schedule
from cfepy.status import UsageError
from cfepy.testing import explore
from cfepy.units import NS_PER_S
from tests.testing.conftest import Suite, given_verbatim, told_command

RACE = """
from cfepy.testing import explore

@explore(seeds=60, policy={policy!r}, shrink={shrink})
def test_total(mission):
    mission("race").expect_message("/total", data=6, within=0.8)
"""


@pytest.mark.slow
@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_race_is_found_shrunk_and_reproduced(suite: Suite, missions: Path, tasks: str) -> None:
    result = suite(RACE.format(policy="random", shrink=200), "--cfepy-tasks", tasks, "--cfepy-record", "kept")
    result.assert_outcomes(failed=1)
    text = result.stdout.str()
    assert re.search(r"failed under schedule \d+ of 60, random:\d+", text)
    shortest = re.search(r"the shortest schedule that fails in this way, after \d+ runs: moves:(\S+)", text)
    assert shortest is not None
    assert shortest[1].count("=") <= 3
    assert 1 <= len(re.findall("=== (?:PREEMPTED|NOT FIRST|AFTER)", text)) <= shortest[1].count("=")
    assert re.search(r"time, s +.*RACY", text)
    assert re.findall("to reproduce: (.*)", text) == [told_command(result)] * 2  # with the error and at the end
    check_command(text, told_command(result), missions)
    check_journal(missions / "kept", shortest[1])


def check_command(text: str, command: str, folder: Path) -> None:
    """Check that the reported command fails in the same way."""
    again = given_verbatim(command, folder)
    assert again.returncode == 1
    instead = [re.findall(r"E +instead: (.*)", each) for each in (text, again.stdout)]
    assert instead[0] == instead[1] != []


def check_journal(folder: Path, moves: str) -> None:
    """Check that one journal is kept, the shrunk run's, and that it replays."""
    (path,) = folder.iterdir()
    journal = read_journal(path)
    assert journal.plan.schedule.text() == f"moves:{moves}"
    assert replay(journal).verdict.same


@pytest.mark.slow
def test_pct_finds_the_race_without_shrinking(suite: Suite) -> None:
    result = suite(RACE.format(policy="pct", shrink=0))
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["failed under schedule * of 60, pct:*", "*--cfepy-schedule pct:*"])
    expected = re.search(r"of 60, pct:\d+:3:(\d+)", result.stdout.str())
    assert expected is not None  # a test has its own length, and not the 1000 decisions of a schedule's default
    assert int(expected[1]) < 200
    result.stdout.no_fnmatch_line("*the shortest schedule*")


@pytest.mark.slow
def test_data_race_fails_a_test_that_would_pass(suite: Suite) -> None:
    test = RACE.format(policy="random", shrink=10).replace("explore(", "explore(races=True, ")
    result = suite(test, "--cfepy-schedules", "1")
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*data race: *: nothing orders them", "*came first, then *"])
    assert told_command(result)


def test_fifo_is_the_first_schedule_and_finds_nothing(suite: Suite) -> None:
    suite(RACE.format(policy="random", shrink=10), "--cfepy-schedules", "1").assert_outcomes(passed=1)
    suite(RACE.format(policy="random", shrink=10), "--cfepy-schedule", "fifo").assert_outcomes(passed=1)


def test_each_schedule_has_its_own_fixtures(suite: Suite) -> None:
    result = suite(
        """
        import re

        import pytest
        from cfepy.testing import explore

        PCT = "pct:2"
        seen, ended, wide = [], [], []

        @pytest.fixture
        def flight(mission, tmp_path):
            flight = mission("talk")
            yield flight
            ended.append(flight)

        @pytest.fixture(scope="module", params=["a", "b"])
        def shared(request):
            wide.append(request.param)
            yield request.param
            wide.remove(request.param)

        @explore(seeds=3)
        @pytest.mark.parametrize("number", [1, 2])
        def test_it(flight, tmp_path, number, shared):
            assert not list(tmp_path.iterdir())
            (tmp_path / "mine").touch()
            assert flight.now == 0
            flight.run_for(0.1)
            assert wide == [shared]
            seen.append((number, shared, flight.plan.schedule.text()))

        def test_what_was_seen():
            seen[:] = [(number, shared, re.sub(r"^pct:.*", PCT, text)) for number, shared, text in seen]
            schedules = ["fifo", "random:1", PCT]
            expected = [(number, shared, each) for shared in "ab" for number in (1, 2) for each in schedules]
            assert sorted(seen) == sorted(expected)
            assert len(ended) == 12
            assert all(flight.closed for flight in ended)
        """
    )
    result.assert_outcomes(passed=5)


def test_failures_other_than_of_the_call(suite: Suite) -> None:
    result = suite(
        """
        import pytest
        from cfepy.testing import explore

        @pytest.fixture
        def broken(mission):
            raise RuntimeError("no setup")

        @pytest.fixture(scope="module")
        def untidy():
            yield
            raise RuntimeError("no teardown")

        @explore(seeds=3)
        def test_setup(broken): ...

        @explore(seeds=3)
        def test_skipped(): pytest.skip("not today")

        @explore(seeds=3)
        @pytest.mark.xfail(reason="known")
        def test_xfail(mission): assert False

        @explore(seeds=3)
        def test_teardown(untidy, mission):
            mission("talk")
        """
    )
    result.assert_outcomes(errors=2, skipped=1, xfailed=1, passed=1)


def test_that_explores_nothing_fails(suite: Suite) -> None:
    result = suite(
        """
        import pytest
        from cfepy.testing import explore

        @pytest.fixture(scope="module")
        def wide(mission):
            return mission("talk")

        @explore(seeds=3)
        def test_it(wide):
            wide.run_for(0.1)
        """
    )
    result.assert_outcomes(failed=1, passed=1)
    result.stdout.fnmatch_lines(["*@explore: the test must boot a mission under the schedules*"])


def test_several_missions_have_the_schedule_of_the_test(suite: Suite) -> None:
    result = suite(
        """
        def test_it(mission):
            flights = [mission("talk") for _ in range(3)]
            assert [each.plan.schedule.text() for each in flights] == ["at:1=1", "random:3", "random:3"]
            assert mission("talk", schedule="pct:1:2", seed=9).plan.schedule.text() == "pct:1:2"
        """,
        "--cfepy-schedule",
        "at:1=1;random:3",
    )
    result.assert_outcomes(passed=1)


def test_invalid_arguments_are_refused() -> None:
    with pytest.raises(UsageError, match="unknown policy 'fancy'; expected all, random, pct or abreast"):
        explore(policy="fancy")
    with pytest.raises(UsageError, match="seeds"):
        explore(seeds=0)
    misspelt: Any = explore
    with pytest.raises(UsageError) as caught:
        misspelt(polcy="all", hlod="1ms")
    said = "polcy: unknown argument; did you mean policy?\nhlod: unknown argument; did you mean hold?"
    assert str(caught.value) == said
    for wrong in ({"hold": "soon"}, {"start": "later"}, {"policy": "pct", "depth": 0}):
        with pytest.raises(UsageError):
            explore(**wrong)


def test_a_misspelt_option_of_a_mission_gets_the_nearest_one(suite: Suite) -> None:
    result = suite(
        """
        def test_it(mission):
            mission("talk", scheduel="fifo", sed=3)
        """
    )
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(
        [
            "*UsageError: scheduel: unknown argument; did you mean schedule?",
            "*sed: unknown argument; did you mean seed?",
        ]
    )


def test_decorator_without_parentheses_is_refused() -> None:
    bare: Any = explore
    with pytest.raises(UsageError, match=r"@explore: requires parentheses: write @explore\(\)"):
        bare(lambda mission: None)


def test_options_of_schedules() -> None:
    found = explore(seeds=4, policy=["random", "pct"], depth=2, any_priority=True, hold="500us", start="600ms").args[0]
    options = "any:hold=500us:from=600ms"
    assert [each.text() for each in schedules_of(found, lambda: 40, found.seeds)] == [
        "fifo",
        f"random:1:{options}",
        f"pct:2:2:40:{options}",
        f"random:3:{options}",
    ]


def test_default_policy_equals_the_default_of_the_command() -> None:
    """As many kinds by turns as `cfepy explore` has, and PCT counts on as many decisions as the longest run had."""
    lengths = iter([40, 60, *[50] * 6])
    choice = explore(seeds=8).args[0]
    found = [each.text() for each in schedules_of(choice, lambda: next(lengths), choice.seeds)]
    assert found == [
        "fifo",
        "random:1",
        "pct:2:2:60",
        "abreast:3",
        "random:4:hold=1ms:late=1ms",
        "pct:5:3:60",
        "pct:6:1:60",
        "random:7",
    ]


@pytest.mark.slow
def test_explore_command_shrinks_to_the_same_schedule(suite: Suite, missions: Path) -> None:
    """It is the same function with the same budget, on the shortest of the first schedules that fail."""
    result = suite(RACE.format(policy="random", shrink=None))
    result.assert_outcomes(failed=1)
    text = result.stdout.str()
    failed = re.search(r"failed under schedule (\d+) of 60, (random:\d+)", text)
    told = re.search(r"in this way, after (\d+) runs: (moves:\S+)", text)
    assert failed is not None
    assert told is not None
    expected = 'invariants: {all: {topic: /total, holds: "msg.data == 6"}}\n'
    (missions / "race" / "mission.yaml").write_text(expected, encoding="utf-8")
    trial = Trial(RunPlan((str(missions / "race"),), seconds=0.9, tasks="greenlet"))
    findings = Findings(Verdict(Schedule()))
    schedules = list(schedules_of(explore(seeds=60, policy="random").args[0], lambda: 1, 60))
    first = int(failed[1])
    for number, schedule in enumerate(schedules[first - 1 : first + MORE], first):
        findings.take(number, trial.run(schedule))
    (finding,) = findings.all()
    assert finding.simplest[0].preemptions <= finding.verdict.preemptions
    starts = [verdict.schedule for verdict in finding.simplest]
    shrunk = Shrinker(trial, starts, finding.failure.group, budget_of(first)).run()
    assert shrunk is not None
    assert shrunk.verdict.schedule.text() == told[2]
    assert int(told[1]) <= budget_of(first) + 1


STORY = """
from cfepy.testing import explore

@explore(seeds=60, policy="random", shrink=20, shrink_time={time})
def test_total(mission):
    flight = mission("race")
    flight.run_for(0.9)
    assert flight.problems == []
"""


def test_failure_has_the_story_of_the_explore_command(suite: Suite, missions: Path) -> None:
    """Cause, the row of the failed step, and the name of the mission's invariant."""
    rule = 'invariants: {all added: {topic: /total, holds: "msg.data == 6"}}\n'
    (missions / "race" / "mission.yaml").write_text(rule, encoding="utf-8")
    result = suite(STORY.format(time=60))
    result.assert_outcomes(failed=1)
    text = result.stdout.str()
    assert re.search(r"^\d+ preemptions?.*, found in \d+ runs$", text, re.MULTILINE)
    assert re.search(r"^cause: an update of racy\.total is lost: ", text, re.MULTILINE)
    assert re.search(r"^\d\.\d{6} +FAILURE.* invariant: all added: ", text, re.MULTILINE)
    assert (
        text.index("\ncause: ") < text.index("\ntime, s ") < text.index(" FAILURE in ") < text.rindex("to reproduce: ")
    )


def test_shrinking_ends_with_its_time(suite: Suite) -> None:
    result = suite(RACE.format(policy="random", shrink="None, shrink_time=1e-9"))
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*, until its time was over (shrink_time of @explore gives more)"])


def test_long_work_is_reported_between_runs(suite: Suite, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(in_tests.WorkLines, "every_ns", 0)
    result = suite(RACE.format(policy="random", shrink=5))
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(
        [
            "test_it.py::test_total: 1 of 60 schedules, 1 runs in * s",
            "test_it.py::test_total: looking for a shorter schedule that fails, * runs in * s",
            "test_it.py::test_total: shrinking the schedule of a failure, * runs in * s",
            "*= FAILURES =*",
        ]
    )


def test_short_work_is_not_reported(suite: Suite, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(in_tests.WorkLines, "every_ns", 3600 * NS_PER_S)  # on a busy computer the runs take seconds
    result = suite(RACE.format(policy="random", shrink=0))
    result.stdout.no_fnmatch_line("test_it.py::test_total: *runs in*")


@pytest.mark.parametrize("seconds", [0, -1.0])
def test_time_to_shrink_must_be_positive(seconds: float) -> None:
    with pytest.raises(UsageError, match=r"shrink_time: invalid time .*; expected more than 0 s"):
        explore(shrink_time=seconds)


IMPOSSIBLE = "moves:NOBODY.x@550/add.get_time=NOONE"
NOT_POSSIBLE = f"*0 of 1 moves of the schedule were possible; not possible: {IMPOSSIBLE.removeprefix('moves:')}"


def test_impossible_schedule_of_the_command_line_is_a_warning(suite: Suite) -> None:
    test = """
        from cfepy.testing import explore

        @explore(seeds=3)
        def test_it(mission):
            mission("talk").run_for(0.7)
        """
    result = suite(test, "--cfepy-schedule", IMPOSSIBLE)
    result.assert_outcomes(passed=1, warnings=1)
    result.stdout.fnmatch_lines(["*test_it.py:*: ScheduleWarning: " + NOT_POSSIBLE[1:]])
    suite(test, "--cfepy-schedule", "random:3").assert_outcomes(passed=1)


def test_impossible_schedule_of_a_test_or_a_wider_fixture_is_a_warning(suite: Suite) -> None:
    result = suite(
        f"""
        import pytest

        @pytest.fixture(scope="module")
        def flight(mission):
            return mission("talk", schedule="at:999999=1")

        def test_wide(flight):
            flight.run_for(0.7)

        def test_own(mission):
            mission("talk", schedule="{IMPOSSIBLE}").run_for(0.7)
        """
    )
    result.assert_outcomes(passed=2, warnings=2)
    result.stdout.fnmatch_lines_random([NOT_POSSIBLE, "*0 of 1 deviations of the schedule were possible*: 999999=1"])

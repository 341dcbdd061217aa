"""A run plan: a value that flies, and that describes how to fly it again."""

from __future__ import annotations

import inspect
import json
import shlex
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cfepy.cli.main import main
from cfepy.pilot.pilot import TakeoffOptions, fly, takeoff
from cfepy.pilot.plan import RunPlan
from cfepy.schedules.schedule import Schedule

WORDS = st.text(st.characters(codec="utf-8", exclude_categories=("Cs", "Cc")), min_size=1)
PLANS = st.builds(
    RunPlan,
    words=st.lists(WORDS, min_size=1, max_size=3).map(tuple),
    command=st.sampled_from(["run", "launch", "node"]),
    launch_args=st.lists(st.tuples(WORDS, WORDS), max_size=2).map(tuple),
    seconds=st.none() | st.floats(0.001, 1e6),
    seed=st.integers(0, 1 << 40),
    board=st.none() | WORDS,
    tasks=st.sampled_from(["thread", "greenlet"]),
    script=st.none() | WORDS,
    stop_on_failure=st.booleans(),
    faults=st.none() | WORDS,
)
NODE = """
import rospy
rospy.init_node("teller")
print("told at", rospy.get_time() > 0)
rospy.sleep(1.0)
"""


def test_schedule_given_as_a_text_is_refused() -> None:
    with pytest.raises(TypeError, match=r"Schedule\.parse\('random:7'\)"):
        RunPlan(("capture",), schedule="random:7")  # type: ignore[arg-type]


@settings(max_examples=30)
@given(PLANS)
def test_plan_survives_json(plan: RunPlan) -> None:
    assert RunPlan.from_dict(json.loads(json.dumps(plan.to_dict()))) == plan


def test_default_options_are_omitted_in_the_command_line() -> None:
    assert RunPlan(("capture",)).command_line() == "cfepy run capture"
    assert RunPlan(("capture",), seconds=2.5, seed=7).command_line(tasks="greenlet") == (
        "cfepy run --for 2.5 --seed 7 --tasks greenlet capture"
    )


def test_command_line_reproduces_the_run(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    plan = RunPlan(("capture",), seconds=0.7, seed=3, schedule=Schedule.parse("random:5"))
    flown = fly(plan)
    numbers = tmp_path / "numbers.json"
    assert main([*shlex.split(plan.command_line())[1:], "--quiet", "--json", str(numbers)]) == 0
    assert (
        json.loads(numbers.read_text(encoding="utf-8"))["trace"]
        == flown.trace
        != fly(RunPlan(("capture",), seconds=0.7)).trace
    )


def test_time_limit_of_a_node_starts_with_the_node(tmp_path: Path) -> None:
    script = tmp_path / "teller.py"
    script.write_text(NODE, encoding="utf-8")
    flown = fly(RunPlan((str(script),), command="node", seconds=5))
    assert "[teller] told at True" in flown.mission.console.lines
    assert flown.results.virtual_s < 3  # it is over when its node is


def test_run_with_a_script_ends_with_the_script(tmp_path: Path) -> None:
    script = tmp_path / "ask.txt"
    script.write_text("at 2 send CFE_ES_NOOP\nexpect event CFE_ES 3 within 1\n", encoding="utf-8")
    flown = fly(RunPlan(("capture",), script=str(script)))
    assert flown.outcome is not None
    assert flown.outcome.ok
    assert 2 <= flown.results.virtual_s < 4


def test_fly_and_takeoff_have_the_same_options() -> None:
    names = set(inspect.signature(takeoff).parameters) - {"plan"}
    assert set(TakeoffOptions.__annotations__) == names

"""Parameters given to a run, in place of those of its mission."""

from __future__ import annotations

import pytest

from cfepy.mission import read_mission, with_settings
from cfepy.pilot.plan import RunPlan
from cfepy.status import UsageError

PUBSUB = read_mission("rx64m_pubsub")


def test_private_parameter_belongs_to_its_node() -> None:
    spec = with_settings(PUBSUB, [("/left/rate", "50"), ("/left/limits/low", "[1, 2.5]")])
    assert spec.ros.nodes["LEFT"].params == {"rate": 50, "limits": {"low": [1, 2.5]}}
    assert spec.ros.nodes["RIGHT"].params == {"rate": 100}
    assert spec.notes == ()


def test_global_parameter_belongs_to_the_master() -> None:
    spec = with_settings(PUBSUB, [("/use_sim_time", "true")])
    assert spec.ros.params["use_sim_time"] is True
    assert spec.ros.nodes == PUBSUB.ros.nodes


def test_parameter_of_an_unknown_node_is_noted() -> None:
    (note,) = with_settings(PUBSUB, [("/lft/rate", "50")]).notes
    assert note == "--set /lft/rate: unknown node /lft; did you mean /left?"


@pytest.mark.parametrize(
    ("name", "value"), [("rate", "1"), ("/", "1"), ("/a//b", "1"), ("/a", "2020-01-01"), ("/a", "[")]
)
def test_invalid_parameter_is_refused(name: str, value: str) -> None:
    with pytest.raises(UsageError, match=r"^--set: "):
        with_settings(PUBSUB, [(name, value)])


def test_settings_are_part_of_the_plan_and_its_command_line() -> None:
    plan = RunPlan(("rx64m_pubsub",), settings=(("/left/rate", "50"),))
    assert plan.command_line() == "cfepy run --set /left/rate=50 rx64m_pubsub"
    assert RunPlan.from_dict(plan.to_dict()) == plan
    assert plan.spec().ros.nodes["LEFT"].params["rate"] == 50

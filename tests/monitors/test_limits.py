"""Invariants about the limits of telemetry: `limits: red` and `limits: yellow`."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.pilot import BootError, RunPlan, fly
from cfepy.pilot.mission_check import check_mission
from cfepy.status import UsageError
from tests.ground.measured import write_thermal

RED = "invariants: {heat: {packet: THERMAL_HK_TLM, limits: red}}\n"
YELLOW = "invariants: {heat: {packet: THERMAL_HK_TLM, limits: yellow}}\n"


def problems(folder: Path, mission_yaml: str, seconds: float = 3) -> list[str]:
    return fly(RunPlan((write_thermal(folder, mission_yaml),), seconds=seconds)).results.problems


def test_violated_limit_fails_the_run_with_name_value_limit_and_time(tmp_path: Path) -> None:
    (problem,) = problems(tmp_path, RED)
    text = "at 2.050000 s: THERMAL_HK_TLM.Temp is 68 degC, above the red limit of 60 degC"
    assert problem == f"invariant 'heat' (mission.yaml:1) {text}"


def test_yellow_includes_red_and_red_does_not_include_yellow(tmp_path: Path) -> None:
    (problem,) = problems(tmp_path, YELLOW, seconds=1.9)
    assert problem.endswith("at 1.550000 s: THERMAL_HK_TLM.Temp is 56 degC, above the yellow limit of 50 degC")
    assert problems(tmp_path, RED, seconds=1.9) == []


def test_limits_apply_from_a_time_on_and_under_a_condition(tmp_path: Path) -> None:
    (problem,) = problems(tmp_path, RED.replace("red}", "red, after: 2.5 s}"))
    assert "at 2.550000 s: THERMAL_HK_TLM.Temp is 80 degC" in problem
    assert problems(tmp_path, RED.replace("red}", "red, when: msg.Samples < 2}")) == []


@pytest.mark.parametrize(
    ("entry", "error"),
    [
        ("{packet: THERMAL_HK_TLM, limits: orange}", "must be red or yellow, not 'orange'"),
        ("{topic: /a, limits: red}", "cannot be combined with `limits`; only packets have them"),
        ("{limits: red}", "missing message; add `topic: /name` or `packet: NAME`"),
        ("{packet: THERMAL_HK_TLM, limits: red, holds: msg.Temp < 3}", "has holds and limits; write one of them"),
    ],
)
def test_check_reports_invalid_limits(tmp_path: Path, entry: str, error: str) -> None:
    mission = write_thermal(tmp_path, f"invariants: {{heat: {entry}}}\n")
    assert any(error in each.text for each in check_mission(mission))


def test_packet_without_limits_is_refused(tmp_path: Path) -> None:
    with pytest.raises((UsageError, BootError), match="CFE_ES_HK_TLM has no field with a red limit"):
        problems(tmp_path, "invariants: {heat: {packet: CFE_ES_HK_TLM, limits: red}}\n")

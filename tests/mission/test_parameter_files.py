"""ROS parameters from YAML: in a mission file, and in files named there."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.mission import read_mission
from cfepy.pilot.mission_check import check_mission
from cfepy.status import UsageError
from rospy_shim.types.config import ROSCORE_PARAMS
from tests.mission.flights import write_mission

STARTUP = "CFE_APP, n, __main__, N, 100, 16384, 0x0, 0;\n!\n"


def mission_with(folder: Path, text: str, **files: str) -> str:
    for name, content in files.items():
        (folder / f"{name}.yaml").write_text(content, encoding="utf-8")
    return write_mission(folder, STARTUP, n="import rospy\n", mission_yaml=text)


def test_later_files_override_earlier_ones_and_the_mission_file_overrides_all(tmp_path: Path) -> None:
    text = "params_from: [one.yaml, {file: two.yaml, namespace: /arm}]\nparams: {arm: {top: 3}}\n"
    mission = mission_with(tmp_path, text, one="arm: {rate: 1, top: 1}\nname: r2\n", two="rate: 2\ngains: [1, 2.5]\n")
    own = {"arm": {"rate": 2, "top": 3, "gains": [1, 2.5]}, "name": "r2"}
    assert read_mission(mission).ros.params == {**ROSCORE_PARAMS, **own}


def test_single_file_needs_no_list_and_nodes_may_have_files(tmp_path: Path) -> None:
    text = "params_from: one.yaml\nnodes: {N: {params_from: [one.yaml], params: {b: 2}}}\n"
    ros = read_mission(mission_with(tmp_path, text, one="a: {x: !!binary aGk=}\n")).ros
    assert (ros.params, ros.nodes["N"].params) == ({**ROSCORE_PARAMS, "a": {"x": b"hi"}}, {"a": {"x": b"hi"}, "b": 2})


@pytest.mark.parametrize(
    ("text", "content", "error"),
    [
        ("params_from: [no.yaml]\n", "", r"mission.yaml:1: params_from\[0\]: file not found: .*no.yaml"),
        ("params_from: [{namespace: a}]\n", "", r"mission.yaml:1: params_from\[0\]: missing file"),
        ("params_from: 3\n", "", r"mission.yaml:1: params_from: must be a list, not 3"),
        (
            "params_from: one.yaml\n",
            "a:\n  b: 2001-01-01\n",
            r"one.yaml:2: a.b: must be a value that ROS parameters can have, not a date",
        ),
        (
            "params_from: one.yaml\n",
            "a:\n\nb: 1\n",
            r"one.yaml:1: a: must be a value that ROS parameters can have, not nothing",
        ),
        ("params_from: one.yaml\n", "a: [1, 3000000000]\n", r"one.yaml:1: a\[1\]: must be an integer of 32 bits"),
        ("params_from: one.yaml\n", "[1]\n", r"one.yaml:1: must be a mapping"),
        (
            "params: {a: {b: }}\n",
            "",
            r"mission.yaml:1: params.a.b: must be a value that ROS parameters can have, not nothing",
        ),
    ],
)
def test_errors_have_file_and_line(tmp_path: Path, text: str, content: str, error: str) -> None:
    mission = mission_with(tmp_path, text, one=content)
    with pytest.raises(UsageError, match=error):
        read_mission(mission)
    assert len(check_mission(mission)) == 1

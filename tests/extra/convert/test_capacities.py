"""Capacities of a mission file, checked against the definitions of messages."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.convert.capacities import capacities_of, wrong_capacities
from cfepy.mission import read_sections
from cfepy.pilot.mission_check import check_mission
from cfepy.status import UsageError
from rospy_shim.types.msgs import shipped


def mission(folder: Path, capacities: str) -> Path:
    (folder / "startup.scr").write_text("!\n", encoding="utf-8")
    (folder / "mission.yaml").write_text(f"cpp_nodes:\n  capacities:\n    {capacities}\n", encoding="utf-8")
    return folder


def test_capacities_of_all_kinds_of_fields_are_read(tmp_path: Path) -> None:
    text = 'sensor_msgs/JointState: {name: 7, "name[]": 12, position: 7}\n    std_msgs/String: {data: 9}\n    array: 5'
    said = capacities_of(read_sections(str(mission(tmp_path, text))).cpp_nodes, shipped())
    assert (said.of_array("sensor_msgs/JointState.name", "string"), said.of_text("sensor_msgs/JointState.name[]")) == (
        7,
        12,
    )
    assert (said.of_text("std_msgs/String.data"), said.of_array("a/B.c", "uint8"), said.text) == (9, 5, 64)


@pytest.mark.parametrize(
    ("capacities", "error"),
    [
        ("std_msgs/Strin: {data: 7}", "std_msgs/Strin.data: unknown message type std_msgs/Strin; did"),
        ("none_msgs/A: {data: 7}", "none_msgs/A.data: unknown message type none_msgs/A; put its pack"),
        ("std_msgs/String: {dat: 7}", "std_msgs/String.dat: unknown field of std_msgs/String; did you mean data?"),
        (
            "std_msgs/Bool: {x: 7}",
            "std_msgs/Bool.x: unknown field of std_msgs/Bool; fields of std_msgs/Bool with a cap",
        ),
        (
            "sensor_msgs/Imu: {orientation_covariance: 9}",
            "sensor_msgs/Imu.orientation_covariance: cannot have a capacity: orientation_covariance is float64[9], ",
        ),
        (
            "sensor_msgs/Imu: {header: 9}",
            "sensor_msgs/Imu.header: cannot have a capacity: header is std_msgs/Header, "
            "which has a fixed size; give the "
            "capacities of std_msgs/Header instead; fields of sensor_msgs/Imu with a capacity: none",
        ),
        ('sensor_msgs/JointState: {"position[]": 9}', "sensor_msgs/JointState.position[]: cannot have a capacity: pos"),
        (
            "std_srvs/SetBool: {message: 9}",
            "std_srvs/SetBool.message: is the service std_srvs/SetBool; name one of its",
        ),
        ("sensor_msgs/BatteryState: {location: 0}", "sensor_msgs/BatteryState.location: must be a whole"),
        (
            "visualization_msgs/InteractiveMarkerFeedback: {mouse_point: 3}",
            "visualization_msgs/InteractiveMarkerFeedback.mouse_point: cannot have a capacity",
        ),
    ],
)
def test_errors_of_capacities_have_their_line(tmp_path: Path, capacities: str, error: str) -> None:
    folder = mission(tmp_path, capacities)
    with pytest.raises(UsageError) as caught:
        capacities_of(read_sections(str(folder)).cpp_nodes, shipped())
    assert str(caught.value).startswith(f"{folder}/mission.yaml:3: cpp_nodes.capacities.{error}")
    (problem,) = check_mission(str(folder))
    assert (problem.line, problem.is_warning) == (3, False)
    assert problem.text in str(caught.value)


def test_check_reports_all_wrong_capacities(tmp_path: Path) -> None:
    said = read_sections(str(mission(tmp_path, "std_msgs/String: {dat: 7, day: 8, data: 9}"))).cpp_nodes
    assert len(wrong_capacities(said, shipped())) == 2


def test_capacity_must_hold_the_constants_of_its_type(tmp_path: Path) -> None:
    (error,) = wrong_capacities(
        read_sections(str(mission(tmp_path, "mavros_msgs/State: {mode: 5}"))).cpp_nodes, shipped()
    )
    assert "mode: is 5, too small for the constant MODE_" in str(error)
    assert (
        wrong_capacities(read_sections(str(mission(tmp_path, "mavros_msgs/State: {mode: 30}"))).cpp_nodes, shipped())
        == []
    )

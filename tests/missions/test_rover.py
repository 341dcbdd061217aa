"""The mission rover and the robot of cfepy_plant that it drives."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

import cfepy
from cfepy.reading.resources import shipped

ROVER = shipped("missions") / "rover"
AGE_CHECK = "rospy.Time.now() - scan.header.stamp > self._oldest"
LOST_SCANS = "faults:\n  - {drop: /scan, after: 10, until: 20}\n"
LAUNCH = """
<launch>
  <node pkg="cfepy_plant" type="diff_drive.py" name="drive">
    <param name="map" value="$(find cfepy_plant)/maps/room.yaml"/>
    <param name="x" value="1.0"/>
    <param name="y" value="1.0"/>
  </node>
  <node pkg="rostopic" type="rostopic" name="driver" args="pub -r 10 /cmd_vel geometry_msgs/Twist '{}'"/>
</launch>
"""


@pytest.fixture
def rover(tmp_path: Path) -> Path:
    """A copy of the mission, whose scans are lost for ten seconds under its fault plan."""
    folder = tmp_path / "rover"
    shutil.copytree(ROVER, folder)
    (folder / "faults.yaml").write_text(LOST_SCANS, encoding="utf-8")
    return folder


def test_rover_drives_round_its_room() -> None:
    run = cfepy.run("rover", seconds=66)
    assert run.problems == []
    _, x = run.topic("/ground_truth").to_numpy("pose.pose.position.x")
    _, y = run.topic("/ground_truth").to_numpy("pose.pose.position.y")
    assert (x.max() > 5.3, y.max() > 3.3, x[-1] < 3) == (True, True, True)
    _, counted = run.topic("/odom").to_numpy("pose.pose.position.x")
    assert 0.001 < abs(counted[-1] + 1 - x[-1]) < 0.5  # the noise of the wheels
    assert {each.name: each.judged > 0 for each in run.results.invariants} == {
        "keeps its distance": True,
        "never touches a wall": True,
        "stops when the battery is low": False,
    }


@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_trace_of_the_rover_is_the_same_on_both_kinds_of_tasks(tasks: str) -> None:
    assert cfepy.run("rover", seconds=3, tasks=tasks).trace == cfepy.run("rover", seconds=3).trace


def test_rover_with_lost_scans_stops(rover: Path) -> None:
    run = cfepy.run(str(rover), seconds=25, faults=str(rover / "faults.yaml"))
    assert run.problems == []
    times, speeds = run.topic("/ground_truth").to_numpy("twist.twist.linear.x")
    assert abs(speeds[(times > 11) & (times < 19.9)]).max() == 0
    assert speeds[-1] > 0.2


def test_follower_that_trusts_old_scans_is_found(rover: Path) -> None:
    script = rover / "wall_follower.py"
    text = script.read_text(encoding="utf-8")
    assert text.count(AGE_CHECK) == 1
    script.write_text(text.replace(AGE_CHECK, "False"), encoding="utf-8")
    run = cfepy.run(str(rover), seconds=25, faults=str(rover / "faults.yaml"))
    assert [each.name for each in run.results.invariants if each.violated] == [
        "keeps its distance",
        "never touches a wall",
    ]


def test_low_battery_stops_the_rover(rover: Path) -> None:
    launch = rover / "rover.launch"
    more = '<arg name="capacity" value="0.03"/></include>'
    launch.write_text(launch.read_text(encoding="utf-8").replace("</include>", more), encoding="utf-8")
    run = cfepy.run(str(rover), seconds=25)
    assert run.problems == []
    assert "POWER_GUARD" in {each.app for each in run.events if "the robot stops" in each.text}
    assert next(each for each in run.results.invariants if each.name.startswith("stops")).judged > 0
    _, speeds = run.topic("/ground_truth").to_numpy("twist.twist.linear.x")
    assert speeds.max() > 0.2
    assert speeds[-1] == 0


def driven(folder: Path, command: str, seconds: float = 4) -> cfepy.Run:
    (folder / "own.launch").write_text(LAUNCH.format(command), encoding="utf-8")
    return cfepy.run(str(folder / "own.launch"), seconds=seconds)


def last(run: cfepy.Run, field: str) -> float:
    return float(run.topic("/ground_truth").to_numpy(field)[1][-1])


def test_launch_file_of_a_user_drives_straight_on(tmp_path: Path) -> None:
    run = driven(tmp_path, "{linear: {x: 0.5}}")
    assert run.problems == []
    assert 0.5 < last(run, "pose.pose.position.x") - 1.0 < 0.5 * 4
    assert last(run, "pose.pose.position.y") == 1.0
    _, odometry = run.topic("/odom").to_numpy("pose.pose.position.x")
    assert odometry[-1] == pytest.approx(last(run, "pose.pose.position.x") - 1.0)


def test_wall_stops_the_robot(tmp_path: Path) -> None:
    run = driven(tmp_path, "{linear: {x: -0.6}}", seconds=6)
    assert 0.1 + 0.15 <= last(run, "pose.pose.position.x") < 0.27
    contacts = [each.data for each in run.messages("/contact")]
    assert contacts[-1] is True

"""Steps of a mission script on the ROS side: publish, call and set, and expectations of their effects."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.pilot import pilot
from cfepy.pilot.plan import RunPlan
from cfepy.script.script_run import Outcome
from cfepy.status import UsageError
from tests.script.rover import write_rover


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_rover(tmp_path)
    return tmp_path


def fly(folder: Path, text: str) -> Outcome:
    (folder / "script.txt").write_text(text, encoding="utf-8")
    outcome = pilot.fly(RunPlan((str(folder),), script=str(folder / "script.txt"))).outcome
    assert outcome is not None
    return outcome


def test_script_publishes_calls_and_sets(folder: Path) -> None:
    outcome = fly(
        folder,
        """
        at 1 publish /cmd_vel linear.x=0.5 angular.z=-1
        expect topic /moved linear.x == 0.5 and angular.z == -1 and linear.y == 0 within 0.1
        publish /cmd_vel "{linear: {y: 2}}"
        expect tlm /moved linear.y == 2
        at 2 set /speed 4
        expect param /speed == 4
        expect no param /speed < 4
        call /enable data=true
        expect response success == true and message == "enabled at 4"
        """,
    )
    assert outcome.ok, outcome.text()
    assert [round(each.at_s, 3) for each in outcome.verdicts][-2:] == [2.21, 2.21]


@pytest.mark.parametrize(
    ("step", "at_s", "detail"),
    [
        ("publish /cmd_vle linear.x=1", 1.0, "unknown topic /cmd_vle (so far); did you mean /cmd_vel?"),
        ("publish /moved linear.x=1", 1.0, "/moved has no subscriber at 1.000 s"),
        ("publish /cmd_vel speed=1", 1.0, "geometry_msgs/Twist"),
        (
            "publish /cmd_vel linear.speed=1",
            1.0,
            "linear.speed: unknown field of geometry_msgs/Vector3; expected x, y or z",
        ),
        (
            "publish /cmd_vel linear=2.5",
            1.0,
            "linear: must be a geometry_msgs/Vector3 such as {x: ..., y: ..., z: ...}, not 2.5",
        ),
        ("publish /cmd_vel linear.x=fast", 1.0, "invalid geometry_msgs/Twist: "),
        ("call /enable data=false", 1.21, "cannot be disabled"),
        ("call /enable data=true within 0.1", 1.1, "no response came"),
        ("call /enabel data=true", 1.0, "unknown service /enabel; did you mean /enable?"),
        ("expect response success == true", 1.0, "no service has responded"),
        ("expect param /speed == 4", 1.0, "it is 3"),
        ("expect param /spede", 1.0, "unknown parameter /spede; did you mean /speed?"),
        ("expect topic /moved within 0.5", 1.5, "no /moved was sent"),
    ],
)
def test_failed_ros_step_reports_the_actual_values(folder: Path, step: str, at_s: float, detail: str) -> None:
    verdict = fly(folder, f"at 1 {step}\n").verdicts[0]
    assert not verdict.ok
    assert detail in verdict.detail
    assert round(verdict.at_s, 2) == at_s


def test_response_without_the_field_is_reported(folder: Path) -> None:
    outcome = fly(folder, "at 1 call /enable data=true\nexpect response sucess == true\n")
    assert "did you mean success" in outcome.verdicts[1].detail


def test_ros_step_before_the_first_node_fails(folder: Path) -> None:
    assert "no ROS node has started yet" in fly(folder, "at 0 set /speed 1\n").verdicts[0].detail


@pytest.mark.parametrize(
    ("line", "text"),
    [
        ("publish cmd_vel linear.x=1", "invalid topic name 'cmd_vel'; it must begin with \"/\""),
        ("publish /cmd_vel linear.x", "invalid field 'linear.x'; write FIELD=VALUE"),
        ("publish /cmd_vel linear.x=1 linear.x=2", "linear.x: given twice"),
        ("publish /cmd_vel linear=1 linear.x=2", "linear.x: linear has a value already"),
        ("publish /cmd_vel linear.x=[1", "linear.x: invalid value '[1': is not YAML"),
        ("set /speed", "the value is missing"),
        ("call /enable data=true within soon", "invalid number of seconds 'soon'"),
        ("expect response success", "unexpected end of line; a sign such as == is missing"),
        ("publsh /cmd_vel", "invalid step 'publsh'; did you mean publish?"),
    ],
)
def test_mistake_in_a_ros_step_is_reported_before_the_run(folder: Path, line: str, text: str) -> None:
    with pytest.raises(UsageError) as error:
        fly(folder, f"at 1 end\n{line}\n")
    assert text in str(error.value)
    assert "script.txt:2: " in str(error.value)

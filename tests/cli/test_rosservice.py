"""`cfepy rosservice`: the services of a mission that the command flies, and a call."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cfepy.cli.main import main
from tests.cli.ros_missions import robot

Capture = pytest.CaptureFixture[str]


@pytest.fixture
def mission(tmp_path: Path) -> str:
    """The robot."""
    return str(robot(tmp_path))


def said(capsys: Capture, *words: str) -> str:
    """Return the output of a successful command."""
    assert main(["rosservice", *words]) == 0
    return capsys.readouterr().out


def test_what_is_offered(mission: str, capsys: Capture) -> None:
    assert "/switch\n" in said(capsys, "list", mission, "--for", "1")
    assert said(capsys, "type", mission, "switch", "--for", "1") == "std_srvs/SetBool\n"
    assert said(capsys, "args", mission, "/switch", "--for", "1") == "data\n"
    lines = said(capsys, "info", mission, "/switch", "--for", "1").split("\n")
    assert lines[0] == "Node: /robot"
    assert lines[1].startswith("URI: rosrpc://")
    assert lines[2:] == ["Type: std_srvs/SetBool", "Args: data", ""]
    found = json.loads(said(capsys, "info", mission, "/switch", "--for", "1", "--json", "-"))
    assert (found["node"], found["args"]) == ("/robot", ["data"])


def test_nothing_of_the_kind(mission: str, tmp_path: Path, capsys: Capture) -> None:
    assert main(["rosservice", "list", mission, "/arm", "--for", "1"]) == 1
    assert main(["rosservice", "info", mission, "/none", "--for", "1"]) == 2
    assert "Unknown service [/none]" in capsys.readouterr().err
    (tmp_path / "x.bag").write_bytes(b"#ROSBAG V2.0\n")
    assert main(["rosservice", "list", str(tmp_path / "x.bag")]) == 2
    assert "a bag has no services" in capsys.readouterr().err


def test_calls(mission: str, capsys: Capture) -> None:
    assert said(capsys, "call", mission, "/switch", "{data: true}") == 'success: True\nmessage: "is True"\n'
    found = json.loads(said(capsys, "call", mission, "switch", "false", "--at", "2.0", "--json", "-"))
    assert found["response"] == {"success": False, "message": "is False"}
    assert 2.0 <= found["at"] < 2.01


def test_the_missions_own_types(tmp_path: Path, capsys: Capture) -> None:
    package = tmp_path / "rover"
    for file, text in (
        ("package.xml", "<package><name>rover</name></package>"),
        ("srv/Drive.srv", "int32 speed\n---\nint32 twice\n"),
        (
            "node.py",
            "import rospy\nfrom rover.srv import Drive\nrospy.init_node('rover')\n"
            "rospy.Service('drive', Drive, lambda request: request.speed * 2)\nrospy.spin()\n",
        ),
        ("rover.launch", '<launch><node pkg="rover" type="node.py" name="rover"/></launch>'),
        ("flight/startup.scr", "CFE_APP, node.py, __main__, ROVER, 100, 16384, 0x0, 0;\n!\n"),
        ("flight/mission.yaml", "nodes: {ROVER: {env: {ROS_PACKAGE_PATH: ../../elsewhere}}}\n"),
    ):
        (package / file).parent.mkdir(parents=True, exist_ok=True)
        (package / file).write_text(text, encoding="utf-8")
    assert said(capsys, "call", str(package / "rover.launch"), "/drive", "speed: 4") == "twice: 8\n"
    (tmp_path / "other").mkdir()
    (tmp_path / "other/startup.scr").write_text("!\n", encoding="utf-8")
    (tmp_path / "other/mission.yaml").write_text("launch: [../rover/rover.launch]\n", encoding="utf-8")
    assert said(capsys, "call", str(tmp_path / "other"), "/drive", "speed: 4") == "twice: 8\n"
    (package / "node.py").rename(package / "flight/node.py")
    (package / "srv").rename(tmp_path / "srv")
    (tmp_path / "elsewhere/rover").mkdir(parents=True)
    (tmp_path / "srv").rename(tmp_path / "elsewhere/rover/srv")
    (package / "package.xml").rename(tmp_path / "elsewhere/rover/package.xml")
    assert said(capsys, "call", str(package / "flight"), "/drive", "4") == "twice: 8\n"


def test_requests_and_answers_have_names_on_the_bus(tmp_path: Path, capsys: Capture) -> None:
    mission = robot(tmp_path)
    with (mission / "robot.py").open("a") as file:
        file.write("    if i == 3:\n        rospy.ServiceProxy('switch', SetBool)(True)\n        break\n")
    assert main(["run", str(mission), "--for", "2", "--no-console"]) == 0
    rows = [line.split()[1:5] for line in capsys.readouterr().out.splitlines() if "/switch" in line]
    assert rows == [["/switch", "answer", "1", "1"], ["/switch", "request", "1", "1"]]


def test_calls_that_fail(mission: str, capsys: Capture) -> None:
    assert main(["rosservice", "call", mission, "/switch", "{dta: true}"]) == 1
    assert "No field name [dta]" in capsys.readouterr().err
    assert main(["rosservice", "call", mission, "/none", "--for", "2"]) == 1
    assert "no answer from /none until the run was over" in capsys.readouterr().err
    assert main(["rosservice", "call", mission, "/none", "--for", "2", "--json", "-"]) == 1
    assert "no answer" in json.loads(capsys.readouterr().out)["error"]

"""`cfepy rostopic`, and `cfepy run --bag`: a mission that the command flies, and the bag of a run."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cfepy.cli.main import main
from tests.cli.ros_missions import robot

Capture = pytest.CaptureFixture[str]


def said(capsys: Capture, *words: str, status: int = 0) -> str:
    """Return the output of the command."""
    assert main(["rostopic", *words]) == status
    return capsys.readouterr().out


@pytest.fixture
def bag(tmp_path: Path, capsys: Capture) -> str:
    """The bag of a run of 3 virtual seconds."""
    file = tmp_path / "run.bag"
    assert main(["run", str(robot(tmp_path)), "--for", "3", "--quiet", "--bag", str(file)]) == 0
    capsys.readouterr()
    return str(file)


def test_lists_of_topics(tmp_path: Path, capsys: Capture, bag: str) -> None:
    mission = str(robot(tmp_path))
    assert said(capsys, "list", mission, "--for", "1") == "/odom\n/orders\n/rosout\n/said\n"
    verbose = said(capsys, "list", mission, "-v", "--for", "1")
    assert " * /said [std_msgs/String] 1 publisher\n" in verbose.partition("Subscribed")[0]
    assert " * /orders [std_msgs/String] 1 subscriber\n" in verbose.partition("Subscribed")[2]
    assert said(capsys, "list", bag) == "/odom\n/said\n"
    rows = json.loads(said(capsys, "list", bag, "--json", "-"))
    assert rows[0] == {"name": "/odom", "type": "nav_msgs/Odometry", "publishers": ["/robot"], "subscribers": []}
    assert main(["rostopic", "list", bag, "/none"]) == 1
    assert capsys.readouterr() == ("", f"cfepy: no topic in /none/ in {bag}\n")
    assert main(["rostopic", "find", bag, "std_msgs/Int8"]) == 1
    assert capsys.readouterr() == ("", f"cfepy: no topic of type std_msgs/Int8 in {bag}\n")
    assert said(capsys, "find", bag, "nav_msgs/Odometry") == "/odom\n"


def test_one_topic(tmp_path: Path, capsys: Capture, bag: str) -> None:
    mission = str(robot(tmp_path))
    lines = said(capsys, "info", mission, "/said", "--for", "1").split("\n")
    assert lines[:3] == ["Type: std_msgs/String", "", "Publishers: "]
    assert lines[3].startswith(" * /robot (http://cfepy:")
    assert lines[4:] == ["", "Subscribers: None", "", ""]
    assert "Subscribers: \n * /robot (" in said(capsys, "info", mission, "orders", "--for", "1")
    assert said(capsys, "type", bag, "/odom/pose/pose") == "nav_msgs/Odometry\n"
    assert main(["rostopic", "info", bag, "/none"]) == 2
    assert "Unknown topic /none" in capsys.readouterr().err


def test_a_node_alone(tmp_path: Path, capsys: Capture) -> None:
    robot(tmp_path)
    assert said(capsys, "type", str(tmp_path / "robot.py"), "/said", "--for", "1") == "std_msgs/String\n"
    assert "x: 0.5" in said(capsys, "echo", str(tmp_path / "robot.py"), "/odom", "-n", "2")


def test_a_launch_file(tmp_path: Path, capsys: Capture) -> None:
    package = tmp_path / "robot"
    package.mkdir()
    robot(package)
    (package / "package.xml").write_text("<package><name>robot</name></package>", encoding="utf-8")
    launch = package / "robot.launch"
    launch.write_text(
        '<launch><group ns="one"><node pkg="robot" type="robot.py" name="r"/></group></launch>', encoding="utf-8"
    )
    assert said(capsys, "echo", str(launch), "/one/said", "-n", "1") == 'data: "m0"\n---\n'
    words = ("pub", str(launch), "/one/orders", "std_msgs/String", "go", "--at", "1", "--for", "2")
    assert "got go\npublished 1 message on /one/orders\n" in said(capsys, *words)


def test_echo(tmp_path: Path, capsys: Capture, bag: str) -> None:
    mission = str(robot(tmp_path))
    assert said(capsys, "echo", mission, "/said", "-n", "2") == 'data: "m0"\n---\ndata: "m1"\n---\n'
    for source in (mission, bag):
        assert said(capsys, "echo", source, "odom/pose/pose/position/x", "-n", "3") == "0.0\n---\n0.5\n---\n1.0\n---\n"
    assert said(capsys, "echo", bag, "/said", "--filter", "m.data.endswith('7')", "-n", "2") == (
        'data: "m7"\n---\ndata: "m17"\n---\n'
    )
    text = said(capsys, "echo", bag, "/odom", "-n", "1", "--noarr", "--nostr")
    assert "covariance" not in text
    assert "frame_id" not in text
    assert said(capsys, "echo", bag, "/odom/pose/covariance[1:3]", "-n", "1") == "[0.0, 0.0]\n---\n"
    found = json.loads(said(capsys, "echo", bag, "/said", "-n", "1", "--json", "-"))
    assert (found["topic"], found["at"], found["message"]) == ("/said", 0.0, {"data": "m0"})
    lines = said(capsys, "echo", bag, "/odom", "-p", "--for", "0.35").split("\n")
    assert lines[0].startswith("%time,field.header.seq,field.header.stamp,field.header.frame_id,")
    assert len(lines) == 1 + 4 + 1
    assert int(lines[2].split(",")[0]) - int(lines[2].split(",")[2]) == 250_000_000


def test_nothing_to_echo(capsys: Capture, bag: str) -> None:
    assert main(["rostopic", "echo", bag, "/none"]) == 1
    assert "no message on /none" in capsys.readouterr().err
    assert said(capsys, "echo", bag, "/said/nothing", status=1) == ""
    assert main(["rostopic", "echo", bag, "/said", "--filter", "m."]) == 2
    assert main(["rostopic", "echo", bag, "/said", "--filter", "m.x > 1"]) == 2
    assert "no attribute 'x'; m is the message, here of type std_msgs/String" in capsys.readouterr().err
    assert main(["rostopic", "echo", bag + "x", "/said"]) == 2


def test_numbers(tmp_path: Path, capsys: Capture, bag: str) -> None:
    for source in (str(robot(tmp_path)), bag):
        lines = said(capsys, "hz", source, "/said", "-w", "11").split("\n")
        assert lines == ["average rate: 10.000", "\tmin: 0.100s max: 0.100s std dev: 0.00000s window: 11", ""]
        lines = said(capsys, "delay", source, "/odom", "-n", "5").split("\n")
        assert lines == ["average delay: 0.250", "\tmin: 0.250s max: 0.250s std dev: 0.00000s window: 5", ""]
    lines = said(capsys, "bw", bag, "/said", "-n", "11").split("\n")
    assert lines == ["average: 67.00B/s", "\tmean: 6.09B min: 6.00B max: 7.00B window: 11", ""]
    assert json.loads(said(capsys, "hz", bag, "/said", "--json", "-"))["window"] == 25
    assert main(["rostopic", "hz", bag, "/said", "-n", "1"]) == 1
    assert main(["rostopic", "delay", bag, "/said"]) == 2
    assert "the messages of this topic have no header" in capsys.readouterr().err


def test_a_script_flies_meanwhile(tmp_path: Path, capsys: Capture) -> None:
    mission = robot(tmp_path)
    script = tmp_path / "end.txt"
    script.write_text("at 2 send CFE_ES_STOP_APP Application=ROBOT\n", encoding="utf-8")
    words = ("hz", str(mission), "/said", "--json", "-", "--for", "5")
    alone = json.loads(said(capsys, *words))["window"]
    assert json.loads(said(capsys, *words, "--script", str(script)))["window"] < alone - 20


def test_publishing(tmp_path: Path, capsys: Capture) -> None:
    mission = str(robot(tmp_path))
    words = ("pub", mission, "/orders", "std_msgs/String")
    assert said(capsys, *words, "data: halt", "--at", "1", "--for", "2") == (
        "[robot] got halt\npublished 1 message on /orders\n"
    )
    found = json.loads(said(capsys, *words, "go", "-r", "2", "--at", "1", "--for", "2.9", "--json", "-"))
    assert found == {"topic": "/orders", "published": 4, "printed": ["[robot] got go"] * 4, "problems": []}
    assert main(["rostopic", "pub", mission, "/orders", "std_msgs/Strng", "x"]) == 2
    assert "TYPE: unknown message type 'std_msgs/Strng'" in (shown := capsys.readouterr()).err
    assert "did you mean std_msgs/String?" in shown.err
    assert shown.out == "", "the mission does not run for it"
    assert main(["rostopic", *words, "{no: 1}"]) == 1
    assert "/orders: " in capsys.readouterr().err


def test_bag_topics(tmp_path: Path, capsys: Capture) -> None:
    mission, file = str(robot(tmp_path)), str(tmp_path / "some.bag")
    assert main(["run", mission, "--for", "2", "--quiet", "--bag", file, "--bag-topics", "/sa*", "/orders"]) == 0
    capsys.readouterr()
    assert said(capsys, "list", file) == "/said\n"
    assert main(["run", mission, "--quiet", "--bag-topics", "/said"]) == 2
    assert "requires --bag FILE" in capsys.readouterr().err


@pytest.mark.parametrize("has_sim_time", [False, True])
def test_a_bag_is_played_into_a_mission(tmp_path: Path, capsys: Capture, bag: str, has_sim_time: bool) -> None:
    folder = tmp_path / "hears"
    folder.mkdir()
    (folder / "hears.py").write_text(
        "import rospy\nfrom std_msgs.msg import String\nrospy.init_node('hears')\n"
        "rospy.Subscriber('/said', String, lambda m: print(m.data, round(rospy.get_time() - 316533800, 1)))\n"
        "rospy.spin()\n",
        encoding="utf-8",
    )
    (folder / "startup.scr").write_text(
        "CFE_APP, hears.py, __main__, HEARS, 100, 16384, 0x0, 0;\n!\n", encoding="utf-8"
    )
    (folder / "mission.yaml").write_text(f"params: {{use_sim_time: {str(has_sim_time).lower()}}}\n", encoding="utf-8")
    assert main(["run", str(folder), "--for", "2", "--play", bag]) == 0
    lines = [line for line in capsys.readouterr().out.split("\n") if line.startswith("[hears]")]
    assert lines[:2] == (["[hears] m0 0.6", "[hears] m1 0.7"] if has_sim_time else ["[hears] m0 0.8", "[hears] m1 0.9"])
    assert len(lines) > 10
    assert main(["run", str(folder), "--play", str(folder / "hears.py")]) == 2
    assert "does not appear to be a bag file" in capsys.readouterr().err

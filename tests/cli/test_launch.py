"""`cfepy launch`: nodes of launch files as applications, with everything that roslaunch provides."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cfepy.cli.main import main
from tests.cli.ros_packages import Launch, demo, write_launch

__all__ = ["demo", "write_launch"]  # fixtures

TALKER = '<node pkg="demo" type="talker.py" name="talker" {}>{}</node>'
COUNT = '<param name="count" value="{}"/>'


def printed(out: str, node: str) -> list[str]:
    begin = f"[{node}] "
    return [line.removeprefix(begin) for line in out.splitlines() if line.startswith(begin)]


def test_nodes_get_what_roslaunch_gives_them(write_launch: Launch, capsys: pytest.CaptureFixture[str]) -> None:
    talker = TALKER.format('args="-v \'a b\'" required="true"', COUNT.format("$(arg n)"))
    listener = '<node pkg="demo" type="listener.py" name="listener"/>'
    file = write_launch(
        f'<arg name="n" default="9"/><group ns="arm"><remap from="chatter" to="/talk"/>{talker}{listener}</group>'
    )
    assert main(["launch", file, "n:=3"]) == 0
    shown = capsys.readouterr().out
    argv = ["-v", "a b", "chatter:=/talk", "__name:=talker"]
    assert printed(shown, "arm/talker") == [f"argv {argv} cwd scripts namespace /arm"]
    heard = [line.rpartition(": ")[2] for line in printed(shown, "arm/listener")]
    assert heard == ["heard hello 1", "heard hello 2"]
    assert "launch: arm/talker ended with exit status 0; it is required, so the run ends" in shown
    assert "/talk " in shown


def test_a_run_ends_with_its_last_node(
    write_launch: Launch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    numbers = tmp_path / "numbers.json"
    assert main(["launch", write_launch(TALKER.format("", COUNT.format(5))), "--json", str(numbers)]) == 0
    assert 1 < json.loads(numbers.read_text(encoding="utf-8"))["virtual_s"] < 1.2


def test_a_node_that_respawns(write_launch: Launch, capsys: pytest.CaptureFixture[str]) -> None:
    file = write_launch(TALKER.format('respawn="true" respawn_delay="1"', COUNT.format(1)))
    assert main(["launch", file, "--for", "4"]) == 0
    shown = capsys.readouterr().out
    assert len(printed(shown, "talker")) == 4  # at 0.5 s, then every 1.1 s
    assert shown.count("launch: talker ended with exit status 0 and is restarted") == 4


def test_what_cannot_run_is_left_out_with_a_note(write_launch: Launch, capsys: pytest.CaptureFixture[str]) -> None:
    missing = '<node pkg="demo" type="driver" name="driver"/>\n<node pkg="absent" type="x" name="other"/>'
    file = write_launch(f"{TALKER.format('', COUNT.format(1))}{missing}")
    assert main(["launch", file, "--quiet"]) == 0
    shown = capsys.readouterr()
    said = shown.err
    assert shown.out.splitlines()[-1].startswith("verdict: passed; ")
    assert shown.out.splitlines()[-1].endswith(", others 0; left out: /driver, /other")
    assert (
        f"{file}:1: node /driver is left out: package 'demo' has no file 'driver': a C++ node, or a missing one" in said
    )
    assert f"{file}:2: node /other is left out: unknown package 'absent'" in said


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ('<node pkg="demo" type="driver" name="driver" required="true"/>', "/driver is required, but package 'demo'"),
        ('<node pkg="demo" type="driver" name="driver"/>', "has no node that cfepy can run: "),
        ("", "has no node that cfepy can run: it has no <node>"),
        ('<node pkg="demo" type="talker.py" name="t" args="\'"/>', '<node>: args="\'": No closing quotation'),
    ],
)
def test_a_launch_file_that_cannot_run(
    write_launch: Launch, capsys: pytest.CaptureFixture[str], body: str, said: str
) -> None:
    assert main(["launch", write_launch(body)]) == 2
    assert said in capsys.readouterr().err


def test_a_launch_file_by_its_package(
    write_launch: Launch, demo: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    write_launch(f"{TALKER.format('', COUNT.format(2))}<rosparam>a: {{b: 1}}</rosparam>")
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(demo.parent))
    assert main(["launch", "demo", "demo.launch", "--nodes", "--dump-params"]) == 0
    shown = capsys.readouterr().out
    assert shown.startswith("/talker\na:\n  b: 1\n")
    assert "talker:\n  count: 2\n" in shown
    assert main(["launch", "demo", "other.launch"]) == 2
    assert "demo other.launch: package 'demo' has no file 'other.launch'" in capsys.readouterr().err
    assert main(["launch", "dmo", "demo.launch"]) == 2
    assert "dmo demo.launch: unknown package 'dmo'; did you mean demo?" in capsys.readouterr().err


@pytest.mark.parametrize("here", ["", "src", "src/stack/demo/scripts", "src/other"])
def test_packages_of_the_workspace_that_one_is_in(
    here: str, demo: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    workspace = demo.parent / "ws"
    (workspace / "src/stack").mkdir(parents=True)
    (workspace / "src/other").mkdir()
    demo = demo.rename(workspace / "src/stack/demo")
    (demo / "demo.launch").write_text(f"<launch>{TALKER.format('', COUNT.format(1))}</launch>", encoding="utf-8")
    monkeypatch.chdir(workspace / here)
    assert main(["launch", "demo", "demo.launch", "--nodes"]) == 0
    assert main(["node", "demo", "talker.py", "_count:=1"]) == 0
    assert capsys.readouterr().out.startswith("/talker\nargv ")


def test_what_is_shown(write_launch: Launch, capsys: pytest.CaptureFixture[str]) -> None:
    """It shows nodes, topics and the state of both; the flight computer on demand."""
    respawned = (
        '<node pkg="demo" type="talker.py" name="late" respawn="true" ns="b"><param name="count" value="3"/></node>'
    )
    listener = '<node pkg="demo" type="listener.py" name="listener"/>'
    file = write_launch(f"{TALKER.format('', COUNT.format(5))}{respawned}{listener}")
    assert main(["launch", file, "--for", "2.55"]) == 0
    shown = capsys.readouterr().out
    assert shown.startswith("[talker] argv ")
    assert "CFE_" not in shown
    tables = [line.split() for line in shown.partition("\nTopics\n")[2].splitlines()]
    assert ["/chatter", "4", "2.0", "0"] in tables  # the first one, before anybody had subscribed
    assert ["/b/chatter", "0", "0.0", "0", "no", "subscriber"] in tables
    assert ["/talker", "ended,", "exit", "status", "0", "0"] in tables
    assert ["/listener", "running", "0"] in tables
    assert ["/b/late", "running", "5"] in tables
    assert not any(row[:1] == ["/rosout"] for row in tables)
    assert "2.550 virtual s" in shown
    assert main(["launch", file, "--for", "2.55", "--console"]) == 0
    whole = capsys.readouterr().out
    assert whole.startswith("CFE_PSP: ")
    assert "\nApplications\n" in whole
    assert whole.splitlines()[-2] == shown.splitlines()[-2]


def test_time_of_a_run_counts_from_the_boot(
    write_launch: Launch, demo: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mission, node = write_launch(TALKER.format("", "")), str(demo / "scripts/talker.py")
    for words in (["launch", mission], ["run", mission, "--no-console"]):
        assert main([*words, "--for", "0.9"]) == 0
        assert "\n0.900 virtual s in " in capsys.readouterr().out
        assert main([*words, "--for", "0.3"]) == 2
        assert "not OPERATIONAL after 0.3 virtual seconds" in capsys.readouterr().err
    assert main(["node", node, "--for", "0.3"]) == 2
    assert "the node has not started after 0.3 virtual seconds; --for runs longer" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("file", "text", "said"),
    [
        ("node.py", "import rospy\n", "is a program, not a mission; use `cfepy node`"),
        ("node", "#!/usr/bin/env python\n", "is a program, not a mission"),
        ("mission.yaml", "board: linux\n", "missing `launch:`, because there is no startup.scr"),
        ("run.bag", "#ROSBAG V2.0\n!\0\0", "is not a startup script or a launch file"),
    ],
)
def test_what_is_no_mission(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], file: str, text: str, said: str
) -> None:
    (tmp_path / file).write_text(text, encoding="utf-8")
    for command in ("export xtce",) if "program" in said else ("run", "check", "graph"):
        assert main([*command.split(), str(tmp_path / file)]) == 2
        assert said in capsys.readouterr().err


def test_hints_at_what_was_meant(write_launch: Launch, demo: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["launch", write_launch(TALKER.format("", "")), "n=3"]) == 2
    assert "invalid argument 'n=3'; expected NAME:=VALUE" in capsys.readouterr().err


def test_a_node_gets_the_options_that_the_command_lacks(demo: Path, capsys: pytest.CaptureFixture[str]) -> None:
    script = str(demo / "scripts/talker.py")
    for words in ("--xyzzy 3 -v", "--for 2 --xyzzy 3 --seed 7 -v", "_count:=1 --xyzzy 3 -v --stall=5"):
        assert main(["node", script, *words.split()]) == 0
        assert "'--xyzzy', '3', '-v'] cwd " in capsys.readouterr().out, words


def test_an_option_that_is_almost_one_of_the_command_is_reported(
    demo: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["node", str(demo / "scripts/talker.py"), "_count:=1", "--sed", "7"]) == 0
    assert "cfepy: --sed is passed to the node; did you mean --seed?" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main(["run", "lab", "--sed", "7"])


@pytest.mark.slow
def test_a_launch_file_where_a_mission_is_meant(write_launch: Launch, capsys: pytest.CaptureFixture[str]) -> None:
    file = write_launch(TALKER.format("", COUNT.format(3)))
    main(["launch", file, "--no-console"])
    digest = capsys.readouterr().out.splitlines()[-2]
    assert main(["run", file, "--no-console"]) == 0
    assert capsys.readouterr().out.splitlines()[-2] == digest
    assert main(["run", file, "--board", "rx64m", "--no-console"]) == 0
    capsys.readouterr()
    assert main(["rosparam", "get", file, "/talker/count"]) == 0
    assert capsys.readouterr().out == "3\n"
    assert main(["graph", "--mids", file]) == 0
    assert ["/chatter", "std_msgs/String", "/talker", "-"] in [
        row.split()[1:] for row in capsys.readouterr().out.splitlines()
    ]
    assert main(["graph", "--mids", file, "--lock"]) == 2
    assert "cannot have a topics.lock" in capsys.readouterr().err
    assert main(["check", file]) == 0
    with_argument = write_launch(f'<arg name="n"/>{TALKER.format("", COUNT.format("$(arg n)"))}')
    capsys.readouterr()
    assert main(["rosparam", "get", with_argument, "/talker/count", "--arg", "n:=7"]) == 0
    assert main(["rostopic", "echo", with_argument, "/chatter", "--arg", "n:=2"]) == 0
    assert main(["run", with_argument, "--arg", "n:=1", "--no-console", "--check-determinism", "2"]) == 0
    assert capsys.readouterr().out.startswith('7\ndata: "hello 0"\n---\ndata: "hello 1"\n---\n2 runs: ')
    assert main(["check", with_argument]) == 1
    assert main(["check", with_argument, "--arg", "n:=1"]) == 0
    assert main(["run", "lab", "--arg", "n:=1"]) == 2
    other = write_launch('<node pkg="demo" type="talker.py" name="a"/>\n<node pkg="none" type="x" name="b"/>')
    assert main(["check", other]) == 1
    assert f"{other}:2: node /b is left out: unknown package 'none'" in capsys.readouterr().out
    assert main(["check", write_launch("<nod")]) == 1
    assert f"{other}:1: " in capsys.readouterr().out


def test_the_same_launch_makes_the_same_trace(write_launch: Launch, capsys: pytest.CaptureFixture[str]) -> None:
    file = write_launch(TALKER.format("", COUNT.format(3)))
    digests = set()
    for tasks in ("thread", "greenlet"):
        main(["launch", file, "--no-console", "--tasks", tasks])
        digests.add(capsys.readouterr().out.splitlines()[-2])
    assert len(digests) == 1


def test_common_tools_are_stood_in_for(write_launch: Launch, demo: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (demo / "scripts/look.py").write_text(
        "import rospy, tf2_ros\n"
        "rospy.init_node('look')\n"
        "buffer = tf2_ros.Buffer()\n"
        "listener = tf2_ros.TransformListener(buffer)\n"
        "at = buffer.lookup_transform('map', 'tip', rospy.Time(), rospy.Duration(5)).transform.translation\n"
        "print(at.x, at.y, at.z)\n"
        "heard = []\n"
        "rospy.Subscriber('slow_relay', rospy.AnyMsg, heard.append)\n"
        "rospy.sleep(5)\n"
        "print(len(heard))\n",
        encoding="utf-8",
    )
    file = write_launch(
        '<node pkg="tf" type="static_transform_publisher" name="one" args="1 2 -3 0 0 0 map arm 100"/>'
        '<node pkg="tf2_ros" type="static_transform_publisher" name="two" args="0 0 1 0 0 0 1 arm tip"/>'
        '<node pkg="topic_tools" type="throttle" name="throttle" args="messages chatter 2 slow"/>'
        '<node pkg="topic_tools" type="relay" name="relay" args="slow"/>'
        f'{TALKER.format("", "")}<node pkg="demo" type="look.py" name="look" required="true"/>'
    )
    assert main(["launch", file, "--for", "20"]) == 0
    assert printed(capsys.readouterr().out, "look") == ["1.0 2.0 -2.0", "8"]


URDF = """
<robot name="r">
  <joint name="lift" type="prismatic"><parent link="base"/><child link="post"/><axis xyz="0 0 2"/></joint>
  <joint name="turn" type="revolute"><parent link="post"/><child link="arm"/><axis xyz="0 0 1"/>
    <origin xyz="1 0 0" rpy="0 0 0"/></joint>
  <joint name="follow" type="continuous"><parent link="arm"/><child link="hand"/><axis xyz="0 0 1"/>
    <mimic joint="turn" multiplier="-1"/></joint>
  <joint name="end" type="fixed"><parent link="hand"/><child link="tip"/><origin xyz="0 1 0"/></joint>
</robot>
"""


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ('xyz="1 0 x"', "joint turn: xyz must be three numbers, not '1 0 x'"),
        ('xyz="1 0"', "joint turn: xyz must be three numbers, not '1 0'"),
        ("<", "not well-formed"),
    ],
)
def test_a_robot_description_with_a_mistake(
    write_launch: Launch, demo: Path, capsys: pytest.CaptureFixture[str], wrong: str, said: str
) -> None:
    (demo / "r.urdf").write_text(URDF.replace('xyz="1 0 0"', wrong), encoding="utf-8")
    file = write_launch(
        '<param name="robot_description" textfile="$(find demo)/r.urdf"/>'
        '<node pkg="robot_state_publisher" type="robot_state_publisher" name="state"/>'
    )
    assert main(["launch", file]) == 1
    (line,) = printed(capsys.readouterr().out, "state")
    assert "robot_description is not a URDF: " in line
    assert said in line


def test_a_robots_state_becomes_transforms(
    write_launch: Launch, demo: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (demo / "r.urdf").write_text(URDF, encoding="utf-8")
    (demo / "scripts/move.py").write_text(
        "import rospy, tf2_ros\n"
        "from sensor_msgs.msg import JointState\n"
        "rospy.init_node('move')\n"
        "publisher = rospy.Publisher('joint_states', JointState, queue_size=1)\n"
        "buffer = tf2_ros.Buffer()\n"
        "listener = tf2_ros.TransformListener(buffer)\n"
        "rospy.sleep(1)\n"
        "state = JointState(name=['lift', 'turn'], position=[0.5, 1.5707963267948966])\n"
        "state.header.stamp = rospy.Time.now()\n"
        "publisher.publish(state)\n"
        "at = buffer.lookup_transform('base', 'tip', rospy.Time(), rospy.Duration(2)).transform\n"
        "print(*(round(each, 6) for each in (at.translation.x, at.translation.y, at.translation.z, at.rotation.w)))\n",
        encoding="utf-8",
    )
    file = write_launch(
        '<param name="robot_description" textfile="$(dirname)/r.urdf"/>'
        '<node pkg="robot_state_publisher" type="robot_state_publisher" name="rsp"/>'
        '<node pkg="demo" type="move.py" name="move" required="true"/>'
    )
    assert main(["launch", file]) == 0
    assert printed(capsys.readouterr().out, "move") == ["1.0 1.0 0.5 1.0"]


def test_commands_that_look_at_a_mission_name_left_out_nodes_in_one_line(
    write_launch: Launch, capsys: pytest.CaptureFixture[str]
) -> None:
    body = TALKER.format("", COUNT.format(2))
    for name in ("rviz", "viewer"):
        body += f'<node pkg="absent" type="{name}" name="{name}"/>'
    file = write_launch(body)
    for words in (["rostopic", "list"], ["graph"], ["tlm"], ["rosparam", "list", "--for", "1"]):
        main([*words, file, *([] if "--for" in words else ["--for", "1"])])
        assert capsys.readouterr().err.splitlines()[:1] == [
            "cfepy: left out: /rviz, /viewer; `cfepy check` gives the reasons"
        ], words

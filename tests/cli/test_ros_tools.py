"""`cfepy rosbag`, `rosmsg`, `rossrv`, `rosnode` and `tf`.

`tests/data/ros_cli/answers.txt` is the output of the ROS tools (Debian's 1.15.15, tf 1.13.2) with a master and the
two nodes beside it, including their standard error.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from cfepy.cli.main import main

Capture = pytest.CaptureFixture[str]
DATA = Path(__file__).parents[1] / "data"
BAG = str(DATA / "bags" / "golden.bag")
QUICK = ("rosnode info -q /frames", "tf_echo base world", "rosmsg show geometry_msgs/PoseStamped")
"""The others take as long, and are left to the slow tests."""


def recorded() -> dict[str, str]:
    """Return the recorded output by command line."""
    sections = re.split(r"(?m)^\$ ", (DATA / "ros_cli" / "answers.txt").read_text(encoding="utf-8"))[1:]
    return {name: text for name, _, text in (each.partition("\n") for each in sections)}


@pytest.fixture
def mission(tmp_path: Path) -> str:
    """A mission of the two nodes that were recorded."""
    for name in ("frames", "ear"):
        shutil.copy(DATA / "ros_cli" / f"{name}.py", tmp_path)
    lines = "".join(f"CFE_APP, {each}, __main__, {each.upper()}, 100, 16384, 0x0, 0;\n" for each in ("frames", "ear"))
    (tmp_path / "startup.scr").write_text(f"{lines}!\n", encoding="utf-8")
    return str(tmp_path)


def words_here(line: str, mission: str) -> list[str]:
    """Return cfepy's command line for one of ROS."""
    tool, *words = line.split()
    if tool == "tf_echo":
        return ["tf", "echo", mission, *words, "--for", "3"]
    if tool == "rosnode":
        return [tool, words[0], mission, *words[1:], "--for", "2"]
    return [tool, *words]


def alike(text: str) -> list[str]:
    """Return the lines without times, ports, the sign of zero and roscore's node. Repeated lines occur once."""
    text = re.sub(r"http://\S+", "URI", re.sub(r"\d+\.\d{6,}(ms)?|(?<=At time )\S+", "N", text))
    text = text.replace("-0.000", "0.000")
    return sorted({line.replace("frames]:", "frames]") for line in text.splitlines() if "rosout" not in line})


@pytest.mark.parametrize(
    "line", [pytest.param(each, marks=[] if each in QUICK else [pytest.mark.slow]) for each in recorded()]
)
def test_prints_what_ros_prints(line: str, mission: str, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    monkeypatch.chdir(DATA / "bags")
    if line == "rosbag check even.bag":
        line = line.replace("even.bag", "golden.bag")
    main(words_here(line, mission))
    said = capsys.readouterr()
    shown = (said.out + said.err).replace(f"cfepy: no transform from world to nowhere in {mission}\n", "")
    expected = recorded().get(line, recorded()["rosbag check even.bag"])
    assert alike(shown.replace(str(DATA / "bags") + "/", "")) == alike(expected)


# -- rosbag ------------------------------------------------------------------------------------------------------------


def test_info_of_a_bag_is_as_it_was_recorded(capsys: Capture) -> None:
    assert main(["rosbag", "info", BAG]) == 0
    shown = capsys.readouterr().out.splitlines()
    expected = (DATA / "bags" / "golden.bag.info.txt").read_text(encoding="utf-8").splitlines()
    assert shown[1:] == expected[1:]  # the first is the path


def test_check_tells_types_that_are_others_here(capsys: Capture) -> None:
    assert main(["rosbag", "check", str(DATA / "ros_cli" / "odd.bag")]) == 1
    assert capsys.readouterr().out == (  # ROS adds how many migration rules there are
        "The following migrations need to occur:\n"
        " * From: std_msgs/Bool [c992beb9fc778766b7b6ce75810c97a1]\n"
        "   To:   std_msgs/Bool [8b94c1b53db61fb6aed406028ad6332a]\n"
        " * From: gone_msgs/Gone [8b94c1b53db61fb6aed406028ad6332a]\n"
        "   To:   Unknown\n"
    )


def test_filter_and_compress_write_bags(tmp_path: Path, capsys: Capture) -> None:
    chosen = str(tmp_path / "chosen.bag")
    assert main(["rosbag", "filter", BAG, chosen, "topic == '/chatter'"]) == 0
    assert main(["rosbag", "compress", "-q", chosen]) == 0
    assert main(["rosbag", "info", "-y", "-k", "compression", chosen]) == 0
    assert capsys.readouterr().out == "bz2\n"
    assert (tmp_path / "chosen.orig.bag").is_file()


@pytest.mark.parametrize(
    ("words", "hint"),
    [
        (["record"], "cfepy: rosbag record: `cfepy run MISSION --bag FILE` records"),
        (["play", "x.bag"], "cfepy: rosbag play: `cfepy run MISSION --play FILE` plays"),
        (["fix", "a.bag", "b.bag"], "cfepy: rosbag fix: cfepy has no migration rules"),
    ],
)
def test_what_other_commands_do_is_told(words: list[str], hint: str, capsys: Capture) -> None:
    assert main(["rosbag", *words]) == 2
    assert hint in capsys.readouterr().err


def test_options_of_what_other_commands_do(capsys: Capture) -> None:
    with pytest.raises(SystemExit, match="2"):
        main(["rosbag", "record", "-a"])
    assert "unrecognized arguments: -a; `cfepy run MISSION --bag FILE`" in capsys.readouterr().err


def test_the_status_is_that_of_the_tool(capsys: Capture) -> None:
    assert main(["rosbag", "info", "nosuch.bag"]) == 1
    assert capsys.readouterr().err.startswith("ERROR reading nosuch.bag: ")


# -- rosmsg, rossrv ----------------------------------------------------------------------------------------------------


def test_packages_in_the_folder_are_known(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    package = tmp_path / "my_msgs"
    (package / "srv").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>my_msgs</name></package>", encoding="utf-8")
    (package / "srv" / "Ask.srv").write_text("# what\nint32 a\n---\nbool b\n", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    assert main(["rossrv", "show", "-r", "my_msgs/Ask"]) == 0
    assert capsys.readouterr().out == "# what\nint32 a\n---\nbool b\n\n"


@pytest.mark.parametrize("folder", ["", "src", "src/stack"])
def test_packages_of_a_workspace_are_known_at_any_depth(
    folder: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    package = tmp_path / "src/stack/deeper/my_msgs"
    (package / "msg").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>my_msgs</name></package>", encoding="utf-8")
    (package / "msg/Level.msg").write_text("float64 level\n", encoding="utf-8")
    monkeypatch.chdir(tmp_path / folder)
    assert main(["rosmsg", "show", "my_msgs/Level"]) == 0
    assert capsys.readouterr().out == "float64 level\n\n"


def test_a_tool_in_a_launch_file_knows_the_types_of_its_workspace(tmp_path: Path, capsys: Capture) -> None:
    for name in ("my_msgs", "my_robot"):
        (tmp_path / "src" / name / "msg").mkdir(parents=True)
        text = f"<package><name>{name}</name></package>"
        (tmp_path / "src" / name / "package.xml").write_text(text, encoding="utf-8")
    (tmp_path / "src/my_msgs/msg/Level.msg").write_text("float64 level\n", encoding="utf-8")
    file = tmp_path / "src/my_robot/robot.launch"
    tools = (("pub", "pub /level my_msgs/Level &quot;level: 3&quot;"), ("echo", "echo -n 1 /level"))
    nodes = (f'<node pkg="rostopic" type="rostopic" name="{name}" args="{args}"/>' for name, args in tools)
    file.write_text(f"<launch>{''.join(nodes)}</launch>", encoding="utf-8")
    assert main(["launch", str(file), "--for", "3"]) == 0
    assert "[echo] level: 3.0" in capsys.readouterr().out


def test_a_message_as_a_bag_has_it(capsys: Capture) -> None:
    odd = str(DATA / "ros_cli" / "odd.bag")
    assert main(["rosmsg", "show", "-b", odd, "std_msgs/Bool"]) == 0
    assert capsys.readouterr().out == "bool data\nbool other\n\n"
    assert main(["rosmsg", "show", "-b", "nosuch.bag", "std_msgs/Bool"]) == 1
    assert capsys.readouterr().err == "ERROR: bag file [nosuch.bag] does not exist\n"


# -- rosnode -----------------------------------------------------------------------------------------------------------


def test_kill_in_the_middle_of_a_flight(mission: str, capsys: Capture) -> None:
    assert main(["rosnode", "kill", mission, "ear", "--at", "1.5", "--for", "2"]) == 0
    assert capsys.readouterr().out == "killing /ear\n[ear] shutdown request: user request\nkilled\n"


def test_a_run_that_is_over_before_it_is_asked(mission: str, capsys: Capture) -> None:
    Path(mission, "script.txt").write_text("send CFE_ES_NOOP\n", encoding="utf-8")
    assert main(["rosnode", "list", mission, "--script", str(Path(mission, "script.txt"))]) == 0
    assert capsys.readouterr().out == "/ear\n/frames\n"
    Path(mission, "frames.py").write_text("import rospy\nrospy.init_node('frames')\nrospy.sleep(1)\n", encoding="utf-8")
    node = str(Path(mission, "frames.py"))
    assert main(["rosnode", "list", node, "--at", "5"]) == 1
    assert "the run ended before 5 s, the time of rosnode list; give an earlier --at" in capsys.readouterr().err


def test_a_bag_has_no_nodes(capsys: Capture) -> None:
    assert main(["rosnode", "list", BAG]) == 2
    assert "a bag has no nodes; give a mission" in capsys.readouterr().err


# -- tf ----------------------------------------------------------------------------------------------------------------


def test_transforms_of_a_mission_and_of_its_bag(mission: str, tmp_path: Path, capsys: Capture) -> None:
    bag = str(tmp_path / "tf.bag")
    assert main(["run", mission, "--for", "2", "--quiet", "--bag", bag]) == 0
    capsys.readouterr()
    shown = []
    for source in (mission, bag):
        assert main(["tf", "echo", source, "world", "camera", "-n", "1"]) == 0
        shown.append(capsys.readouterr().out.splitlines())
    assert shown[0][1:] == shown[1][1:] == recorded()["tf_echo world camera"].splitlines()[1:5]


def test_frames_as_a_tree_and_for_graphviz(mission: str, tmp_path: Path, capsys: Capture) -> None:
    assert main(["tf", "frames", mission, "--for", "2"]) == 0
    expected = "world\n  base  10.769 Hz for 1.3 s, by /frames\n    camera  once, by /frames\n"
    assert capsys.readouterr().out == expected
    assert main(["tf", "frames", mission, "--for", "2", "--dot", str(tmp_path / "frames.gv")]) == 0
    drawn = (tmp_path / "frames.gv").read_text(encoding="utf-8")
    assert drawn.startswith('digraph G {\n"base" -> "camera"[label="Broadcaster: /frames\\nAverage rate: 10000.000 Hz')
    assert drawn.endswith('}->"world";\n}\n')


def test_a_pdf_without_graphviz(mission: str, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    monkeypatch.setenv("PATH", "")
    assert main(["tf", "frames", mission, "--for", "1", "--pdf", "frames.pdf"]) == 2
    assert "--pdf: requires graphviz, and its command `dot` is not installed" in capsys.readouterr().err
    assert not Path("frames.pdf").exists()


def test_no_transform(capsys: Capture) -> None:
    bag = str(DATA / "bags" / "golden_api_none.bag")
    assert main(["tf", "frames", bag, "--for", "1"]) == 1
    assert capsys.readouterr().err == f"cfepy: no transform in {bag}\n"


# -- ends --------------------------------------------------------------------------------------------------------------


def test_a_tool_that_dies_ends_the_run(mission: str, tmp_path: Path, capsys: Capture) -> None:
    plan = tmp_path / "plan.yaml"
    plan.write_text("faults:\n  - crash: GROUND_NODE\n    at: 1.0\n", encoding="utf-8")
    assert main(["rosnode", "list", mission, "--for", "2", "--faults", str(plan)]) == 1
    assert "the run ended before 2 s, the time of rosnode list" in capsys.readouterr().err


@pytest.mark.slow
def test_a_reader_that_has_seen_enough() -> None:
    program = "from cfepy.cli.main import process\nimport sys\nsys.exit(process())"
    words = [sys.executable, "-c", program, "rosmsg", "list"]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as done:
        assert done.stdout is not None
        assert done.stderr is not None
        done.stdout.readline()
        done.stdout.close()
        assert done.stderr.read() == ""
    assert done.returncode == 0

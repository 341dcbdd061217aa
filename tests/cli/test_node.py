"""`cfepy node`: one node, its unchanged output, its exit status."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.cli.main import main
from tests.cli.ros_packages import demo

__all__ = ["demo"]  # a fixture


def run(folder: Path, source: str, *words: str) -> int:
    script = folder / "node.py"
    script.write_text(source, encoding="utf-8")
    return main(["node", str(script), *words])


def test_only_the_nodes_own_output_is_shown(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(tmp_path, "import sys\nprint('one\\ntwo', sys.argv[1:])\n", "a", "b:=c", "--", "--own") == 0
    shown = capsys.readouterr()
    assert shown.out == "one\ntwo ['a', 'b:=c', '--own']\n"
    assert shown.err == ""


@pytest.mark.parametrize(
    ("source", "status"), [("raise SystemExit(7)", 7), ("1 / 0", 1), ("import os\nos._exit(3)", 3), ("", 0)]
)
def test_the_exit_status_is_the_nodes(tmp_path: Path, source: str, status: int) -> None:
    assert run(tmp_path, source) == status


def test_names_and_parameters_from_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source = "import rospy\nrospy.init_node('n')\nprint(rospy.get_name(), rospy.get_param('~rate'))\n"
    assert run(tmp_path, source, "__name:=other", "__ns:=arm", "_rate:=[1, 2]") == 0
    assert capsys.readouterr().out == "/arm/other [1, 2]\n"


def test_a_node_that_does_not_end(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(tmp_path, "import time\nwhile True:\n    time.sleep(1)\n    print('tick')\n", "--for", "3") == 0
    shown = capsys.readouterr()
    assert shown.out.startswith("tick\ntick\n")
    assert shown.err == "cfepy: the node still runs after 3 virtual seconds; --for runs longer\n"


def test_a_node_by_its_package(demo: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(demo))
    monkeypatch.chdir(demo)
    assert main(["node", "demo", "talker.py", "_count:=1"]) == 0
    assert capsys.readouterr().out == "argv ['_count:=1'] cwd demo namespace None\n"


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["no.py"], "no.py: script not found; give one, or a package and the name of a node in it"),
        (["no_package", "node"], "no_package node: unknown package 'no_package'"),
    ],
)
def test_no_such_node(capsys: pytest.CaptureFixture[str], words: list[str], said: str) -> None:
    assert main(["node", *words]) == 2
    assert said in capsys.readouterr().err


@pytest.mark.parametrize("words", [["node"], ["node", "--quiet"], ["run"], ["run", "--quiet"], ["launch"]])
def test_where_the_master_serves_is_told_once(
    words: list[str], demo: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "node.py").write_text("import rospy\nrospy.init_node('n')\n", encoding="utf-8")
    (tmp_path / "nodes.launch").write_text(
        '<launch><node pkg="demo" type="talker.py" name="talker"/></launch>', encoding="utf-8"
    )
    what = tmp_path / ("nodes.launch" if words == ["launch"] else "node.py")
    assert main([*words, str(what), "--for", "0.7", "--realtime", "1000", "--ros-master", "serve:0"]) == 0
    shown = capsys.readouterr()
    assert (shown.out + shown.err).count("ROS master at http://127.0.0.1:") == 1

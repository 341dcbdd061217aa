"""`cfepy rosparam`: parameters of missions, and their table files."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.fs import read_table_file
from tests.mission.flights import write_mission

STARTUP = "CFE_APP, n, __main__, N, 100, 16384, 0x0, 0;\n!\n"
YAML = "params: {robot: {rate: 10, axes: [x, y]}}\nnodes: {N: {name: n, params: {gain: 0.5}}}\n"
NODE = """
    import rospy
    rospy.init_node("n")
    rospy.sleep(1)
    rospy.set_param("~later", "yes")
    rospy.spin()
    """


def said(capsys: pytest.CaptureFixture[str], *arguments: object, status: int = 0) -> str:
    assert main(["rosparam", *map(str, arguments)]) == status
    done = capsys.readouterr()
    return done.out + done.err


@pytest.fixture
def mission(tmp_path: Path) -> str:
    return write_mission(tmp_path, STARTUP, n=NODE, mission_yaml=YAML)


def test_what_a_mission_starts_with(mission: str, capsys: pytest.CaptureFixture[str]) -> None:
    own, roscore = ["/n/gain", "/robot/axes", "/robot/rate"], ["/rosdistro", "/rosversion", "/run_id"]
    assert said(capsys, "list", mission).split() == own + roscore
    assert said(capsys, "list", mission, "robot").split() == ["/robot/axes", "/robot/rate"]
    assert said(capsys, "get", mission, "/robot/rate") == "10\n"
    assert said(capsys, "dump", mission, "/robot") == "rate: 10\naxes:\n- x\n- y\n"
    assert (
        said(capsys, "get", mission, "/none", status=1)
        == "cfepy: unknown parameter /none; there are 6 others, which `cfepy rosparam list` shows\n"
    )


def test_what_there_is_after_some_time(mission: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert said(capsys, "get", mission, "/n/later", "--for", "1", status=1)
    assert said(capsys, "get", mission, "/n/later", "--for", "3").splitlines() == ["'yes'"]
    assert "/n/gain" in said(capsys, "list", mission, "--for", "3")


def test_a_node_whose_name_only_its_script_knows(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mission = write_mission(tmp_path, STARTUP, n=NODE, mission_yaml="nodes: {N: {params: {gain: 1}}}\n")
    assert "cfepy: N sets parameters under a name that only a run shows" in said(capsys, "list", mission)
    assert "/n/gain" in said(capsys, "list", mission, "--for", "2")


def test_files_for_the_ground(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source, out = tmp_path / "robot.yaml", tmp_path / "out"
    source.write_text("robot: {rate: 10, axes: [x, y]}\ntext: '10'\nbig: " + "z" * 12000 + "\n", encoding="utf-8")
    assert said(capsys, "build", source, "-o", out).split()[0].endswith("params01.tbl:")
    assert sorted(path.name for path in out.iterdir()) == ["params01.tbl", "params02.tbl"]
    assert said(capsys, "list", out).split() == ["/big", "/robot/axes", "/robot/rate", "/text"]
    assert len(said(capsys, "get", out, "/big")) == 12001
    assert "params01.tbl" in said(capsys, "set", out, "/robot/rate", "2.5")
    assert "params02.tbl" in said(capsys, "set", out, "/new", "{a: true}")
    said(capsys, "delete", out, "/robot/axes")
    assert said(capsys, "delete", out / "params01.tbl", "/text", status=2).endswith("with the files of all tables\n")
    assert said(capsys, "set", out, "/new/a", "true") == "nothing changes\n"
    assert said(capsys, "dump", out, "/robot") == "rate: 2.5\n"
    assert said(capsys, "get", out, "/new") == "a: true\n"
    assert said(capsys, "get", out, "/text") == "'10'\n"
    assert main(["tbl", "verify", str(out / "params01.tbl")]) == 0
    headers = [read_table_file((out / f"params0{number}.tbl").read_bytes())[0] for number in (1, 2)]
    assert [header.description for header in headers] == ["ROS parameters 1", "ROS parameters 2"]


@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        (
            ("set", "p/params01.tbl", "/a", "2001-01-01"),
            "value: must be a value that ROS parameters can have, not a date",
        ),
        (("set", "p/params01.tbl", "/a", "[1"), "is not YAML"),
        (("delete", "p/params01.tbl", "/none"), "params01.tbl: unknown parameter /none"),
        (
            ("set", "p/params01.tbl", "/a", "x" * 20000),
            "the parameter tables are full: /a needs more than all 127 rows",
        ),
        (("set", "robot.yaml", "/a", "1"), "robot.yaml: is not a table file"),
        (("list", "empty"), "empty: contains no file of a parameter table"),
        (("get", "no_such_mission", "/a"), "no_such_mission"),
    ],
)
def test_mistakes(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    arguments: tuple[str, ...],
    error: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "empty").mkdir()
    (tmp_path / "robot.yaml").write_text("rate: 10\n", encoding="utf-8")
    said(capsys, "build", "robot.yaml", "-o", "p")
    assert error in said(capsys, *arguments, status=2)

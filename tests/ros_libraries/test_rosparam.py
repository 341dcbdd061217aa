"""rosparam: YAML files and the command. test_ros_tools.py tests reading and writing of single parameters."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.rospy_shim.missions import run_nodes

pytest.importorskip("yaml")

VALUES = """
gains: {p: 1.5, i: 0}
angle: deg(90)
turn: rad(2*pi)
explicit: !degrees 180
picture: !!binary AP8=
"""


def said(folder: Path, script: str) -> list[str]:
    """Return a node's output."""
    return run_nodes(folder, {"TOOL": script}, seconds=1).printed["TOOL"]


def test_files(tmp_path: Path) -> None:
    (tmp_path / "values.yaml").write_text(VALUES, encoding="utf-8")
    script = """
        import rosparam, rospy, yaml
        for values, namespace in rosparam.load_file("values.yaml", default_namespace="/robot"):
            rosparam.upload_params(namespace, values)
        print(rospy.get_param("/robot/gains"), round(rospy.get_param("/robot/angle"), 4))
        print(round(rospy.get_param("/robot/turn"), 4), round(rospy.get_param("/robot/explicit"), 4))
        print(rospy.get_param("/robot/picture").data)
        rosparam.dump_params(None, "/robot/picture")
        rosparam.print_params(rosparam.get_param("/robot/gains"), "/robot/gains")
        print(yaml.safe_load("deg(90)"))
        for wrong in ("x: !radians a +", "x: !degrees much"):
            try:
                rosparam.load_str(wrong, "text")
            except rosparam.RosParamException as error:
                print(error)
        for wrong in (lambda: rosparam.upload_params("/", 5), lambda: rosparam.set_param_raw("/x", {1: 2})):
            try:
                wrong()
            except rosparam.RosParamException as error:
                print(str(error).splitlines()[0])
    """
    assert said(tmp_path, script) == [
        "{'p': 1.5, 'i': 0} 1.5708",
        "6.2832 3.1416",
        r"b'\x00\xff'",
        "!!binary |",
        "  AP8=",
        "/robot/gains/p=1.5",
        "/robot/gains/i=0",
        "deg(90)",
        "invalid radian expression: a +",
        "invalid degree value: much",
        "global / can only be set to a dictionary",
        "YAML dictionaries must have string keys. Invalid dictionary is:",
    ]


def test_commands(tmp_path: Path) -> None:
    (tmp_path / "values.yaml").write_text("a: 1\nb: {c: text}\n", encoding="utf-8")
    script = """
        import rosparam
        for command in (
            ["load", "values.yaml", "/robot"], ["get", "/robot/b/c"], ["get", "-p", "/robot"], ["list", "/robot"],
            ["set", "-v", "/robot/a", "[1, 2]"], ["set", "/robot/empty", ""], ["get", "/robot/empty"],
            ["set", "-t", "values.yaml", "/robot/file"], ["get", "-p", "/robot/file"], ["delete", "-v", "/robot/a"],
            ["dump", "out.yaml", "/robot/b"], ["delete", "/robot/a"], ["what"], ["get"],
        ):
            try:
                rosparam.yamlmain(["rosparam", *command])
            except SystemExit as end:
                print("exit", end.code)
        print(open("out.yaml").read())
    """
    lines = said(tmp_path, script)
    assert lines[:6] == ["text", "a: 1", "b:", "  c: text", "/robot/a", "/robot/b/c"]
    assert lines[6:11] == ["set parameter [/robot/a] to [[1, 2]]", "''", "", "a: 1", "b: {c: text}"]
    assert "deleted parameter [/robot/a]" in lines
    assert [line for line in lines if line.startswith("exit")] == ["exit 1", "exit 0", "exit 2"]
    assert lines[-2:] == ["c: text", ""]
    assert "ERROR: parameter [/robot/a] is not set" in lines

"""What the reader says about launch files: places of errors, notes, packages, programs that are stood in for."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping
from pathlib import Path

import pytest

from cfepy.status import UsageError
from rospy_shim.msgs import Packages
from rospy_shim.parameter_values import DateTime
from rospy_shim.roslaunch.model import Launch
from rospy_shim.roslaunch.reader import read


def launch(folder: Path, body: str, **args: str) -> Launch:
    file = folder / "x.launch"
    file.write_text(f"<launch>\n{textwrap.dedent(body)}</launch>\n")
    return read_file(file, args)


def read_file(file: Path, args: Mapping[str, str] | None = None, environ: Mapping[str, str] | None = None) -> Launch:
    return read(file, args or {}, Packages(file, environ or {}), environ or {})


@pytest.mark.parametrize(
    ("tag", "said"),
    [
        ('<param name="a" value="x" type="int"/>', "x.launch:3: <param value>: is 'x', which is no number of type int"),
        ('<arg name="x"/><param name="a" value="$(arg x)"/>', "<param value>: the argument 'x' has no value; give x:="),
        ('<node pkg="p" name="n"/>', "x.launch:3: <node>: has no 'type'; write type="),
        ('<group ns="">\n</group>', "x.launch:3: <group ns>: is ''; write a namespace such as arm"),
        ('<param name="a" command="ls -l"/>', "would start the program 'ls', which cfepy does not do"),
        ('<param name="a" value="$(eval 1 / 0)"/>', "has no value: ZeroDivisionError"),
        ('<param name="a" value="$(eval open(1))"/>', "NameError: name 'open' is not defined"),
        ('<param name="a" value="$(find nothing)"/>', "there is no package 'nothing'; put it beside"),
        ('<include file="none.launch"/>', "x.launch:3: <include file>: none.launch cannot be read: No such file"),
        ("<rosparam>a: rad(two)</rosparam>", "'two' is no angle"),
        ("<rosparam>a: 2001-01-01</rosparam>", "<rosparam>: /a is datetime.date(2001, 1, 1), which no"),
        ('<param name="a" value="4294967296"/>', "<param>: /a is 4294967296, which no parameter can be: int exceeds"),
        ('<remap from="a"/>', "x.launch:3: <remap>: has no 'to'; write to="),
    ],
)
def test_an_error_says_where_and_what(tmp_path: Path, tag: str, said: str) -> None:
    with pytest.raises(UsageError) as raised:
        launch(tmp_path, f"\n{tag}\n")
    assert said in str(raised.value)
    assert str(raised.value).count("x.launch:") <= 1


def test_a_date_and_time_is_a_parameter(tmp_path: Path) -> None:
    found = launch(tmp_path, "<rosparam>when: 2026-11-21 18:50:00</rosparam>").params
    assert found == {"/when": DateTime("20261121T18:50:00")}


def test_an_error_in_an_included_file_names_that_file(tmp_path: Path) -> None:
    (tmp_path / "inner.launch").write_text('<launch>\n\n<node pkg="p" type="t" name="a/b"/></launch>')
    with pytest.raises(UsageError, match=r"inner\.launch:3: <node name>: is 'a/b'"):
        launch(tmp_path, '<include file="$(dirname)/inner.launch"/>')


def test_a_file_that_includes_itself_ends(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="does a file include itself"):
        launch(tmp_path, '<include file="$(dirname)/x.launch"/>')


@pytest.mark.parametrize(
    ("tag", "said"),
    [
        ('<machine name="m" address="a"/>', "<machine> is ignored"),
        ("<frob/>", "<frob> is not known"),
        ('<node pkg="p" type="t" name="n" frob="1"/>', "<node> has no attribute 'frob'"),
        ('<node pkg="p" type="t" name="n" launch-prefix="gdb"/>', "launch-prefix='gdb' is ignored"),
        ('<rosparam command="delete" param="x"/>', '<rosparam command="delete"> is left out'),
        ('<param name="a" value="1"/><param name="a/b" value="1"/>', "parameter /a/b replaces /a"),
    ],
)
def test_what_does_not_count_is_noted(tmp_path: Path, tag: str, said: str) -> None:
    (note,) = launch(tmp_path, tag).notes
    assert said in note
    assert note.startswith(f"{tmp_path}/x.launch:2: ")


def test_an_argument_that_nobody_declares_is_noted(tmp_path: Path) -> None:
    assert launch(tmp_path, '<arg name="x" default="1"/>', x="2", y="3").notes == [
        f"{tmp_path}/x.launch: has no argument 'y'; y:=3 is ignored"
    ]


def test_packages_are_found_near_and_on_the_package_path(tmp_path: Path) -> None:
    for name in ("ws/here", "ws/beside", "far/away"):
        folder = tmp_path / name
        folder.mkdir(parents=True)
        (folder / "package.xml").write_text(f"<package><name>{folder.name}</name></package>")
    file = tmp_path / "ws/here/launch/x.launch"
    file.parent.mkdir()
    file.write_text('<launch><param name="a" value="$(find here) $(find beside) $(find away)"/></launch>')
    found = read_file(file, environ={"ROS_PACKAGE_PATH": str(tmp_path / "far")})
    assert found.params["/a"] == f"{tmp_path}/ws/here {tmp_path}/ws/beside {tmp_path}/far/away"


def test_the_namespace_of_the_environment_is_around_everything(tmp_path: Path) -> None:
    file = tmp_path / "x.launch"
    file.write_text('<launch><param name="a" value="1"/><node pkg="p" type="t" name="n"/></launch>')
    found = read_file(file, environ={"ROS_NAMESPACE": "robot"})
    assert list(found.params) == ["/robot/a"]
    assert found.nodes[0].full_name == "/robot/n"


def test_cat_and_xacro_are_stood_in_for(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("12")
    assert launch(tmp_path, '<param name="a" command="cat $(dirname)/a.txt"/>').params == {"/a": 12}
    with pytest.raises(UsageError, match=r"names 0 files|needs the Python package xacro"):
        launch(tmp_path, '<param name="a" command="$(find xacro)/xacro --inorder"/>')

"""The reader's messages about launch files: locations of errors, notes, packages, programs with stand-ins."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping
from pathlib import Path

import pytest

from cfepy.reading.mistakes import Mistakes
from cfepy.status import UsageError
from rospy_shim.parameters.values import DateTime
from rospy_shim.roslaunch.launch_plan import compiled_folders, plan_of
from rospy_shim.roslaunch.model import Launch
from rospy_shim.roslaunch.reader import read
from rospy_shim.types.msgs import Packages


def launch(folder: Path, body: str, **args: str) -> Launch:
    file = folder / "x.launch"
    file.write_text(f"<launch>\n{textwrap.dedent(body)}</launch>\n", encoding="utf-8")
    return read_file(file, args)


def read_file(file: Path, args: Mapping[str, str] | None = None, environ: Mapping[str, str] | None = None) -> Launch:
    return read(file, args or {}, Packages(file, environ or {}), environ or {})


@pytest.mark.parametrize(
    ("tag", "said"),
    [
        ('<param name="a" value="x" type="int"/>', "x.launch:3: <param value>: must be a number of type int, not 'x'"),
        ('<arg name="x"/><param name="a" value="$(arg x)"/>', "<param value>: the argument 'x' has no value; give x:="),
        ('<node pkg="p" name="n"/>', "x.launch:3: <node>: missing 'type'; write type="),
        ('<group ns="">\n</group>', "x.launch:3: <group ns>: invalid namespace ''; expected a name such as arm"),
        ('<param name="a" command="ls -l"/>', "cannot start the program 'ls'"),
        ('<param name="a" value="$(eval 1 / 0)"/>', "cannot evaluate $(eval 1 / 0): ZeroDivisionError"),
        ('<param name="a" value="$(eval open(1))"/>', "NameError: name 'open' is not defined"),
        ('<param name="a" value="$(find nothing)"/>', "unknown package 'nothing'; put it next to"),
        ('<include file="none.launch"/>', "x.launch:3: <include file>: none.launch cannot be read: No such file"),
        (
            "<rosparam>a: rad(two)</rosparam>",
            "has an invalid angle 'rad(two)': name 'two' is not defined",
        ),
        ("<rosparam>a: 2001-01-01</rosparam>", "<rosparam>: invalid value datetime.date(2001, 1, 1) of /a"),
        ('<param name="a" value="4294967296"/>', "<param>: invalid value 4294967296 of /a: int exceeds"),
        ('<remap from="a"/>', "x.launch:3: <remap>: missing 'to'; write to="),
        ('<param name="" value="1"/>', "x.launch:3: <param>: must not name all parameters"),
    ],
)
def test_error_has_file_line_and_reason(tmp_path: Path, tag: str, said: str) -> None:
    with pytest.raises(UsageError) as raised:
        launch(tmp_path, f"\n{tag}\n")
    assert said in str(raised.value)
    assert str(raised.value).count("x.launch:") <= 1


def test_date_and_time_is_a_valid_parameter(tmp_path: Path) -> None:
    found = launch(tmp_path, "<rosparam>when: 2026-11-21 18:50:00</rosparam>").params
    assert found == {"/when": DateTime("20261121T18:50:00")}


def test_error_in_an_included_file_names_that_file(tmp_path: Path) -> None:
    (tmp_path / "inner.launch").write_text('<launch>\n\n<node pkg="p" type="t" name="a/b"/></launch>', encoding="utf-8")
    with pytest.raises(UsageError, match=r"inner\.launch:3: <node name>: invalid node name 'a/b'"):
        launch(tmp_path, '<include file="$(dirname)/inner.launch"/>')


def test_file_that_includes_itself_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="check for a file that includes itself"):
        launch(tmp_path, '<include file="$(dirname)/x.launch"/>')


@pytest.mark.parametrize(
    ("tag", "said"),
    [
        ('<machine name="m" address="a"/>', "<machine> is ignored"),
        ("<frob/>", "unknown tag <frob>"),
        ('<node pkg="p" type="t" name="n" frob="1"/>', "<node> has no attribute 'frob'"),
        ('<node pkg="p" type="t" name="n" launch-prefix="gdb"/>', "launch-prefix='gdb' is ignored"),
        ('<rosparam command="delete" param="x"/>', '<rosparam command="delete"> is left out'),
        ('<param name="a" value="1"/><param name="a/b" value="1"/>', "parameter /a/b replaces its parent /a"),
    ],
)
def test_ignored_tags_are_noted(tmp_path: Path, tag: str, said: str) -> None:
    (note,) = map(str, launch(tmp_path, tag).remarks)
    assert said in note
    assert note.startswith(f"{tmp_path}/x.launch:2: ")


def test_undeclared_argument_is_noted(tmp_path: Path) -> None:
    remarks = launch(tmp_path, '<arg name="x" default="1"/><param name="x" value="$(arg x)"/>', x="2", y="3").remarks
    assert list(map(str, remarks)) == [f"{tmp_path}/x.launch: unknown argument 'y'; y:=3 is ignored"]


def test_packages_are_found_near_and_on_the_package_path(tmp_path: Path) -> None:
    for name in ("ws/here", "ws/beside", "far/away"):
        folder = tmp_path / name
        folder.mkdir(parents=True)
        (folder / "package.xml").write_text(f"<package><name>{folder.name}</name></package>", encoding="utf-8")
    file = tmp_path / "ws/here/launch/x.launch"
    file.parent.mkdir()
    file.write_text(
        '<launch><param name="a" value="$(find here) $(find beside) $(find away)"/></launch>', encoding="utf-8"
    )
    found = read_file(file, environ={"ROS_PACKAGE_PATH": str(tmp_path / "far")})
    assert found.params["/a"] == f"{tmp_path}/ws/here {tmp_path}/ws/beside {tmp_path}/far/away"


def test_namespace_of_the_environment_applies_to_everything(tmp_path: Path) -> None:
    file = tmp_path / "x.launch"
    file.write_text('<launch><param name="a" value="1"/><node pkg="p" type="t" name="n"/></launch>', encoding="utf-8")
    found = read_file(file, environ={"ROS_NAMESPACE": "robot"})
    assert list(found.params) == ["/robot/a"]
    assert found.nodes[0].full_name == "/robot/n"


def test_cat_and_xacro_are_replaced_by_builtins(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("12", encoding="utf-8")
    assert launch(tmp_path, '<param name="a" command="cat $(dirname)/a.txt"/>').params == {"/a": 12}
    with pytest.raises(UsageError, match=r"must name one file for xacro|requires the Python package xacro"):
        launch(tmp_path, '<param name="a" command="$(find xacro)/xacro --inorder"/>')


def collected(folder: Path, body: str, **args: str) -> list[tuple[str, int, str]]:
    """Return the errors of a launch file and its omitted parts: file, line, text."""
    file, mistakes = folder / "x.launch", Mistakes()
    file.write_text(f"<launch>\n{textwrap.dedent(body)}</launch>\n", encoding="utf-8")
    remarks = read(file, args, Packages(file, {}), {}, mistakes).remarks
    errors = [
        (Path(error.file or "").name, error.line or 0, f"{error.field}: {error.text}") for error in mistakes.errors
    ]
    return sorted(errors + [(remark.file.name, remark.line, remark.text) for remark in remarks])


def test_check_reads_a_file_to_the_end(tmp_path: Path) -> None:
    (tmp_path / "inner.launch").write_text(
        '<launch>\n<arg name="rate"/>\n<param name="$(arg rate)" value="1"/></launch>', encoding="utf-8"
    )
    (tmp_path / "broken.yaml").write_text("a: [1\n", encoding="utf-8")
    (tmp_path / "broken.launch").write_text("<launch>\n<group>\n</launch>", encoding="utf-8")
    found = collected(
        tmp_path,
        """\
        <node pkg="p" type="t" respawn="perhaps" nme="n"/>
        <nod pkg="p" type="t" name="n"/>
        <param name="a" value="$(arg missing)"/>
        <param name="b" value="$(find nothing)" type="int"/>
        <include file="none.launch"/>
        <include file="$(dirname)/inner.launch"/>
        <include file="$(dirname)/inner.launch"><arg name="rat" value="5"/></include>
        <rosparam file="$(dirname)/broken.yaml"/>
        <remap from="a"/>
        <node pkg="p" type="t" name="twice"/>
        <node pkg="p" type="t" name="twice" args="$(eval 1 / 0)"/>
        <test pkg="p" type="t" test-name="t" time-limit="soon"/>
        <include file="$(dirname)/broken.launch"/>
        <param name="c" value="x" type="double"/>
        """,
    )
    assert [(file, line) for file, line, _ in found] == [
        ("broken.launch", 3),
        ("inner.launch", 3),
        ("inner.launch", 3),
        *(("x.launch", line) for line in (2, 2, 2, 3, 4, 5, 6, 8, 9, 10, 12, 12, 13, 15)),
    ]
    texts = "\n".join(text for _, _, text in found)
    for said in (
        "mismatched tag, column 3; the <group> of line 2 is not closed",
        "the argument 'rate' has no value; pass it in the <include> of ",
        "<node respawn>: must be true or false, not 'perhaps'",
        "<node>: missing 'name'",
        "<node> has no attribute 'nme'; it is ignored, did you mean name?",
        "unknown tag <nod>; it is ignored, did you mean <node>?",
        "<include file>: passes rat, which",
        "/broken.yaml is not YAML",
        "/twice is also the name of the node at",
        "<test time-limit>: must be a number",
    ):
        assert said in texts


def test_unknown_words_get_the_nearest_known_one(tmp_path: Path) -> None:
    (tmp_path / "package.xml").write_text("<package><name>robot</name></package>", encoding="utf-8")
    found = collected(
        tmp_path,
        """\
        <param name="a" value="$(find robt)"/>
        <param name="b" value="$(agr x)"/>
        <param name="c" value="1" type="flaot"/>
        <param name="d" value="1" type="doubel"/>
        <node pkg="p" type="t" name="n" output="scren" cwd="nod"/>
        <node pkg="p" tpye="t" name="m"/>
        """,
    )
    assert [text for _, _, text in found] == [
        "<param value>: unknown package 'robt'; did you mean robot?",
        "<param value>: unknown substitution $(agr x); known are find, env, optenv, dirname, anon, arg, and eval "
        "alone; did you mean arg?",
        "<param value>: unknown type 'flaot'; expected str, string, int, double, bool, boolean, yaml or auto",
        "<param value>: unknown type 'doubel'; did you mean double?",
        "<node cwd>: invalid value 'nod'; did you mean node? (expected node, cwd, ROS_HOME or ros-root)",
        "<node output>: invalid value 'scren'; did you mean screen? (expected screen or log)",
        "<node> has no attribute 'tpye'; it is ignored, did you mean type?",
        "<node>: missing 'type'; write type=\"...\" instead of tpye=",
    ]


def test_consequences_of_a_mistake_are_not_reported(tmp_path: Path) -> None:
    found = collected(
        tmp_path,
        """\
        <arg name="x" value="$(find nothing)"/>
        <arg name="y" default="$(arg x)/y" if="$(eval 1 / 0)"/>
        <param name="a" value="$(arg x)$(arg y)"/>
        <param name="b" value="$(eval x + 1)"/>
        <group if="$(arg x)"><param/></group>
        <param name="c" value="$(arg z)"/>
        <param name="d" value="$(arg z)"/>
        """,
    )
    assert [line for _, line, _ in found] == [2, 3, 7]


def test_file_that_includes_itself_twice_is_refused(tmp_path: Path) -> None:
    include = '<include file="$(dirname)/x.launch"/>\n'
    assert [line for _, line, _ in collected(tmp_path, include * 2)] == [2]


@pytest.mark.parametrize(
    ("body", "unused"),
    [
        ('<arg name="x" default="1"/><arg name="y" default="$(arg x)"/>', ["y"]),
        ('<arg name="x" default="1"/><group if="false"><param name="a" value="$(arg x)"/></group>', []),
        ('<arg name="x" default="1"/><param name="a" value="$(eval int(x) + 1)"/>', []),
        ("""<arg name="x" default="1"/><param name="a" value="$(eval arg('x') + 1)"/>""", []),
        ('<arg name="x" default="1"/><rosparam subst_value="true">a: $(arg x)</rosparam>', []),
        ('<arg name="x" default="1"/><include file="$(dirname)/in.launch" pass_all_args="true"/>', []),
        ('<arg name="x" default="1"/><include file="$(dirname)/in.launch"><arg name="z" value="1"/></include>', ["x"]),
        ('<arg name="x" default="1"/><rosparam file="$(dirname)/a.yaml" subst_value="true"/>', []),
    ],
)
def test_unused_arguments_are_reported(tmp_path: Path, body: str, unused: list[str]) -> None:
    (tmp_path / "a.yaml").write_text("a: $(arg x)\n", encoding="utf-8")
    (tmp_path / "in.launch").write_text(
        '<launch><arg name="z" default="1"/><param name="$(arg z)" value="2"/></launch>', encoding="utf-8"
    )
    found = [text for _, _, text in collected(tmp_path, body)]
    assert found == [f"unused argument {name!r}; remove it, or use $(arg ...)" for name in unused]


def test_tags_nested_too_deeply_are_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"x\.launch:2: <group>: is nested more than 100 tags deep"):
        launch(tmp_path, "<group>" * 2000 + "</group>" * 2000)


def test_results_of_a_test_stay_in_their_folder(tmp_path: Path) -> None:
    """A test's own name may have any characters. A node's name may not, and differs here."""
    names = ("good", "../../victim", "/victim", "a b", "a/b", "a_b", "x" * 5000, "é")
    tests = "".join(f'<test test-name="{name}" name="n{at}" pkg="arm" type="t.py"/>' for at, name in enumerate(names))
    (tmp_path / "package.xml").write_text("<package><name>arm</name></package>", encoding="utf-8")
    (tmp_path / "t.py").write_text("#!/usr/bin/env python3\n", encoding="utf-8")
    (tmp_path / "x.launch").write_text(f"<launch>{tests}</launch>", encoding="utf-8")
    plan = plan_of(tmp_path / "x.launch", {}, {}, results=tmp_path / "results")
    files = [test.results for test in plan.tests]
    assert files[0].name == "arm-good.xml"
    assert {each.parent for each in files} == {tmp_path / "results"}
    assert len(set(files)) == len(names)
    assert max(len(each.name) for each in files) < 255


def test_program_named_after_its_source_file_by_cmake_is_built(tmp_path: Path) -> None:
    (tmp_path / "package.xml").write_text("<package><name>robots</name></package>", encoding="utf-8")
    loop = "foreach(file ${FILES})\nget_filename_component(name ${file} NAME_WE)\nadd_executable(${name} ${file})\n"
    (tmp_path / "CMakeLists.txt").write_text(f"file(GLOB FILES node/*.cpp)\n{loop}endforeach()\n", encoding="utf-8")
    (tmp_path / "node").mkdir()
    (tmp_path / "node/arm.cpp").touch()
    packages = Packages(tmp_path / "x.launch", {})
    assert compiled_folders(packages, "robots", "arm")
    assert not compiled_folders(packages, "robots", "leg")

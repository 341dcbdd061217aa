"""Launch files, nodes and message definitions of a mission: all problems at once, each with file and line."""

from __future__ import annotations

import textwrap
from pathlib import Path

import pytest

from cfepy.pilot.mission_check import check_mission
from cfepy.status import UsageError

TALKER = """\
    import rospy
    from std_msgs.msg import String, Strnig
    from std_srvs.srv import SetBool, SetBoolResponse
    from demo.msg import Drive, Drvie
    from demoo.msg import Drive
    from json.msg import nothing
    """


@pytest.fixture
def demo(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a package `demo` with a node. The current folder is beside it."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("ROS_PACKAGE_PATH", raising=False)
    files = {
        "package.xml": "<package><name>demo</name></package>",
        "CMakeLists.txt": "add_executable(${PROJECT_NAME}_driver src/driver.cpp)\n",
        "scripts/talker.py": TALKER,
        "scripts/good.py": "import rospy\n",
        "msg/Drive.msg": "float32 speed\nfloat32 speed\nin32 x\n",
        "srv/Go.srv": "bool go\n---\nDrive d\nint8 BIG=200\n",
        "launch/good.launch": '<launch><node pkg="demo" type="good.py" name="n"/></launch>',
    }
    for name, text in files.items():
        path = tmp_path / "demo" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(textwrap.dedent(text), encoding="utf-8")
    return tmp_path / "demo"


DEFINITIONS = [("Drive.msg", 2, False), ("Drive.msg", 3, False), ("Go.srv", 4, False)]
IMPORTS = [("talker.py", 2, False), ("talker.py", 4, False), ("talker.py", 5, False), ("talker.py", 6, False)]


def places(mission: str) -> list[tuple[str, int, bool]]:
    return sorted((problem.file.name, problem.line, problem.is_warning) for problem in check_mission(mission))


def test_all_problems_of_a_node_and_its_imports_are_reported(demo: Path) -> None:
    assert places("demo/scripts/talker.py") == [*DEFINITIONS, *IMPORTS]
    texts = "\n".join(problem.text for problem in check_mission("demo/scripts/talker.py"))
    for said in (
        "package std_msgs has no msg Strnig; did you mean String?",
        "package demo has no msg Drvie; did you mean Drive?",
        "unknown message package demoo; did you mean demo?",
    ):
        assert said in texts


def test_definitions_of_the_package_of_a_launch_file(demo: Path) -> None:
    assert places("demo/launch/good.launch") == DEFINITIONS
    assert places("demo good.launch") == DEFINITIONS


def test_definitions_in_the_folder_of_a_mission_without_nodes(demo: Path) -> None:
    (demo.parent / "startup.scr").write_text("!", encoding="utf-8")
    assert places(".") == DEFINITIONS


def test_a_launch_file_with_many_problems(demo: Path) -> None:
    (demo / "msg/Drive.msg").write_text("float32 speed\n", encoding="utf-8")
    (demo / "srv/Go.srv").unlink()
    (demo / "launch/bad.launch").write_text(
        textwrap.dedent(
            """\
            <launch>
              <arg name="never" default="1"/>
              <node pkg="demo" type="godo.py" name="a"/>
              <node pkg="demoo" type="good.py" name="b"/>
              <node pkg="demo" type="demo_driver" name="c"/>
              <node pkg="demo" type="driver" name="d" required="true"/>
              <node pkg="demo" type="good.py" name="e" args="'open"/>
              <test pkg="demo" type="none.py" test-name="t"/>
              <machine name="m" address="x"/>
              <param name="nothing" type="yaml" value="null"/>
              <rosparam>empty: null</rosparam>
            </launch>
            """
        ),
        encoding="utf-8",
    )
    found = check_mission("demo/launch/bad.launch", args={"other": "1"})
    assert [(problem.line, problem.is_warning) for problem in found] == [
        (0, True),
        (2, True),
        (3, False),
        (4, False),
        (5, True),
        (6, False),
        (7, False),
        (8, False),
        (9, True),
        (10, False),
        (11, True),
    ]
    texts = [problem.text for problem in found]
    assert texts[0] == "unknown argument 'other'; other:=1 is ignored"
    assert "did you mean good.py?" in texts[2]
    assert "did you mean demo?" in texts[3]
    assert "/d is required, but package 'demo' has no file 'driver'" in texts[5]
    assert "test t cannot run here" in texts[7]


def test_launch_file_without_a_node_is_an_error(demo: Path) -> None:
    (demo / "msg/Drive.msg").unlink()
    (demo / "srv/Go.srv").unlink()
    (demo / "launch/empty.launch").write_text("<launch/>", encoding="utf-8")
    (problem,) = check_mission("demo/launch/empty.launch")
    assert problem.text == "has no node that cfepy can run"
    (demo / "launch/a.test").write_text(
        '<launch><test pkg="demo" type="good.py" test-name="t"/></launch>', encoding="utf-8"
    )
    assert check_mission("demo/launch/a.test") == []


def test_launch_files_of_a_mission_are_read_to_the_end(demo: Path) -> None:
    (demo.parent / "startup.scr").write_text("!", encoding="utf-8")
    (demo / "launch/bad.launch").write_text("<launch>\n<remap/>\n<env/>\n<nod/></launch>", encoding="utf-8")
    (demo.parent / "mission.yaml").write_text(
        "launch: [demo/launch/bad.launch, demo/launch/good.launch]\n", encoding="utf-8"
    )
    found = [problem.line for problem in check_mission(".") if problem.file.name == "bad.launch"]
    assert found == [2, 2, 3, 3, 4]


def test_arguments_of_a_mission_and_missing_launch_files_are_errors(demo: Path) -> None:
    (demo.parent / "startup.scr").write_text("!", encoding="utf-8")
    with pytest.raises(UsageError, match="is not a launch file, so it takes no arguments"):
        check_mission(".", args={"a": "1"})
    with pytest.raises(UsageError, match=r"'nothing\.launch'"):
        check_mission("demo nothing.launch")

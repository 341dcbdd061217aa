"""The library roslaunch: a node that starts other nodes and launch files while the mission runs."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.rospy_shim.missions import Run, run_nodes

CHILD = """
import sys
import rospy
rospy.init_node("child")
print("runs", rospy.get_name(), rospy.get_param("~x", None), sys.argv[1:])
rospy.on_shutdown(lambda: print("ends"))
rospy.spin()
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A mission's folder with a package `pack` in it."""
    pack = tmp_path / "pack"
    pack.mkdir()
    (pack / "package.xml").write_text("<package><name>pack</name></package>", encoding="utf-8")
    (pack / "child.py").write_text(CHILD, encoding="utf-8")
    (pack / "two.launch").write_text(
        '<launch><arg name="x" default="1"/>'
        '<node pkg="pack" type="child.py" name="one" ns="arm"><param name="x" value="$(arg x)"/></node>'
        '<node pkg="pack" type="child.py" name="two"/></launch>',
        encoding="utf-8",
    )
    return tmp_path


def fly(folder: Path, source: str) -> Run:
    head = "import rospy, roslaunch\nrospy.init_node('boss')\n"
    return run_nodes(folder, {"BOSS": head + source}, seconds=20)


def test_one_node(folder: Path) -> None:
    source = """
node = roslaunch.core.Node("pack", "child.py", name="kid", namespace="home", args="-v a:=b")
launch = roslaunch.scriptapi.ROSLaunch()
launch.start()
process = launch.launch(node)
print(process.is_alive())
rospy.sleep(2)
process.stop()
print(process.is_alive())
"""
    run = fly(folder, source)
    assert run.printed["boss"] == ["True", "False"]
    assert run.printed["home/kid"] == ["runs /home/kid None ['-v', 'a:=b', '__name:=kid']", "ends"]


def test_stopped_node_is_not_respawned(folder: Path) -> None:
    source = """
launch = roslaunch.scriptapi.ROSLaunch()
launch.start()
process = launch.launch(roslaunch.core.Node("pack", "child.py", name="kid", respawn=True))
rospy.sleep(1)
launch.stop()
rospy.sleep(3)
print(process.is_alive())
"""
    run = fly(folder, source)
    assert run.printed["boss"] == ["False"]
    assert [line.split()[0] for line in run.printed["kid"]] == ["runs", "ends"]


def test_a_launch_file_with_arguments(folder: Path) -> None:
    source = """
uuid = roslaunch.rlutil.get_or_generate_uuid(None, False)
roslaunch.configure_logging(uuid)
file = roslaunch.rlutil.resolve_launch_arguments(["pack", "two.launch"])[0]
parent = roslaunch.parent.ROSLaunchParent(uuid, [(file, ["x:=7"])])
parent.start()
rospy.sleep(2)
print(rospy.get_param("/arm/one/x"))
parent.shutdown()
parent.start()
"""
    run = fly(folder, source)
    assert run.printed["boss"] == ["7"]
    again = ["runs /arm/one 7 ['__name:=one']", "ends"]
    assert run.printed["arm/one"] == again * 2
    assert run.finished


def test_invalid_launch_is_reported(folder: Path) -> None:
    source = """
launch = roslaunch.scriptapi.ROSLaunch()
for make in (
    lambda: launch.launch(roslaunch.core.Node("pack", "child.py")),
    lambda: (launch.start(), launch.launch(roslaunch.core.Node("pack", "binary"))),
    lambda: roslaunch.parent.ROSLaunchParent(None, ["none.launch"]).start(),
):
    try:
        make()
    except roslaunch.RLException as error:
        print(error)
"""
    started, missing, no_file = fly(folder, source).printed["boss"]
    assert started == "please start ROSLaunch first"
    assert missing.startswith("cannot launch node of type [pack/binary]: package 'pack' has no file 'binary'")
    assert "none.launch: cannot be read" in no_file


def test_substitution_args(folder: Path) -> None:
    source = """
from roslaunch.substitution_args import ArgException, SubstitutionException, resolve_args
context = {"arg": {"a": "1"}}
print(resolve_args("$(find pack)/x").endswith("/pack/x"), resolve_args("$(arg a)$(optenv NO b)", context))
print(resolve_args("$(anon n)", context), resolve_args("$(anon n)", context))
for text in ("$(arg z)", "$(frob)"):
    try:
        resolve_args(text, context)
    except SubstitutionException as error:
        print(type(error).__name__, str(error)[:12])
"""
    assert fly(folder, source).printed["boss"] == [
        "True 1b",
        "n_cfepy_1 n_cfepy_1",
        "ArgException z",
        "SubstitutionException unknown subs",
    ]

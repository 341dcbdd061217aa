"""`keys` of a node in a mission file: its terminal input, and invalid values."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.mission import Mission, read_mission
from cfepy.status import UsageError
from cfepy.writing.console import Console

TELEOP = """
import sys, tty
import rospy

rospy.init_node("teleop")
tty.setcbreak(sys.stdin)
begun = rospy.get_time()
while not rospy.is_shutdown():
    print(repr(sys.stdin.read(1)), round(rospy.get_time() - begun, 1))
"""


def mission_with(folder: Path, keys: str, script: str = TELEOP) -> str:
    """Write a mission of one node."""
    (folder / "teleop.py").write_text(script, encoding="utf-8")
    (folder / "startup.scr").write_text("CFE_APP, teleop.py, __main__, TELEOP, 100, 16384, 0, 0;!", encoding="utf-8")
    (folder / "mission.yaml").write_text(f"nodes:\n  TELEOP: {{keys: {keys}}}\n", encoding="utf-8")
    return str(folder)


def test_keys_are_typed_at_their_times(tmp_path: Path) -> None:
    console = Console(quiet=True)
    with Mission(mission_with(tmp_path, '["s", 0.5, "w", "\\x1b[A"]'), console=console) as mission:
        mission.run_for(3)
    lines = [line for line in console.lines if line.startswith("[teleop]")]
    keys = ["'s' 0.1", "'w' 0.7", r"'\x1b' 0.8", "'[' 0.8", "'A' 0.8"]
    assert lines == [f"[teleop] {key}" for key in keys]


def test_ctrl_c_shuts_a_node_down(tmp_path: Path) -> None:
    script = """
        import rospy
        rospy.init_node("spinner")
        rospy.on_shutdown(lambda: print("hook"))
        rospy.spin()
        print("over", rospy.is_shutdown())
    """
    console = Console(quiet=True)
    script = "\n".join(line[8:] for line in script.splitlines())
    with Mission(mission_with(tmp_path, '["\\x03"]', script), console=console) as mission:
        mission.run_for(2)
        assert mission.ros.all_finished()
        assert mission.ros.ended["TELEOP"].status == 0
    assert [line for line in console.lines if line.startswith("[spinner]")] == ["[spinner] hook", "[spinner] over True"]


@pytest.mark.parametrize("keys", ["[-1]", "[true]", "[[]]", "[null]"])
def test_keys_other_than_texts_are_refused(tmp_path: Path, keys: str) -> None:
    with pytest.raises(UsageError, match=r"mission.yaml:2: nodes.TELEOP.keys.*must be a text to type"):
        read_mission(mission_with(tmp_path, keys))

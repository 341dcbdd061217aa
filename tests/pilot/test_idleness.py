"""Nodes that do nothing, as a run reports them."""

from __future__ import annotations

from pathlib import Path

from cfepy.pilot import pilot
from cfepy.pilot.plan import RunPlan
from tests.mission.flights import write_mission

STARTUP = """
    CFE_APP, first.py, __main__, FIRST, 100, 16384, 0x0, 0;
    CFE_APP, second.py, __main__, SECOND, 110, 16384, 0x0, 0;
    !
"""
NODE = """
    import rospy_shim as rospy

    rospy.init_node("{}")
    rospy.spin()
"""


def loose_ends(folder: Path, first: str, second: str) -> list[str]:
    mission = write_mission(folder, STARTUP, first=NODE.format(first), second=NODE.format(second))
    return pilot.fly(RunPlan((mission,), seconds=2.0)).results.loose_ends


def test_node_whose_name_another_takes_has_a_line(tmp_path: Path) -> None:
    assert loose_ends(tmp_path, "arm", "arm") == [
        "/arm: the node of FIRST was shut down when the node of SECOND took its name; give one of them another name"
    ]


def test_nodes_with_names_of_their_own_have_none(tmp_path: Path) -> None:
    assert loose_ends(tmp_path, "arm", "leg") == []

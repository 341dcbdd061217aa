"""bondpy: two nodes that are bound to each other."""

from __future__ import annotations

from pathlib import Path

from tests.rospy_shim.missions import run_nodes

OTHER = """
import rospy
from bondpy.bondpy import Bond
rospy.init_node("other")
bond = Bond("/bond", "id")
bond.start()
print(bond.wait_until_formed(rospy.Duration(5)))
rospy.sleep({lives})
{end}
"""

ONE = """
import rospy
from bondpy import bondpy
rospy.init_node("one")
began = rospy.get_time()
bond = bondpy.Bond("/bond", "id", on_broken=lambda: print("broken"), on_formed=lambda: print("formed"))
bond.set_heartbeat_timeout(rospy.Duration(2.0))
bond.connect_timeout = 3.0
bond.start()
print(bond.wait_until_formed(), bond.is_broken())
print(bond.wait_until_broken(rospy.Duration(20)), bond.is_broken(), round(rospy.get_time() - began))
bond.shutdown()
"""


def test_other_end_breaks_the_bond(tmp_path: Path) -> None:
    other = OTHER.format(lives=1.0, end="bond.break_bond()\nprint(bond.wait_until_broken(rospy.Duration(5)), bond)")
    run = run_nodes(tmp_path, {"ONE": ONE, "OTHER": other}, seconds=30.0)
    assert run.printed["one"] == ["formed", "True False", "broken", "True True 1"]
    assert run.printed["other"][0] == "True"
    assert run.printed["other"][1].startswith("True [Bond id, Instance ")
    assert run.printed["other"][1].endswith("(SM.Dead)]")


def test_bond_breaks_when_the_other_end_falls_silent(tmp_path: Path) -> None:
    other = OTHER.format(lives=1.5, end="bond.pub.unregister()\nbond.pub.publish = lambda message: None\nrospy.spin()")
    run = run_nodes(tmp_path, {"ONE": ONE, "OTHER": other}, seconds=30.0)
    assert run.printed["one"] == ["formed", "True False", "broken", "True True 3"]


def test_bond_breaks_when_the_other_end_never_comes(tmp_path: Path) -> None:
    run = run_nodes(tmp_path, {"ONE": ONE}, seconds=30.0)
    assert run.printed["one"] == ["broken", "True True", "True True 3"]


def test_bond_can_be_broken_in_the_formed_callback(tmp_path: Path) -> None:
    script = """
        import rospy
        from bondpy import bondpy
        rospy.init_node("n")
        one, other = bondpy.Bond("/bond", "id"), bondpy.Bond("/bond", "id")
        one.set_formed_callback(one.break_bond)
        one.start()
        other.start()
        print(one.wait_until_formed(rospy.Duration(5)), other.wait_until_broken(rospy.Duration(3)))
    """
    assert run_nodes(tmp_path, {"N": script}, seconds=20.0).printed["n"] == ["True True"]

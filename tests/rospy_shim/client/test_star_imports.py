"""`from package.msg import *` and similar imports: their names in ROS, and names that nodes use implicitly."""

from __future__ import annotations

from pathlib import Path

from tests.rospy_shim.missions import run_nodes


def printed(folder: Path, script: str) -> list[str]:
    """Return one node's output."""
    lines = run_nodes(folder, {"NODE": script}).printed["NODE"]
    return lines


def test_star_import_has_the_modules_that_generated_sources_import(tmp_path: Path) -> None:
    script = """
        from nav_msgs.msg import *
        print(Odometry.__name__, sys.version_info[0], struct.calcsize("<I"), codecs.__name__, genpy.Time(3), python3)
        print(geometry_msgs.msg.Pose().position.x, std_msgs.msg.Header().frame_id == "")
    """
    assert printed(tmp_path, script) == ["Odometry 3 4 codecs 3000000000 True", "0.0 True"]


def test_star_import_has_modules_of_the_node(tmp_path: Path) -> None:
    script = """
        import sys as mine
        from std_srvs.srv import *
        print(sys is mine, SetBoolRequest(True).data)
    """
    assert printed(tmp_path, script) == ["True True"]


def test_star_import_of_actionlib_has_its_imported_modules(tmp_path: Path) -> None:
    script = """
        from actionlib import *
        print(threading.current_thread().name, time.time() > 0, rospy.Time.__name__, Header.__name__)
    """
    assert printed(tmp_path, script) == ["MainThread True Time Header"]

"""Which ROS a program is written for: the mission file, package.xml, then its imports."""

from __future__ import annotations

from pathlib import Path

import pytest

from rospy_shim.types.worlds import is_of_ros2

MANIFEST = "<package><name>demo</name>{}</package>"


def program(folder: Path, text: str, manifest: str = "") -> Path:
    """Return the file of a program."""
    script = folder / "node.py"
    script.write_text(text, encoding="utf-8")
    if manifest:
        (folder / "package.xml").write_text(MANIFEST.format(manifest), encoding="utf-8")
    return script


@pytest.mark.parametrize(
    ("text", "is_2"),
    [
        ("import rclpy\n", True),
        ("from rclpy.node import Node\n", True),
        ("def main():\n    import rclpy\n", True),
        ("import rospy\n", False),
        ("import rospy\nimport rclpy\n", False),
        ("import rclpy_helpers\n", False),
        ("print('import rclpy')\n", False),
    ],
)
def test_imports_decide_without_a_package(tmp_path: Path, text: str, is_2: bool) -> None:
    assert is_of_ros2(program(tmp_path, text)) is is_2


def test_imports_of_modules_beside_the_program_count_if_it_has_none(tmp_path: Path) -> None:
    (tmp_path / "demo").mkdir()
    (tmp_path / "demo" / "__init__.py").write_text("", encoding="utf-8")
    (tmp_path / "demo" / "main.py").write_text("import rclpy\n", encoding="utf-8")
    assert is_of_ros2(program(tmp_path, "from demo.main import main\nmain()\n"))


@pytest.mark.parametrize(
    ("manifest", "is_2"),
    [
        ("<exec_depend>rclpy</exec_depend>", True),
        ("<exec_depend>rospy</exec_depend>", False),
        ("<export><build_type>ament_python</build_type></export>", True),
        ("<buildtool_depend>catkin</buildtool_depend>", False),
    ],
)
def test_package_decides_before_the_imports(tmp_path: Path, manifest: str, is_2: bool) -> None:
    text = "import rospy\n" if is_2 else "import rclpy\n"
    assert is_of_ros2(program(tmp_path, text, manifest)) is is_2


def test_imports_decide_for_a_package_of_both_worlds(tmp_path: Path) -> None:
    both = "<exec_depend>rclpy</exec_depend><exec_depend>rospy</exec_depend>"
    assert is_of_ros2(program(tmp_path, "import rclpy\n", both))


@pytest.mark.parametrize(("said", "is_2"), [(1, False), (2, True)])
def test_mission_file_decides_first(tmp_path: Path, said: int, is_2: bool) -> None:
    other = "import rospy\n" if is_2 else "import rclpy\n"
    assert is_of_ros2(program(tmp_path, other), said) is is_2


def test_program_that_cannot_be_read_is_of_ros_1(tmp_path: Path) -> None:
    assert not is_of_ros2(tmp_path / "absent.py")

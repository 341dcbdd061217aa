"""Libraries are found after a node's own code, executed for each node, and read only when they are imported."""

from __future__ import annotations

from pathlib import Path

from cfepy.nodes import Universe
from cfepy.rtos import Kernel
from rospy_shim.library_parts import FOLDER, library_names
from tests.ros_libraries.world import universe
from tests.rospy_shim.missions import run_nodes


def test_library_names_equal_the_folders() -> None:
    assert {"tf", "tf2_ros", "tf2_py", "tf2_geometry_msgs"} <= library_names()


def test_each_node_executes_its_own_copy_of_a_library() -> None:
    first, second = (universe().importer.load("tf2_ros") for _ in range(2))
    assert first.TransformRegistration is not second.TransformRegistration


def test_modules_are_read_only_when_they_are_needed() -> None:
    node = universe()
    node.importer.load("tf")
    assert not {"numpy", "tf.transformations", "tf.linear_math"} & set(node.importer.modules)


def test_a_library_has_code_and_messages(tmp_path: Path) -> None:
    script = """
        import tf.msg, tf.srv
        from tf.msg import tfMessage
        from tf2_msgs.msg import TFMessage
        print(tfMessage._md5sum == TFMessage._md5sum, tf.srv.FrameGraph._type, tf.Transformer.__module__)
    """
    assert run_nodes(tmp_path, {"NODE": script}).printed["NODE"] == ["True tf/FrameGraph tf.listener"]


def test_copy_in_the_folder_of_the_node_is_preferred(tmp_path: Path) -> None:
    (tmp_path / "tf2_ros").mkdir()
    (tmp_path / "tf2_ros/__init__.py").write_text(
        "from tf2_py import BufferCore\nORIGIN = 'my own'\n", encoding="utf-8"
    )
    script = "import tf2_ros, tf2_py; print(tf2_ros.ORIGIN, tf2_ros.BufferCore is tf2_py.BufferCore)"
    assert run_nodes(tmp_path, {"NODE": script}).printed["NODE"] == ["my own True"]


def test_folder_added_to_the_path_by_the_node_is_preferred(tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere/tf.py").write_text("ORIGIN = 'my own'\n", encoding="utf-8")
    script = f"import sys; sys.path.append({str(tmp_path / 'elsewhere')!r}); import tf; print(tf.ORIGIN)"
    assert run_nodes(tmp_path, {"NODE": script}).printed["NODE"] == ["my own"]


def test_copy_of_a_library_imports_the_compiled_half_of_the_shipped_one(tmp_path: Path) -> None:
    (tmp_path / "tf2_py").mkdir()
    (tmp_path / "tf2_py/__init__.py").write_text("from ._tf2 import *\nORIGIN = 'my own'\n", encoding="utf-8")
    script = "import tf2_py; print(tf2_py.ORIGIN, tf2_py.BufferCore().all_frames_as_yaml())"
    assert run_nodes(tmp_path, {"NODE": script}).printed["NODE"] == ["my own {}"]


def test_importlib_finds_a_library() -> None:
    spec = universe().importer.find_spec("tf2_geometry_msgs")
    assert spec is not None
    assert spec.origin == str(FOLDER / "tf2_geometry_msgs" / "__init__.py")


def test_universe_without_library_paths_has_no_libraries() -> None:
    assert Universe(Kernel(), name="bare").importer.find_spec("tf2_geometry_msgs") is None

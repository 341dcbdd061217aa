"""A library may run beside the original source of another one, and uses only names that the original has.

`library_names.txt` has the names that the libraries use of each other and the originals define (Debian 12: ros_comm
1.15.15, genmsg 0.6.0, genpy 0.6.16, rospkg 1.4.0, roslib and rosunit 1.15.8, geometry2 0.7.6, actionlib 1.14.0).
Libraries that are not a package of ROS (`OWN`), or that are in none of those, are left out.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

from rospy_shim.library_parts import FOLDER, library_names
from tests.rospy_shim.missions import run_nodes

NAMES = Path(__file__).parents[1] / "data" / "library_names.txt"
OWN = ("ros_tools", "rosbag_storage", "ground_nodes")
NOT_RECORDED = ("PyKDL", "tf", "sensor_msgs", "tf2_geometry_msgs", "cv_bridge")


def taken(file: Path) -> Iterator[str]:
    """Yield the names that a library's file uses of other libraries."""
    own = file.relative_to(FOLDER).parts[0]
    others = library_names() - {own, *OWN, *NOT_RECORDED}
    tree = ast.parse(file.read_text(encoding="utf-8"))
    modules: dict[str, str] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found = [each for each in node.names if each.name.partition(".")[0] in others]
            modules |= {each.asname or each.name.partition(".")[0]: each.name if each.asname else "" for each in found}
        elif isinstance(node, ast.ImportFrom) and not node.level and str(node.module).partition(".")[0] in others:
            yield from (f"{node.module}.{each.name}" for each in node.names)
    for node in ast.walk(tree):
        parts = _dotted(node)
        if len(parts) > 1 and parts[0] in modules:
            yield ".".join([modules[parts[0]] or parts[0], *parts[1:]])


def _dotted(node: ast.AST) -> list[str]:
    parts: list[str] = []
    while isinstance(node, ast.Attribute):
        parts.append(node.attr)
        node = node.value
    return [node.id, *reversed(parts)] if isinstance(node, ast.Name) and parts else []


def test_libraries_import_only_names_of_the_originals() -> None:
    known = set(NAMES.read_text(encoding="utf-8").split())
    files = [file for file in sorted(FOLDER.rglob("*.py")) if file.relative_to(FOLDER).parts[0] not in OWN]
    strange = {f"{file.relative_to(FOLDER)}: {name}" for file in files for name in taken(file) if name not in known}
    assert strange == set()


def test_load_manifest_works_with_the_original_source_of_rosmsg(tmp_path: Path) -> None:
    source = tmp_path / "rosmsg"
    source.mkdir()
    (source / "__init__.py").write_text("MODE_MSG = '.msg'\n", encoding="utf-8")  # the original has no `packages`
    node = """
        import roslib
        roslib.load_manifest("std_msgs")
        try:
            roslib.load_manifest("nowhere")
        except Exception as error:
            print(type(error).__name__, str(error).splitlines()[0])
        import rosmsg
        print("loaded", sorted(name for name in vars(rosmsg) if name.isupper()))
    """
    assert run_nodes(tmp_path, {"N": node}).printed["N"] == [
        "ResourceNotFound nowhere",
        "loaded ['MODE_MSG']",
    ]

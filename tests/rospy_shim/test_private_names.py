"""Classes from which users derive have no private name that ROS's class does not have: a subclass may use any other.

`python3 -m dev.record.class_names` has recorded ROS's names.
"""

from __future__ import annotations

import ast
import json
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from dev.record.class_names import CLASSES, private_names

ROOT = Path(__file__).parents[2]
REAL: dict[str, list[str]] = json.loads((ROOT / "tests/data/ros_class_names.json").read_text(encoding="utf-8"))
FOLDERS = {"rospy": ("rospy_shim/client", "rospy_shim/types/genpy")}
LIBRARIES = {"tf2_ros": ("tf2_ros", "tf2_py"), "rosbag": ("rosbag",)}
OF_GENPY = ("_full_text", "_has_header", "_md5sum", "_slot_types", "_type")
"""Names that genpy gives to each message class."""


@cache
def classes_of(folders: tuple[str, ...]) -> dict[str, list[ast.ClassDef]]:
    """Return the classes in some folders by name."""
    found: dict[str, list[ast.ClassDef]] = {}
    for file in sorted(each for folder in folders for each in (ROOT / folder).glob("*.py")):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ClassDef):
                found.setdefault(node.name, []).append(node)
    return found


def lineage(
    name: str, known: dict[str, list[ast.ClassDef]], seen: frozenset[str] = frozenset()
) -> Iterator[ast.ClassDef]:
    """Yield the classes of a name, and their bases."""
    for node in known.get(name, []) if name not in seen else []:
        yield node
        for base in node.bases:
            last = base.attr if isinstance(base, ast.Attribute) else getattr(base, "id", "")
            yield from lineage(last, known, seen | {name})


def test_all_classes_were_recorded() -> None:
    assert {f"{module}.{name}" for module, names in CLASSES.items() for name in names} == REAL.keys()


@pytest.mark.parametrize("name", REAL)
def test_class_has_no_private_name_that_ros_lacks(name: str) -> None:
    module, _, kind = name.partition(".")
    libraries = tuple(f"ros_libraries/{each}" for each in LIBRARIES.get(module, (module,)))
    known = classes_of(FOLDERS.get(module, libraries))
    nodes = list(lineage(kind, known))
    assert nodes
    assert {each for node in nodes for each in private_names(node)} - {*REAL[name], *OF_GENPY} == set()

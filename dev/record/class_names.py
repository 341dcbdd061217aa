"""`python3 -m dev.record.class_names FILE`: records the private names of ROS's classes from which users derive.

A class of a user must not meet a private name of cfepy that ROS's class does not have. The program runs in the Python
that has ROS, reads the sources of ROS's classes, and writes the names as JSON.
"""

from __future__ import annotations

import argparse
import ast
import importlib
import inspect
import json
import textwrap
from collections.abc import Iterator
from pathlib import Path

CLASSES = {
    "rospy": ("Publisher", "Subscriber", "Service", "ServiceProxy", "Rate", "AnyMsg", "Message", "Time", "Duration"),
    "tf2_ros": (
        *("Buffer", "BufferClient", "BufferInterface", "TransformListener"),
        *("TransformBroadcaster", "StaticTransformBroadcaster"),
    ),
    "actionlib": ("ActionClient", "ActionServer", "SimpleActionClient", "SimpleActionServer"),
    "message_filters": ("SimpleFilter", "Subscriber", "Cache", "TimeSynchronizer", "ApproximateTimeSynchronizer"),
    "rosbag": ("Bag",),
}
"""The classes from which users derive, by module."""


def private_names(node: ast.ClassDef) -> Iterator[str]:
    """Yield the names with one underscore in front that a class defines, or that it sets in its objects."""
    for each in ast.walk(node):
        if isinstance(each, ast.Attribute) and isinstance(each.value, ast.Name) and each.value.id in ("self", "cls"):
            names = [each.attr]
        elif isinstance(each, ast.FunctionDef) and each in node.body:
            names = [each.name]
        elif isinstance(each, ast.Assign | ast.AnnAssign) and each in node.body:
            targets = each.targets if isinstance(each, ast.Assign) else [each.target]
            names = [target.id for target in targets if isinstance(target, ast.Name)]
        else:
            continue
        yield from (name for name in names if name.startswith("_") and not name.startswith("__"))


def _names_of(kind: type) -> set[str]:
    """Return the private names of a class and of its bases that have sources."""
    found = {name for name in dir(kind) if name.startswith("_") and not name.startswith("__")}
    for base in kind.__mro__:
        try:
            source = textwrap.dedent(inspect.getsource(base))
        except (OSError, TypeError):
            continue
        [node] = [each for each in ast.parse(source).body if isinstance(each, ast.ClassDef)]
        found.update(private_names(node))
    return found


def main() -> None:
    """Record."""
    parser = argparse.ArgumentParser(prog="python -m dev.record.class_names", description=__doc__.partition("\n")[0])
    parser.add_argument("file", metavar="FILE", type=Path, help="the file to write, tests/data/ros_class_names.json")
    file: Path = parser.parse_args().file
    found = {
        f"{module}.{name}": sorted(_names_of(getattr(importlib.import_module(module), name)))
        for module, names in CLASSES.items()
        for name in names
    }
    file.write_text(f"{json.dumps(found, indent=1)}\n", encoding="utf-8")


if __name__ == "__main__":
    main()

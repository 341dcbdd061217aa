"""ROS parameters in YAML: those in a mission file, and the files that it names, as for `rosparam load`.

Later values override earlier ones, name by name. The values in the mission file itself come last. A value that ROS
cannot carry (null, a date, an integer of more than 32 bits) is an error with file and line.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from cfepy.reading.marked_yaml import Marked, load
from cfepy.status import UsageError, together

FILE_FIELDS = ("file", "namespace")
_INT_MIN, _INT_MAX = -(1 << 31), (1 << 31) - 1


def read_files(section: Marked) -> dict[str, Any]:
    """Return the section `params_from`: the parameters in the files that it names, as a tree; a namespace is a
    dictionary.

    Args:
        section: a file, or a list of files, each as a path relative to the mission file or as `{file: PATH, namespace:
            NAME}`.

    Raises:
        UsageError: if a file cannot be read, is not a mapping, or has a value that ROS cannot carry.
    """
    tree: dict[str, Any] = {}
    for path, namespace in _files(section):
        tree = merged(tree, _below(namespace, read_tree(load(path))))
    return tree


def read_tree(section: Marked) -> dict[str, Any]:
    """Return a mapping of names to values, checked.

    Raises:
        UsageError: if it is not a mapping, or has a value that ROS cannot carry.
    """
    entries = section.mapping()
    try:
        return {name: _value(entry) for name, entry in entries.items()}
    except UsageError:
        raise together(list(_errors_in(section))) from None


def merged(tree: Mapping[str, Any], over: Mapping[str, Any]) -> dict[str, Any]:
    """Return two trees merged: namespaces are joined, and values of `over` win."""
    found = dict(tree)
    for name, value in over.items():
        below = found.get(name)
        found[name] = merged(below, value) if isinstance(below, dict) and isinstance(value, dict) else value
    return found


def _files(section: Marked) -> Iterator[tuple[Path, str]]:
    """Yield (path, namespace) of each file."""
    entries = [section] if isinstance(section.value, str) else section.items()
    for entry in entries:
        said = {"file": entry} if isinstance(entry.value, str) else entry.mapping(FILE_FIELDS)
        if "file" not in said:
            raise entry.fail("missing file; write `params_from: [robot.yaml]` or {file: robot.yaml, namespace: arm}")
        path = entry.file.parent / said["file"].text()
        if not os.path.isfile(path):
            raise said["file"].fail(f"file not found: {path}; give a path relative to the folder of {entry.file.name}")
        yield path, said["namespace"].text() if "namespace" in said else ""


def _below(namespace: str, tree: dict[str, Any]) -> dict[str, Any]:
    for part in reversed([part for part in namespace.split("/") if part]):
        tree = {part: tree}
    return tree


def _value(entry: Marked) -> Any:
    value = entry.value
    if isinstance(value, dict):
        return {name: _value(inner) for name, inner in value.items()}
    if isinstance(value, list):
        return [_value(inner) for inner in value]
    fault = _fault(value)
    if fault is not None:
        raise entry.fail(fault)
    return value


def _errors_in(entry: Marked) -> Iterator[UsageError]:
    """Yield the errors about all values inside an entry that ROS cannot carry."""
    value = entry.value
    if isinstance(value, dict | list):
        for inner in value.values() if isinstance(value, dict) else value:
            yield from _errors_in(inner)
        return
    fault = _fault(value)
    if fault is not None:
        yield entry.fail(fault)


def checked(value: Any) -> Any:
    """Return a plain value if ROS can carry it.

    Raises:
        UsageError: if it, or a value inside it, cannot be carried.
    """
    inner = value.values() if isinstance(value, dict) else value if isinstance(value, list) else None
    for each in inner if inner is not None else ():
        checked(each)
    fault = _fault(value) if inner is None else None
    if fault is None and isinstance(value, dict) and not all(isinstance(name, str) for name in value):
        fault = f"has names that are not text: {value}"
    if fault is not None:
        raise UsageError(fault, field="value")
    return value


def _fault(value: Any) -> str | None:
    """Return why ROS cannot carry a value that is not a container, or None."""
    if isinstance(value, bool | float | str | bytes):
        return None
    if not isinstance(value, int):
        kind = type(value).__name__.removesuffix("time")  # a datetime is a date for the user
        what = "nothing" if value is None else f"a {kind}"
        return f"must be a value that ROS parameters can have, not {what}; put text in quotes"
    if _INT_MIN <= value <= _INT_MAX:
        return None
    return f"must be an integer of 32 bits or a number with a decimal point, not {value}"

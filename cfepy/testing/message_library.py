"""The message types that a test can use, and messages made of plain data. rospy_shim is loaded by name."""

from __future__ import annotations

import importlib
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from cfepy.status import UsageError

SECONDS = {"time": (0, 2**32 - 1), "duration": (-(2**31), 2**31 - 1)}
"""The range of a ROS time's or duration's whole seconds."""


def array_of(field_type: str) -> tuple[str, int | None]:
    """The type of an array's items, and its length if it is fixed."""
    base, _, length = field_type[:-1].partition("[")
    return base, int(length) if length else None


def build(library: Any, field_type: str, value: Any) -> Any:
    """A message, or the value of a field, from plain data; what is a message already stays as it is.

    Args:
        library: knows the type.
        field_type: the type.
        value: as `MessageValues` makes it.
    """
    if field_type.endswith("]") and not isinstance(value, bytes):
        return [build(library, array_of(field_type)[0], item) for item in value]
    if not isinstance(value, Mapping):
        return value
    if field_type in SECONDS:
        genpy = importlib.import_module("rospy_shim.genpy")
        return getattr(genpy, field_type.capitalize())(value["secs"], value["nsecs"])
    kind = library.message_class(field_type)
    slots = dict(zip(kind.__slots__, kind._slot_types, strict=True))
    return kind(**{name: build(library, slots[name], item) for name, item in value.items()})


def library_near(place: str | os.PathLike[str] | None = None) -> Any:
    """The message library of a program: ROS's common packages, those near it, those on ROS_PACKAGE_PATH.

    Args:
        place: a file or folder of the package; None for the working directory.
    """
    msgs = importlib.import_module("rospy_shim.msgs")
    path = Path.cwd() if place is None else Path(place).absolute()
    packages = msgs.Packages(path / "any" if path.is_dir() else path, os.environ)
    return msgs.Library([msgs.OnDisk(packages)], base=msgs.shipped())


def library_of_class(kind: type) -> Any:
    """The library that knows a class and what is nested in it.

    Raises:
        UsageError: it is no message class.
    """
    full_text = getattr(kind, "_full_text", None)
    if full_text is None:
        raise UsageError(f"{kind!r} is no ROS message class; give one, or a type such as 'std_msgs/String'")
    return importlib.import_module("rospy_shim.msgs").library_of(kind._type, full_text)  # type: ignore[attr-defined]

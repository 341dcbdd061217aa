"""The message types that a test can use, and messages made of plain data."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cfepy.status import UsageError

if TYPE_CHECKING:
    from rospy_shim.types.msgs import Library, MessageClass

SECONDS = {"time": (0, 2**32 - 1), "duration": (-(2**31), 2**31 - 1)}
"""The range of a ROS time's or duration's whole seconds."""


def array_of(field_type: str) -> tuple[str, int | None]:
    """Return the type of an array's items, and its length if it is fixed."""
    base, _, length = field_type[:-1].partition("[")
    return base, int(length) if length else None


def build(library: Library, field_type: str, value: Any) -> Any:
    """Return a message, or the value of a field, from plain data; a message stays unchanged.

    Args:
        library: has the type.
        field_type: the type.
        value: a value from `MessageValues`.
    """
    if field_type.endswith("]") and not isinstance(value, bytes):
        return [build(library, array_of(field_type)[0], item) for item in value]
    if not isinstance(value, Mapping):
        return value
    if field_type in SECONDS:
        from rospy_shim.types.genpy import Duration, Time

        return (Time if field_type == "time" else Duration)(value["secs"], value["nsecs"])
    kind = library.message_class(field_type)
    slots = dict(zip(kind.__slots__, kind._slot_types, strict=True))
    return kind(**{name: build(library, slots[name], item) for name, item in value.items()})


def library_near(place: str | os.PathLike[str] | None = None) -> Library:
    """Return the message library of a program: ROS's common packages, packages near the program, and those on
    ROS_PACKAGE_PATH.

    Args:
        place: a file or folder of the package; None for the working directory.
    """
    from rospy_shim.types.msgs import Library, OnDisk, Packages, shipped

    path = Path.cwd() if place is None else Path(place).absolute()
    packages = Packages(path / "any" if os.path.isdir(path) else path, os.environ)
    return Library([OnDisk(packages)], base=shipped())


def library_of_class(kind: MessageClass) -> Library:
    """Return a library with a message class and its nested types.

    Raises:
        UsageError: if it is not a message class.
    """
    from rospy_shim.types.msgs import library_of

    full_text = getattr(kind, "_full_text", None)
    if full_text is None:
        raise UsageError(f"not a ROS message class: {kind!r}; give a class, or a type such as 'std_msgs/String'")
    return library_of(kind._type, full_text)

"""Messages as YAML, as tools show them for filling in (`rosmsg` prototypes)."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import genpy
import roslib.message

MAX_DEFAULT_NON_FLOW_ITEMS = 4
_NUMBERS = [
    "byte",
    "char",
    "int8",
    "int16",
    "int32",
    "int64",
    "uint8",
    "uint16",
    "uint32",
    "uint64",
    "float32",
    "float64",
]
_PLAIN: dict[str, Any] = {**dict.fromkeys(_NUMBERS, 0), "string": "", "bool": False}
_SHORT = {"time": "std_msgs/Time", "duration": "std_msgs/Duration", "Header": "std_msgs/Header"}


def get_array_type_instance(field_type: str, default_package: str | None = None) -> Any:
    """Return a value of the type of an array's elements, or None if the type is unknown.

    Args:
        field_type: the array's type.
        default_package: package of a message type without a package.
    """
    base = field_type.strip().partition("[")[0]
    if base in _PLAIN:
        return _PLAIN[base]
    name = _SHORT.get(base, base)
    if "/" not in name:
        if default_package is None:
            return None
        name = f"{default_package}/{name}"
    found = roslib.message.get_message_class(name)
    return found() if found else None


def create_names_filter(names: Iterable[str]) -> Callable[[Any], list[str]]:
    """Return a filter of fields that leaves some out."""
    left_out = list(names)
    return lambda message: [field for field in message.__slots__ if field not in left_out]


def get_yaml_for_msg(
    msg: Any,
    prefix: str = "",
    time_offset: Any = None,
    current_time: Any = None,
    field_filter: Callable[[Any], Iterable[str]] | None = None,
    flow_style_: bool | None = None,
    fill_arrays_: bool = False,
) -> str:
    """Return a message as YAML.

    Args:
        msg: the message.
        prefix: put before each line.
        time_offset: taken off all times.
        current_time: accepted.
        field_filter: which fields count.
        flow_style_: True for brackets, False for lines.
        fill_arrays_: put an element into empty arrays.
    """
    import yaml

    plain = _plain(msg, time_offset, field_filter, fill_arrays_)
    text = yaml.safe_dump(plain, default_flow_style=bool(flow_style_), default_style="", sort_keys=False).rstrip("\n")
    return "\n".join(prefix + line for line in text.splitlines()) if prefix else text


def _plain(value: Any, offset: Any, field_filter: Callable[[Any], Iterable[str]] | None, fill: bool) -> Any:
    if isinstance(value, genpy.TVal):
        moved = value - offset if offset is not None and isinstance(value, genpy.Time) else value
        return {"secs": moved.secs, "nsecs": moved.nsecs}
    if isinstance(value, (list, tuple)):
        return [_plain(each, offset, field_filter, fill) for each in value]
    if not isinstance(value, genpy.Message):
        return value
    kinds = dict(zip(value.__slots__, value._slot_types, strict=True))
    found = {}
    for field in value.__slots__ if field_filter is None else field_filter(value):
        held = getattr(value, field)
        if fill and held == [] and (instance := get_array_type_instance(kinds[field])) is not None:
            held = [instance]
        found[field] = _plain(held, offset, field_filter, fill)
    return found

"""Fields of messages by path, and messages as lines of comma separated values (`rostopic echo -p`)."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable
from typing import Any

import genpy
import rospy

Filter = Callable[[Any], Iterable[str]]
"""The names of those fields of a message that count."""


def msgevalgen(pattern: str) -> Callable[[Any], Any] | None:
    """Return a function that returns a field of a message, or None if the path is empty or has a mistake.

    Args:
        pattern: such as `/pose/position/x`, `/points[0]/x`, `/points[1:3]/x`.

    If a message has no such field, the function prints the error on stderr and returns None.
    """
    steps: list[tuple[str, Any]] = []
    for part in filter(None, pattern.split("/")):
        name, bracket, index = part.partition("[")
        if bracket and not index.endswith("]"):
            print(f"missing closing ']' in slice spec '{part}'", file=sys.stderr)
            return None
        try:
            steps.append((name, _index(index[:-1]) if bracket else None))
        except ValueError as error:
            print(f"field '{name}' has invalid slice argument '{index[:-1]}': {error}", file=sys.stderr)
            return None
    return (lambda message: _field(message, steps, pattern)) if steps else None


def _index(text: str) -> int | slice:
    parts = text.split(":")
    if len(parts) > 3:
        raise ValueError("too many slice arguments")
    if len(parts) == 1:
        return int(text)
    return slice(*(int(part) if part else None for part in parts))


def _field(value: Any, steps: list[tuple[str, Any]], pattern: str) -> Any:
    for number, (name, index) in enumerate(steps, 1):
        try:
            value = getattr(value, name)
            if index is not None:
                value = value[index]
        except AttributeError:
            print(f"no field named {name} in {pattern}", file=sys.stderr)
            return None
        except IndexError as error:
            print(f"{error}: {pattern}", file=sys.stderr)
            return None
        if isinstance(index, slice) and isinstance(value, list):
            return [_field(each, steps[number:], pattern) for each in value]
    return value


# -- comma separated values ------------------------------------------------------------------------------------------


def _str_plot_fields(val: Any, f: str, field_filter: Filter | None) -> str:
    """Return the title line: names of all plain values in a message, `f` before each."""
    return "time," + ",".join(name for name, _ in _plain(val, f, field_filter))


def _str_plot(
    val: Any,
    time_offset: Any = None,
    current_time: Any = None,
    field_filter: Filter | None = None,
    type_information: str | None = None,
    fixed_numeric_width: int | None = None,
    value_transform: Any = None,
) -> str:
    """Return a line: the time in ns, then all plain values in a message.

    Args:
        val: the message.
        time_offset: subtracted from all times.
        current_time: the line's time; None for the header's, or now.
        field_filter: which fields count.
        type_information: accepted.
        fixed_numeric_width: accepted.
        value_transform: accepted.
    """
    if current_time is None:
        current_time = val.header.stamp if getattr(val, "_has_header", False) else rospy.get_rostime()
    start = time_offset.to_nsec() if time_offset is not None else 0
    values = [_text(value, time_offset) for _, value in _plain(val, "", field_filter)]
    return f"{current_time.to_nsec() - start},{','.join(values)}"


def _text(value: Any, time_offset: Any) -> str:
    if isinstance(value, bool):
        return "1" if value else "0"
    if isinstance(value, genpy.Time) and time_offset is not None:
        return str(value - time_offset)
    return str(value)


def _plain(value: Any, name: str, field_filter: Filter | None) -> Iterable[tuple[str, Any]]:
    """Return the plain values in a message, with their names."""
    if hasattr(value, "_slot_types") and not isinstance(value, genpy.TVal):
        types = dict(zip(value.__slots__, value._slot_types, strict=False))
        for field in value.__slots__ if field_filter is None else field_filter(value):
            inner = getattr(value, field)
            if types.get(field, "").startswith("uint8[") and isinstance(inner, str):
                inner = inner.encode("latin-1")  # a character for each byte
            yield from _plain(inner, f"{name}.{field}", field_filter)
    elif isinstance(value, (list, tuple, bytes)):
        for index, each in enumerate(value):
            yield from _plain(each, f"{name}{index}", field_filter)
    else:
        yield name, value

"""A ROS message from JSON, as published by Foxglove's panels: {"linear": {"x": 1}}; missing fields are zero."""

from __future__ import annotations

import base64
import binascii
from collections.abc import Callable, Mapping
from typing import Any

from cfepy.reading.suggestions import expected
from rospy_shim.types.genpy import Duration, Time

_BYTES = ("uint8", "char")
_SECONDS, _NANOSECONDS = ("sec", "secs"), ("nsec", "nsecs", "nanosec")
_TEXT, _TRUTH = "string", "bool"
_REAL = ("float32", "float64")


def message_from_json(class_of: Callable[[str], Any], kind: str, value: Any) -> Any:
    """Return a message.

    Args:
        class_of: class of a message type by its full name.
        kind: the type, such as "geometry_msgs/Twist".
        value: the JSON value: objects are messages and times, base64 may be an array of bytes.

    Raises:
        ValueError: if it does not fit the type; the text has the path of the field.
    """
    return _message(class_of, kind, value, kind)


def _message(class_of: Callable[[str], Any], kind: str, value: Any, path: str) -> Any:
    if not isinstance(value, Mapping):
        raise ValueError(f"{path}: {value!r} is not an object")
    message = class_of(kind)()
    types = dict(zip(message.__slots__, message._slot_types, strict=True))
    for name, each in value.items():
        if name not in types:
            raise ValueError(f"{path}: unknown field {name!r}; {expected(name, types)}")
        setattr(message, name, _value(class_of, types[name], each, f"{path}.{name}"))
    return message


def _value(class_of: Callable[[str], Any], kind: str, value: Any, path: str) -> Any:
    if kind.endswith("]"):
        base, _, length = kind[:-1].partition("[")
        return _array(class_of, base, int(length) if length else None, value, path)
    if "/" in kind:
        return _message(class_of, kind, value, path)
    if kind in ("time", "duration"):
        return _time(Time if kind == "time" else Duration, value, path)
    if kind == _TEXT:
        if not isinstance(value, str):
            raise ValueError(f"{path}: {value!r} is not a text")
        return value
    return _number(kind, value, path)


def _number(kind: str, value: Any, path: str) -> Any:
    if kind in _REAL and value is None:
        return float("nan")  # JSON has no other representation
    if isinstance(value, bool) and kind == _TRUTH:
        return value
    if not isinstance(value, int | float):
        raise ValueError(f"{path}: {value!r} is not a valid {kind}")
    if kind in _REAL:
        return float(value)
    if isinstance(value, float) and not value.is_integer():
        raise ValueError(f"{path}: {value!r} is not a valid {kind}")
    return int(value)


def _array(class_of: Callable[[str], Any], base: str, length: int | None, value: Any, path: str) -> Any:
    if base in _BYTES and isinstance(value, str):
        try:
            value = base64.b64decode(value, validate=True)
        except binascii.Error as error:
            raise ValueError(f"{path}: {error}") from None
    elif not isinstance(value, list):
        raise ValueError(f"{path}: {value!r} is not an array")
    if length is not None and len(value) != length:
        raise ValueError(f"{path} must have {length} items, not {len(value)}")
    if isinstance(value, bytes):
        return value
    items = [_value(class_of, base, each, f"{path}[{number}]") for number, each in enumerate(value)]
    if base not in _BYTES:
        return items
    if not all(0 <= each < 256 for each in items):
        raise ValueError(f"{path}: an item is not a valid {base}")
    return bytes(items)


def _time(kind: type[Time] | type[Duration], value: Any, path: str) -> Any:
    if not isinstance(value, Mapping) or set(value) - {*_SECONDS, *_NANOSECONDS}:
        raise ValueError(f"{path}: {value!r} is not like {{'sec': 1, 'nsec': 0}}")
    parts = [next((value[each] for each in names if each in value), 0) for names in (_SECONDS, _NANOSECONDS)]
    if not all(isinstance(each, int) for each in parts):
        raise ValueError(f"{path}: {value!r} is not like {{'sec': 1, 'nsec': 0}}")
    return kind(*parts)

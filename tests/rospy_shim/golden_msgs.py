"""Messages recorded from real genpy, and plain values into messages, for the tests of the codec."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

from rospy_shim import genpy
from rospy_shim.msgs import Library, from_full_text, shipped

_FILE = Path(__file__).parent.parent / "data" / "golden_msgs.json"
_TIMES = {"time": genpy.Time, "duration": genpy.Duration}


@cache
def recorded() -> list[dict[str, Any]]:
    """All recorded types with their cases."""
    messages: list[dict[str, Any]] = json.loads(_FILE.read_text(encoding="utf-8"))["messages"]
    return messages


@cache
def library_of(full_name: str) -> Library:
    """The library that has a recorded type: the shipped one, or one made of its recorded full text."""
    if shipped().has(full_name):
        return shipped()
    return from_full_text(full_name, next(each["full_text"] for each in recorded() if each["type"] == full_name))


def build(library: Library, field_type: str, value: Any) -> Any:
    """A field's value, or a whole message, from its plain form (dicts, lists, hexadecimal for uint8[])."""
    if isinstance(value, dict) and "__bytes_hex__" in value:
        return bytes.fromhex(value["__bytes_hex__"])
    if field_type.endswith("]"):
        base = field_type[: field_type.index("[")]
        return [build(library, base, item) for item in value]
    if field_type in _TIMES:
        return _TIMES[field_type](value["secs"], value["nsecs"])
    if "/" not in field_type:
        return value
    cls = library.message_class(field_type)
    kinds = zip(cls.__slots__, cls._slot_types, strict=True)
    return cls(**{name: build(library, kind, value[name]) for name, kind in kinds})

"""Messages recorded from real genpy, and plain values into messages, for the tests of the codec."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

from rospy_shim.types import genpy
from rospy_shim.types.msgs import Library

_DATA = Path(__file__).parent.parent / "data"
_FILE = _DATA / "golden_msgs.json"
_MD5SUMS = _DATA / "msgs_md5sums.txt"
_TIMES = {"time": genpy.Time, "duration": genpy.Duration}


@cache
def recorded() -> dict[str, list[dict[str, Any]]]:
    """Return all recorded types with their cases: "messages", with the requests and responses, and "services"."""
    found: dict[str, list[dict[str, Any]]] = json.loads(_FILE.read_text(encoding="utf-8"))
    parts = [service[part] for service in found["services"] for part in ("request", "response")]
    return {"messages": found["messages"] + parts, "services": found["services"]}


def md5sums(kind: str) -> dict[str, str]:
    """Return genmsg's md5sum for each shipped "msg" or "srv"."""
    lines = (line.split() for line in _MD5SUMS.read_text(encoding="utf-8").splitlines())
    return {words[1]: words[2] for words in lines if words[0] == kind}


def build(library: Library, field_type: str, value: Any) -> Any:
    """Return a field's value, or a whole message, from its plain form (dicts, lists, hexadecimal for uint8[])."""
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

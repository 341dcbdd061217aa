"""Messages of real genpy from plain values, and their bytes, for the scripts beside this file that its Python runs."""

from __future__ import annotations

import importlib
import io
from typing import Any

genpy = importlib.import_module("genpy")

TIMES = {"time": genpy.Time, "duration": genpy.Duration}


def build(classes: dict[str, Any], field_type: str, value: Any) -> Any:
    if isinstance(value, dict) and "__bytes_hex__" in value:
        return bytes.fromhex(value["__bytes_hex__"])
    if field_type.endswith("]"):
        return [build(classes, field_type[: field_type.index("[")], item) for item in value]
    if field_type in TIMES:
        return TIMES[field_type](value["secs"], value["nsecs"])
    if "/" not in field_type:
        return value
    message = classes[field_type]()
    for name, kind in zip(message.__slots__, message._slot_types):  # noqa: B905
        setattr(message, name, build(classes, kind, value[name]))
    return message


def encoded(message: Any) -> str:
    buff = io.BytesIO()
    message.serialize(buff)
    return buff.getvalue().hex()

"""Run by a Python that has real ROS's genpy: encodes and decodes what the test sends, one JSON object per line.

It uses the public API of genpy only.
"""

from __future__ import annotations

import importlib
import io
import json
import sys
from typing import Any

genpy = importlib.import_module("genpy")
generate_dynamic = importlib.import_module("genpy.dynamic").generate_dynamic

_classes: dict[str, Any] = {}
_TIMES = {"time": genpy.Time, "duration": genpy.Duration}


def classes_of(request: dict[str, Any]) -> dict[str, Any]:
    if request["type"] not in _classes:
        _classes[request["type"]] = generate_dynamic(request["type"], request["full_text"])
    made: dict[str, Any] = _classes[request["type"]]
    return made


def build(classes: dict[str, Any], field_type: str, value: Any) -> Any:
    if isinstance(value, dict) and "__bytes_hex__" in value:
        return bytes.fromhex(value["__bytes_hex__"])
    if field_type.endswith("]"):
        return [build(classes, field_type[: field_type.index("[")], item) for item in value]
    if field_type in _TIMES:
        return _TIMES[field_type](value["secs"], value["nsecs"])
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


def answer(request: dict[str, Any]) -> dict[str, Any]:
    classes = classes_of(request)
    cls = classes[request["type"]]
    if "value" in request:
        message = build(classes, request["type"], request["value"])
        return {"hex": encoded(message), "text": str(message), "md5sum": cls._md5sum}
    message = cls()
    message.deserialize(bytes.fromhex(request["hex"]))
    return {"hex": encoded(message)}


for line in sys.stdin:
    try:
        result = answer(json.loads(line))
    except Exception as error:
        result = {"error": type(error).__name__}
    print(json.dumps(result), flush=True)

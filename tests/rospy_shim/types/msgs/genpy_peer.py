"""Run by a Python that has real ROS's genpy: encodes and decodes the test's requests, one JSON object per line.

It uses the public API of genpy only.
"""

from __future__ import annotations

import importlib
import json
import sys
from typing import Any

from genpy_messages import build, encoded  # beside this script

generate_dynamic = importlib.import_module("genpy.dynamic").generate_dynamic

_classes: dict[str, Any] = {}


def classes_of(request: dict[str, Any]) -> dict[str, Any]:
    if request["type"] not in _classes:
        _classes[request["type"]] = generate_dynamic(request["type"], request["full_text"])
    made: dict[str, Any] = _classes[request["type"]]
    return made


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

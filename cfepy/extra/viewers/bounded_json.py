"""JSON of clients, within bounds: a text of some megabytes can stand for gigabytes of lists, and is refused unread."""

from __future__ import annotations

import json
from typing import Any

from cfepy.reading.input_limits import JSON_BRACKETS, JSON_VALUES


def loads(text: str | bytes) -> Any:
    """The value that a text stands for.

    Raises:
        ValueError: it is not JSON, or has too many values, or too many inside each other.
    """
    found = text if isinstance(text, bytes) else text.encode(errors="replace")
    if found.count(b"[") + found.count(b"{") > JSON_BRACKETS:
        raise ValueError(f"more than {JSON_BRACKETS:,} lists and objects")
    if found.count(b",") > JSON_VALUES:
        raise ValueError(f"more than {JSON_VALUES:,} values")
    try:
        return json.loads(text)
    except RecursionError:
        raise ValueError("lists and objects are nested too deeply") from None

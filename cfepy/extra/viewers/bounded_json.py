"""JSON of clients, with limits: a text of some megabytes can expand to gigabytes of lists, and is refused unparsed."""

from __future__ import annotations

import json
from typing import Any

from cfepy.reading.input_limits import JSON_BRACKETS, JSON_VALUES


def loads(text: str | bytes) -> Any:
    """Parse a text.

    Returns:
        Its value.

    Raises:
        ValueError: it is not JSON, or has too many or too deeply nested values.
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

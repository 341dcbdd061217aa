"""Generated values of ROS types as plain data that JSON can carry; `build` of `golden_msgs` makes messages of them."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

from hypothesis import strategies as st

from cfepy.testing.strategies import MessageValues
from rospy_shim.types.msgs import shipped


@cache
def plain(field_type: str) -> st.SearchStrategy[Any]:
    """Plain values (see `build`) of a ROS type."""
    return _values().of(field_type).map(for_json)


@cache
def _values() -> MessageValues:
    return MessageValues(shipped())


def for_json(value: Any) -> Any:
    """Return bytes as hexadecimal digits. JSON has only one NaN, so payloads would be lost on the way to genpy."""
    if isinstance(value, dict):
        return {name: for_json(item) for name, item in value.items()}
    if isinstance(value, list):
        return [for_json(item) for item in value]
    if isinstance(value, bytes):
        return {"__bytes_hex__": value.hex()}
    return math.nan if isinstance(value, float) and math.isnan(value) else value

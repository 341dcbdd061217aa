"""Generated values of ROS types as plain data that JSON can carry; `build` of `golden_msgs` makes messages of them."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

from hypothesis import strategies as st

from rospy_shim.msgs import message_class

_BITS = {"int8": 8, "int16": 16, "int32": 32, "int64": 64, "byte": 8}
_SECONDS = {"time": (0, 2**32 - 1), "duration": (-(2**31), 2**31 - 1)}


@cache
def weight(field_type: str) -> int:
    """Roughly how many numbers and texts a value of a type has."""
    if field_type.endswith("]"):
        base, _, length = field_type[:-1].partition("[")
        return 1 if base in ("uint8", "char") else int(length or most(base)) * weight(base)
    return sum(map(weight, message_class(field_type)._slot_types)) if "/" in field_type else 1


def most(base: str) -> int:
    """Items of an array without a length: few of a type that is big itself, or a planning scene would never end."""
    return 4 if weight(base) <= 16 else 2 if weight(base) <= 64 else 1


@cache
def plain(field_type: str) -> st.SearchStrategy[Any]:
    """Plain values (see `build`) of a ROS type."""
    if field_type.endswith("]"):
        base, _, length = field_type[:-1].partition("[")
        exactly = {"min_size": int(length), "max_size": int(length)} if length else None
        size: dict[str, Any] = exactly or {"max_size": most(base)}
        if base in ("uint8", "char"):
            return st.binary(**size).map(lambda octets: {"__bytes_hex__": octets.hex()})
        return st.lists(plain(base), **size)
    if field_type in _SECONDS:
        low, high = _SECONDS[field_type]
        return st.fixed_dictionaries({"secs": st.integers(low, high), "nsecs": st.integers(0, 999_999_999)})
    if "/" in field_type:
        cls = message_class(field_type)
        kinds = zip(cls.__slots__, cls._slot_types, strict=True)
        return st.fixed_dictionaries({name: plain(kind) for name, kind in kinds})
    return _primitive(field_type)


def _primitive(field_type: str) -> st.SearchStrategy[Any]:
    if field_type == "bool":
        return st.booleans()
    if field_type == "string":
        return st.text(st.characters(exclude_categories=["Cs"]), max_size=12)
    if field_type.startswith("float"):
        # JSON carries one NaN only, so the payloads of others would be lost on the way to genpy.
        numbers = st.floats(width=32 if field_type == "float32" else 64)
        return numbers.map(lambda number: math.nan if math.isnan(number) else number)
    if field_type in _BITS:
        bits = _BITS[field_type]
        return st.integers(-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
    return st.integers(0, 2 ** (8 if field_type == "char" else int(field_type[4:])) - 1)

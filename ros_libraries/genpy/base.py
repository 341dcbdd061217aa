"""The types that have a code of Python's `struct`."""

from __future__ import annotations

SIMPLE_TYPES_DICT = {
    "int8": "b", "uint8": "B", "bool": "B", "int16": "h", "uint16": "H", "int32": "i", "uint32": "I", "int64": "q",
    "uint64": "Q", "float32": "f", "float64": "d", "char": "B", "byte": "b",
}  # fmt: skip
SIMPLE_TYPES = list(SIMPLE_TYPES_DICT)


def is_simple(type_: str) -> bool:
    """Return whether a type has a code of `struct`."""
    return type_ in SIMPLE_TYPES_DICT

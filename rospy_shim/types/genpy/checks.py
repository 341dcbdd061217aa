"""The check of a field that cannot be serialized: `check_type`, as genpy.message runs it after packing has failed.

The rules are genpy's, gaps included: a fixed array's length is not checked, and a str is accepted as uint8[]. Never on
the hot path.
"""

from __future__ import annotations

from typing import Any

from rospy_shim.types.genpy.errors import SerializationError
from rospy_shim.types.genpy.rostime import Duration, Time

_BITS = {
    "byte": 8, "int8": 8, "int16": 16, "int32": 32, "int64": 64,
    "char": 8, "uint8": 8, "uint16": 16, "uint32": 32, "uint64": 64,
}  # fmt: skip
_HEADERS = ("Header", "std_msgs/Header", "roslib/Header")  # roslib's is an older name
_NUMPY_FLOATS = frozenset(
    ("float32", "float64", "int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64")
)
_SIGNED = frozenset(("byte", "int8", "int16", "int32", "int64"))


def check_type(field_name: str, field_type: str, field_val: Any) -> None:
    """Check that a field's value fits its ROS type.

    Args:
        field_name: name used in the error's text.
        field_type: resolved ROS type, e.g. "float64[]" or "geometry_msgs/Point".
        field_val: the value.

    Raises:
        SerializationError: it does not fit, with genpy's text.
    """
    if field_type.endswith("]"):
        _check_array(field_name, field_type, field_val)
    elif field_type in _BITS:
        _check_integer(field_name, field_type, field_val)
    elif field_type == "bool":
        _require(field_val in (True, False), f"field {field_name} is not a bool")
    elif field_type in ("float32", "float64"):
        _require(_is_float(field_val), f"field {field_name} must be float type")
    elif field_type == "string":
        _check_string(field_name, field_val)
    elif field_type == "time":
        _require(isinstance(field_val, Time), f"field {field_name} must be of type Time")
    elif field_type == "duration":
        _require(isinstance(field_val, Duration), f"field {field_name} must be of type Duration")
    else:
        _check_message(field_name, field_type, field_val)


def _is_float(value: Any) -> bool:
    # genpy has a list of numpy's types; here they are known by name, so that numpy need not be loaded.
    kind = type(value)
    return kind in (int, float) or (kind.__module__ == "numpy" and kind.__name__ in _NUMPY_FLOATS)


def _require(fits: bool, text: str) -> None:
    if not fits:
        raise SerializationError(text)


def _check_integer(name: str, kind: str, value: Any) -> None:
    bits = _BITS[kind]
    if kind in _SIGNED:
        _require(type(value) is int, f"field {name} must be an integer type")
        low, high = -(1 << bits - 1), 1 << bits - 1
    else:
        _require(type(value) is int and value >= 0, f"field {name} must be unsigned integer type")
        low, high = 0, 1 << bits
    _require(low <= value < high, f"field {name} exceeds specified width [{kind}]")


def _check_string(name: str, value: Any) -> None:
    _require(type(value) in (str, bytes), f"field {name} must be of type bytes or an ascii string")
    _require(type(value) is bytes or value.isascii(), f"field {name} is a non-ascii string")


def _check_array(name: str, field_type: str, value: Any) -> None:
    base = field_type[: field_type.index("[")]
    if type(value) in (str, bytes):
        if base in ("uint8", "char"):
            return
        raise SerializationError(f"field {name} must be a list or tuple type. Only uint8[] can be a string")
    _require(type(value) in (list, tuple), f"field {name} must be a list or tuple type")
    for item in value:
        check_type(name + "[]", base, item)


def _check_message(name: str, field_type: str, value: Any) -> None:
    found = getattr(value, "_type", None)
    if found is None:
        raise SerializationError(f"field {name} must be of type [{field_type}]")
    if found in _HEADERS and field_type not in _HEADERS:
        raise SerializationError(f"field {name} must be a Header instead of a {found}")
    if found not in _HEADERS and found != field_type:
        raise SerializationError(f"field {name} must be of type {field_type} instead of {found}")
    for slot, slot_type in zip(value.__slots__, value._get_types(), strict=False):
        check_type(f"{name}.{slot}", slot_type, getattr(value, slot))

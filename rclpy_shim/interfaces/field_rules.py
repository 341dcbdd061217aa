"""Rules for one field of a ROS 2 message class: its default value, its conversion, its check, the name of its type.

They are the rules of rosidl's generator for Python. Checks run in a message with `check_fields=True`, and in all
messages if the environment variable ROS_PYTHON_CHECK_FIELDS is 1; their texts are ROS's.
"""

from __future__ import annotations

import math
from array import array
from collections import UserList, UserString
from collections.abc import Callable, Sequence, Set
from typing import Any

from rclpy_shim.interfaces.codec import is_numeric
from rclpy_shim.interfaces.interface_text import FLOATS, INTEGERS, PRIMITIVES, STRINGS, InterfaceField
from rospy_shim.types.msgs.spec import PRIMITIVES as CODES

Check = Callable[[Any], None]
_SHOWN = {"float32": "float", "float64": "double", "byte": "octet", "char": "uint8", "bool": "boolean"}
_LARGEST = {"float32": 3.402823466e38, "float64": 1.7976931348623157e308}


def shown_type(field: InterfaceField) -> str:
    """Return the type of a field as `get_fields_and_field_types` has it, such as "sequence<double, 3>"."""
    base = _SHOWN.get(field.base, field.base)
    if field.text_bound is not None:
        base = f"{base}<{field.text_bound}>"
    if not field.is_array:
        return base
    if field.fixed_length is not None:
        return f"{base}[{field.length}]"
    return f"sequence<{base}>" if field.length is None else f"sequence<{base}, {field.length}>"


def default_maker(field: InterfaceField, class_of: Callable[[str], type]) -> Callable[[], Any]:
    """Return the function that makes a field's default value.

    Args:
        field: the field.
        class_of: classes of nested types.
    """
    base, length, written = field.base, field.fixed_length, field.default
    if is_numeric(base) and field.is_array:
        return _numbers_maker(field)
    if written is not None:
        return (lambda: list(written)) if field.is_array else lambda: written
    if not field.is_array:
        return _single_maker(base, class_of)
    if length is None:
        return list
    each = _single_maker(base, class_of)
    return lambda: [each() for _ in range(length)]


def _numbers_maker(field: InterfaceField) -> Callable[[], Any]:
    code, length, written = CODES[field.base], field.fixed_length, field.default
    if length is None:
        return lambda: array(code, written or ())

    def make() -> Any:
        import numpy

        return numpy.zeros(length, code) if written is None else numpy.array(written, code)

    return make


def _single_maker(base: str, class_of: Callable[[str], type]) -> Callable[[], Any]:
    if base in STRINGS:
        return str
    if base not in PRIMITIVES:
        return class_of(base)
    if base == "byte":
        return lambda: b"\0"
    return {"bool": bool, "float32": float, "float64": float}.get(base, int)


def converter(field: InterfaceField) -> Callable[[Any], Any] | None:
    """Return the function that converts an assigned value; None if a field holds the value itself.

    The function raises TypeError, OverflowError or ValueError, as `array` and numpy do.
    """
    if not field.is_array or not is_numeric(field.base):
        return None
    code = CODES[field.base]
    if field.fixed_length is None:
        return lambda value: array(code, value)

    def to_numpy(value: Any) -> Any:
        import numpy

        return numpy.array(value, code)

    return to_numpy


def check_of(field: InterfaceField, class_of: Callable[[str], type]) -> Check:
    """Return the check of an assigned value.

    Args:
        field: the field.
        class_of: classes of nested types.

    Returns:
        A function that raises AssertionError with ROS's text.
    """
    single = _single_check(field, class_of)
    if not field.is_array:
        return lambda value: single(value, f"The '{field.name}' field must be ")
    return lambda value: _check_array(field, single, value)


def _check_array(field: InterfaceField, single: Callable[[Any, str], None], value: Any) -> None:
    head = f"The '{field.name}' field must be a set or sequence"
    if field.fixed_length is not None:
        head += f" with length {field.length}"
    elif field.length is not None:
        head += f" with length <= {field.length}"
    is_listed = isinstance(value, (Sequence, Set, UserList, array)) or hasattr(value, "dtype")
    if not is_listed or isinstance(value, (str, UserString)) or not _fits(field, len(value)):
        raise AssertionError(head)
    is_typed = isinstance(value, array) and value.typecode == CODES.get(field.base)
    if not is_typed and not hasattr(value, "dtype"):
        for each in value:
            single(each, f"{head} and each value ")


def _fits(field: InterfaceField, count: int) -> bool:
    return field.length is None or (count <= field.length if field.is_bounded else count == field.length)


def _single_check(field: InterfaceField, class_of: Callable[[str], type]) -> Callable[[Any, str], None]:
    base = field.base
    if base in STRINGS:
        return lambda value, head: _check_text(value, head, field.text_bound)
    if base == "bool":
        return lambda value, head: _require(isinstance(value, bool), f"{head}of type 'bool'")
    if base == "byte":
        text = "of type 'bytes' or 'ByteString' with length 1"
        return lambda value, head: _require(isinstance(value, bytes) and len(value) == 1, head + text)
    if base in INTEGERS:
        return lambda value, head: _check_integer(value, head, *INTEGERS[base])
    if base in FLOATS:
        return lambda value, head: _check_float(value, head, _LARGEST[base])
    name = base.rpartition("/")[2]
    return lambda value, head: _require(isinstance(value, class_of(base)), f"{head}a sub message of type '{name}'")


def _require(is_right: bool, text: str) -> None:
    if not is_right:
        raise AssertionError(text)


def _check_text(value: Any, head: str, bound: int | None) -> None:
    _require(isinstance(value, str), f"{head}of type 'str'")
    _require(bound is None or len(value) <= bound, f"{head}string value not longer than {bound}")


def _check_integer(value: Any, head: str, low: int, high: int) -> None:
    _require(isinstance(value, int), f"{head}of type 'int'")
    kind = "an unsigned integer" if low == 0 else "an integer"
    _require(low <= value <= high, f"{head}{kind} in [{low}, {high}]")


def _check_float(value: Any, head: str, largest: float) -> None:
    _require(isinstance(value, float), f"{head}of type 'float'")
    _require(not math.isfinite(value) or abs(value) <= largest, f"{head}a float in [{-largest}, {largest}]")

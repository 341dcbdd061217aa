"""The plain encoder: one struct call per value, in wire order, straight from the spec.

It is what the generated code must agree with, byte for byte, and it explains failures: run on a message that generated
code could not pack, it fails at the same field and in the same way as genpy. Never on the hot path.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Any

from rospy_shim.genpy.errors import SerializationError
from rospy_shim.msgs.spec import PRIMITIVES, Field, Spec

_Lookup = Callable[[str], Spec]
_PAIRS = {"time": "<II", "duration": "<ii"}


def encode(spec: Spec, lookup: _Lookup, message: Any) -> bytes:
    """Encode a message.

    Args:
        spec: its type.
        lookup: specs of nested types.
        message: any object with the fields as attributes.

    Raises:
        struct.error, TypeError, ValueError, AttributeError: a field does not fit; as Python says it.
    """
    return b"".join(_field(field, lookup, getattr(message, field.attribute)) for field in spec.fields)


def explain(spec: Spec, lookup: _Lookup, message: Any, error: Exception) -> Exception:
    """The error that genpy raises for a message that cannot be serialized.

    Args:
        spec: its type.
        lookup: specs of nested types.
        message: the message.
        error: what generated code stumbled over.

    Returns:
        a SerializationError; or an AttributeError or UnicodeEncodeError where genpy lets that one through.
    """
    try:
        encode(spec, lookup, message)
    except (AttributeError, UnicodeEncodeError) as found:
        return found
    except (struct.error, TypeError) as found:
        text = f"{type(found)}: '{found}' when writing '{message}'"
    except ValueError as found:
        text = str(found)
    else:
        text = str(error)
    try:
        message._check_types(SerializationError(text))
    except Exception as found:
        return found
    return SerializationError(text)


def _field(field: Field, lookup: _Lookup, value: Any) -> bytes:
    if not field.is_array:
        return _single(field.base, lookup, value)
    if field.base in ("uint8", "char"):
        return _octets(field.length, value)
    count = b"" if field.length is not None else struct.pack("<I", len(value))
    if field.base in PRIMITIVES:
        length = len(value) if field.length is None else field.length
        return count + struct.pack(f"<{length}{PRIMITIVES[field.base]}", *value)
    if field.length not in (None, len(value)):
        raise ValueError(f"Expecting {field.length} items but found {len(value)} when writing 'self.{field.attribute}'")
    return count + b"".join(_single(field.base, lookup, item) for item in value)


def _single(base: str, lookup: _Lookup, value: Any) -> bytes:
    if base in PRIMITIVES:
        return struct.pack("<" + PRIMITIVES[base], value)
    if base == "string":
        len(value)  # a number is a TypeError before it lacks encode()
        encoded = value.encode("utf-8")
        return struct.pack("<I", len(encoded)) + bytes(encoded)
    if base in _PAIRS:
        return struct.pack(_PAIRS[base], value.secs, value.nsecs)
    return encode(lookup(base), lookup, value)


def _octets(length: int | None, value: Any) -> bytes:
    size = len(value) if length is None else length
    count = b"" if length is not None else struct.pack("<I", size)
    if type(value) in (list, tuple):
        return count + struct.pack(f"<{size}B", *value)
    return count + struct.pack(f"<{size}s", value)

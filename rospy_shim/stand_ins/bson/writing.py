"""Encoding of documents."""

from __future__ import annotations

import struct
from collections.abc import Mapping
from typing import Any

from bson.errors import InvalidDocument

_INT32, _INT64 = range(-(1 << 31), 1 << 31), range(-(1 << 63), 1 << 63)


def document_of(document: Mapping[str, Any]) -> bytes:
    """Encode a document.

    Raises:
        InvalidDocument: a value in it has no form in BSON.
    """
    body = b"".join(_element(name, value) for name, value in document.items())
    return struct.pack("<i", len(body) + 5) + body + b"\0"


def _element(name: object, value: Any) -> bytes:
    if not isinstance(name, str) or "\0" in name:
        raise InvalidDocument(f"a key must be a text without a zero, not {name!r}")
    kind, content = _content(value)
    return bytes([kind]) + name.encode() + b"\0" + content


def _content(value: Any) -> tuple[int, bytes]:
    """Return the number of a value's type, and its bytes."""
    if value is None:
        return 0x0A, b""
    if isinstance(value, bool):
        return 0x08, bytes([value])
    if isinstance(value, int):
        return _integer(value)
    if isinstance(value, float):
        return 0x01, struct.pack("<d", value)
    if isinstance(value, str):
        text = value.encode()
        return 0x02, struct.pack("<i", len(text) + 1) + text + b"\0"
    if isinstance(value, (bytes, bytearray)):
        return 0x05, struct.pack("<iB", len(value), getattr(value, "subtype", 0)) + bytes(value)
    if isinstance(value, Mapping):
        return 0x03, document_of(value)
    if isinstance(value, (list, tuple)):
        return 0x04, document_of({str(index): each for index, each in enumerate(value)})
    raise InvalidDocument(f"cannot encode object: {value!r}, of type: {type(value)}")


def _integer(value: int) -> tuple[int, bytes]:
    if value in _INT32:
        return 0x10, struct.pack("<i", value)
    if value in _INT64:
        return 0x12, struct.pack("<q", value)
    raise InvalidDocument(f"{value} has more than 64 bits")

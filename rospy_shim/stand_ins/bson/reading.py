"""Decoding of documents."""

from __future__ import annotations

import struct
from typing import Any

from bson.binary import BINARY_SUBTYPE, Binary
from bson.errors import InvalidBSON

_FIXED = {0x01: "<d", 0x08: "<?", 0x10: "<i", 0x12: "<q"}


def read_document(data: bytes) -> dict[str, Any]:
    """Decode a document.

    Raises:
        InvalidBSON: the bytes are not a document.
    """
    try:
        document, end = _document(data, 0)
    except (IndexError, ValueError, struct.error) as error:
        raise InvalidBSON(f"not a document: {error}") from None
    if end != len(data):
        raise InvalidBSON(f"{len(data) - end} bytes after the document")
    return document


def _document(data: bytes, at: int) -> tuple[dict[str, Any], int]:
    """Return the document that begins at an offset, and the offset of its end."""
    end = at + struct.unpack_from("<i", data, at)[0]
    at += 4
    found: dict[str, Any] = {}
    while data[at]:
        zero = data.index(b"\0", at + 1)
        found[data[at + 1 : zero].decode()], at = _value(data[at], data, zero + 1)
    if at + 1 != end:
        raise InvalidBSON("the length of a document does not match its bytes")
    return found, end


def _value(kind: int, data: bytes, at: int) -> tuple[Any, int]:
    """Return the value of a type that begins at an offset, and the offset of its end."""
    if kind == 0x0A:
        return None, at
    if kind in _FIXED:
        return struct.unpack_from(_FIXED[kind], data, at)[0], at + struct.calcsize(_FIXED[kind])
    if kind in (0x03, 0x04):
        document, end = _document(data, at)
        return (document if kind == 0x03 else list(document.values())), end
    length = struct.unpack_from("<i", data, at)[0]
    if kind == 0x02:
        return data[at + 4 : at + 3 + length].decode(), at + 4 + length
    if kind == 0x05:
        content, subtype = data[at + 5 : at + 5 + length], data[at + 4]
        return (content if subtype == BINARY_SUBTYPE else Binary(content, subtype)), at + 5 + length
    raise InvalidBSON(f"unknown type 0x{kind:02x}")

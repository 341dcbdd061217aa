"""A stand-in for the BSON format of pymongo, which rosbridge sends messages in (bsonspec.org, version 1.1).

It knows what JSON knows, bytes, and integers of 32 and 64 bits.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from bson import binary, errors
from bson.binary import Binary
from bson.reading import read_document
from bson.writing import document_of

__all__ = ["BSON", "Binary", "binary", "decode", "encode", "errors"]


def encode(document: Mapping[str, Any]) -> bytes:
    """The bytes of a document.

    Raises:
        InvalidDocument: something in it has no form in BSON.
    """
    return document_of(document)


def decode(data: bytes) -> dict[str, Any]:
    """The document that bytes are.

    Raises:
        InvalidBSON: they are none.
    """
    return read_document(bytes(data))


class BSON(bytes):
    """The bytes of a document."""

    @classmethod
    def encode(cls, document: Mapping[str, Any]) -> BSON:
        """See `encode`."""
        return cls(document_of(document))

    def decode(self) -> dict[str, Any]:  # type: ignore[override]  # as pymongo has it
        """See `decode`."""
        return read_document(self)

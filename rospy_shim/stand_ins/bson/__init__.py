"""A stand-in for the BSON format of pymongo, in which rosbridge sends messages (bsonspec.org, version 1.1).

It supports JSON's types, bytes, and integers of 32 and 64 bits.
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
    """Encode a document.

    Raises:
        InvalidDocument: a value in it has no form in BSON.
    """
    return document_of(document)


def decode(data: bytes) -> dict[str, Any]:
    """Decode a document.

    Raises:
        InvalidBSON: the bytes are not a document.
    """
    return read_document(bytes(data))


class BSON(bytes):
    """The bytes of a document."""

    @classmethod
    def encode(cls, document: Mapping[str, Any]) -> BSON:
        """Encode a document; see `encode`."""
        return cls(document_of(document))

    def decode(self) -> dict[str, Any]:  # type: ignore[override]  # as pymongo has it
        """Decode the document; see `decode`."""
        return read_document(self)

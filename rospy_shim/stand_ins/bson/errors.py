"""bson.errors: errors of documents."""

from __future__ import annotations


class BSONError(Exception):
    """Base of these errors."""


class InvalidBSON(BSONError):
    """Bytes are not a document."""


class InvalidDocument(BSONError):
    """A document has no form in BSON."""

"""bson.errors: what goes wrong with documents."""

from __future__ import annotations


class BSONError(Exception):
    """Any of these."""


class InvalidBSON(BSONError):
    """Bytes are no document."""


class InvalidDocument(BSONError):
    """A document has no form in BSON."""

"""bson.binary: bytes with a subtype."""

from __future__ import annotations

BINARY_SUBTYPE = 0


class Binary(bytes):
    """Bytes with a subtype.

    Args:
        data: the bytes.
        subtype: 0 to 255; 0 is bytes of any kind.
    """

    subtype: int

    def __new__(cls, data: bytes, subtype: int = BINARY_SUBTYPE) -> Binary:
        """Make the bytes; see the class."""
        self = super().__new__(cls, data)
        self.subtype = subtype
        return self

"""The three message errors of genpy.message; nodes catch them by these names. Imports nothing of cfepy."""

from __future__ import annotations


class MessageException(Exception):  # genpy's name
    """Anything wrong with a message."""

    __module__ = "genpy.message"


class SerializationError(MessageException):
    """A field holds a value that its type cannot carry."""

    __module__ = "genpy.message"


class DeserializationError(MessageException):
    """Bytes end before the message does."""

    __module__ = "genpy.message"

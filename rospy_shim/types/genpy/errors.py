"""The three message errors of genpy.message, and the handling of text that is not UTF-8."""

from __future__ import annotations

import codecs


class MessageException(Exception):  # genpy's name
    """Base of message errors."""

    __module__ = "genpy.message"


class SerializationError(MessageException):
    """A field holds a value that its type cannot carry."""

    __module__ = "genpy.message"


class DeserializationError(MessageException):
    """Bytes end before the message does."""

    __module__ = "genpy.message"


class RosMsgUnicodeErrors:  # genpy's name
    """The codec error handler "rosmsg": it replaces invalid UTF-8 by U+FFFD. Generated sources decode with it."""

    __module__ = "genpy.message"

    def __init__(self) -> None:
        self.msg_type: str | None = None

    def __call__(self, err: UnicodeError) -> tuple[str | bytes, int]:
        return codecs.replace_errors(err)


codecs.register_error("rosmsg", RosMsgUnicodeErrors())

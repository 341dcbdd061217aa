"""The three message errors of genpy.message, and how text that is not UTF-8 is handled."""

from __future__ import annotations

import codecs


class MessageException(Exception):  # genpy's name
    """Anything wrong with a message."""

    __module__ = "genpy.message"


class SerializationError(MessageException):
    """A field holds a value that its type cannot carry."""

    __module__ = "genpy.message"


class DeserializationError(MessageException):
    """Bytes end before the message does."""

    __module__ = "genpy.message"


class RosMsgUnicodeErrors:  # genpy's name
    """The codec error handler "rosmsg": it puts U+FFFD where text is not UTF-8. Generated sources decode with it."""

    __module__ = "genpy.message"

    def __init__(self) -> None:
        self.msg_type: str | None = None

    def __call__(self, err: UnicodeError) -> tuple[str | bytes, int]:
        return codecs.replace_errors(err)


codecs.register_error("rosmsg", RosMsgUnicodeErrors())

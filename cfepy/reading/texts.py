"""Text as C has it: bytes that need not be UTF-8.

A name in a command, a file or a table header is bytes, and cFE hands it on as it is, into events and files. Here it is
a `str` on the way: bytes that are not UTF-8 stand in it as surrogates (PEP 383) and come out again as they went in.
"""

from __future__ import annotations

import re

_ESCAPES = range(0xDC80, 0xDD00)  # what PEP 383 makes of the bytes 0x80 to 0xFF
_SURROGATES = range(0xD800, 0xE000)
_ADDRESS = re.compile(r"(?<= at )0x(?![1-4][0-9a-fA-F]{9}\b)[0-9a-fA-F]{9,16}\b")
"""Of an object of Python. Those of compiled applications (`cfepy.extra.c.arena`) are the same in each run."""


def to_bytes(text: str) -> bytes:
    """The bytes of a text; "?" for a surrogate that stands for no byte."""
    try:
        return text.encode("utf-8", "surrogateescape")
    except UnicodeEncodeError:
        return "".join(map(_encodable, text)).encode("utf-8", "surrogateescape")


def _encodable(character: str) -> str:
    code = ord(character)
    return "?" if code in _SURROGATES and code not in _ESCAPES else character


def from_bytes(data: bytes) -> str:
    """The text up to the first NUL, if there is one."""
    return data.partition(b"\0")[0].decode("utf-8", "surrogateescape")


def shown(text: str) -> str:
    """A text for people: U+FFFD for what is not UTF-8."""
    return to_bytes(text).decode("utf-8", "replace")


def without_addresses(text: str) -> str:
    """A text in which objects are shown, as `<Future at 0x7f3709f8bb20>`, with 0x0 in place of where they are.

    That is another place in each run, so it must not get into what a run is compared by. A number in the order in which
    they are first seen would be no better: a new object may be where an old one was, or not.
    """
    return _ADDRESS.sub("0x0", text) if " at 0x" in text else text

"""Text as C has it: bytes that need not be UTF-8.

A name in a command, a file or a table header is bytes, and cFE passes it on unchanged into events and files. Here it is
a `str` meanwhile. Bytes that are not UTF-8 become surrogates (PEP 383) and are converted back unchanged.
"""

from __future__ import annotations

import re

_ESCAPES = range(0xDC80, 0xDD00)  # the surrogates of PEP 383 for the bytes 0x80 to 0xFF
_SURROGATES = range(0xD800, 0xE000)
_ADDRESS = re.compile(r"(?<= at )0x(?![1-4][0-9a-fA-F]{9}\b)[0-9a-fA-F]{9,16}\b")
"""The address of a Python object. Addresses in compiled applications (`cfepy.extra.c.arena`) are the same in
each run.
"""


def to_bytes(text: str) -> bytes:
    """Return the bytes of a text, with "?" for a surrogate that does not represent a byte."""
    try:
        return text.encode("utf-8", "surrogateescape")
    except UnicodeEncodeError:
        return "".join(map(_encodable, text)).encode("utf-8", "surrogateescape")


def _encodable(character: str) -> str:
    code = ord(character)
    return "?" if code in _SURROGATES and code not in _ESCAPES else character


def from_bytes(data: bytes) -> str:
    """Return the text up to the first NUL, if there is one."""
    return data.partition(b"\0")[0].decode("utf-8", "surrogateescape")


def shown(text: str) -> str:
    """Return a text for display, with U+FFFD for bytes that are not UTF-8."""
    return to_bytes(text).decode("utf-8", "replace")


def without_addresses(text: str) -> str:
    """Return a text with 0x0 in place of the addresses of Python objects, such as `<Future at 0x7f3709f8bb20>`.

    An address differs in each run, so it must not affect the comparison of runs. Numbering the objects in order of
    first appearance would not help: a new object may have the address of an old one, or not.
    """
    return _ADDRESS.sub("0x0", text) if " at 0x" in text else text

"""The words of a script and of its answers: numbers, 'texts, xBYTES, #ids, and the slots that keep ids.

app/api_app.c has the same rules.
"""

from __future__ import annotations

import string

PLAIN = string.ascii_letters + string.digits + "_-./:"
SLOTS = 100
Answer = tuple[object, ...]
"""What a call gives: its status, and values."""


class Id(int):
    """An id in an answer."""


def quote(text: str | bytes) -> str:
    """Return a text as a word."""
    data = text.encode("utf-8", "surrogateescape") if isinstance(text, str) else text
    return "'" + "".join(chr(byte) if chr(byte) in PLAIN else f"%{byte:02x}" for byte in data)


def unquote(word: str) -> str:
    """Return the text of a word."""
    data, rest = bytearray(), word[1:].encode("ascii")
    while rest:
        data += bytes.fromhex(rest[1:3].decode()) if rest[:1] == b"%" else rest[:1]
        rest = rest[3:] if rest[:1] == b"%" else rest[1:]
    return data.decode("utf-8", "surrogateescape")


def word_of(value: object) -> str:
    """Return a value of an answer as a word."""
    if isinstance(value, Id):
        return f"#{value & 0xFFFFFFFFFFFFFFFF:x}"
    if isinstance(value, str):
        return quote(value)
    if isinstance(value, bytes | bytearray | memoryview):
        return "x" + bytes(value).hex()
    assert isinstance(value, int), value
    return str(int(value))


class Line:
    """The arguments of a call. Words count from 1.

    Args:
        words: the words of the script line.
        slots: ids that calls returned.
    """

    def __init__(self, words: list[str], slots: list[int]) -> None:
        self.words = words
        self.slots = slots

    def __len__(self) -> int:
        return len(self.words)

    def num(self, word: int) -> int:
        """Return a number, or the content of slot $n."""
        text = self.words[word - 1] if word <= len(self.words) else "0"
        return self.slots[int(text[1:])] if text.startswith("$") else int(text, 0)

    def text(self, word: int) -> str:
        """Return a text."""
        return unquote(self.words[word - 1])

    def data(self, word: int) -> bytes:
        """Return bytes."""
        return bytes.fromhex(self.words[word - 1][1:])

    def keep(self, word: int, value: int) -> Id:
        """Keep an id in slot @n."""
        self.slots[int(self.words[word - 1][1:])] = value & 0xFFFFFFFF
        return Id(value)

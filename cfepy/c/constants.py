"""Constants for C code: texts and numbers that functions of the API return pointers to."""

from __future__ import annotations

import struct
from collections.abc import Iterable

from cfepy.c.arena import Arena, pages
from cfepy.c.memory import Memory
from cfepy.texts import to_bytes

_ROOM = 1 << 16
_ALIGNMENT = 16


class Constants:
    """Bytes in the arena that stay what they are; equal ones are there once.

    Args:
        arena: where they are.
    """

    def __init__(self, arena: Arena) -> None:
        self._arena = arena
        self._memory = Memory()
        self._known: dict[bytes, int] = {}
        self._next = self._end = 0

    def text(self, text: str) -> int:
        """The address of a text, with its NUL."""
        return self.data(to_bytes(text) + b"\0")

    def texts(self, texts: Iterable[str]) -> int:
        """The address of an array of pointers to texts, with a NULL at its end, as argv is."""
        pointers = [self.text(text) for text in texts]
        return self.data(struct.pack(f"<{len(pointers) + 1}Q", *pointers, 0))

    def data(self, data: bytes) -> int:
        """The address of some bytes."""
        address = self._known.get(data)
        if address is None:
            address = self._known[data] = self._take(len(data))
            self._memory.poke(address, data)
        return address

    def _take(self, size: int) -> int:
        if self._next + size > self._end:
            room = pages(max(size, _ROOM))
            self._next = self._arena.map(room)
            self._end = self._next + room
        address = self._next
        self._next += size + -size % _ALIGNMENT
        return address

"""Access to memory of C from Python: structures, texts and numbers at addresses."""

from __future__ import annotations

import struct
from collections.abc import Iterable
from struct import Struct

from cfepy.extra.c.arena import Arena, pages
from cfepy.extra.c.engine import engine
from cfepy.reading.texts import to_bytes

_U16, _U32, _U64, _I64 = Struct("<H"), Struct("<I"), Struct("<Q"), Struct("<q")


class CMemory:
    """The memory of C code. A bad address is a `CFault` of the code that passed it.

    Attributes:
        peek: (address, size) -> bytes.
        poke: (address, bytes).
        text: (address) -> the text up to its NUL.
        view: (address, size) -> the bytes themselves, as a memoryview.
        address_of: (buffer) -> the address of its bytes.
    """

    __slots__ = ("address_of", "peek", "poke", "text", "view")

    def __init__(self) -> None:
        made = engine()
        self.peek, self.poke, self.text = made.peek, made.poke, made.text
        self.view, self.address_of = made.view, made.address_of

    def u8(self, address: int) -> int:
        """Return the byte at an address."""
        return int(self.peek(address, 1)[0])

    def u32(self, address: int) -> int:
        """Return the uint32 at an address."""
        return int(_U32.unpack(self.peek(address, 4))[0])

    def u64(self, address: int) -> int:
        """Return the uint64, size_t or pointer at an address."""
        return int(_U64.unpack(self.peek(address, 8))[0])

    def i64(self, address: int) -> int:
        """Return the int64 at an address, such as an OS_time_t."""
        return int(_I64.unpack(self.peek(address, 8))[0])

    def put_u16(self, address: int, value: int) -> None:
        """Write a uint16 or int16."""
        self.poke(address, _U16.pack(value & 0xFFFF))

    def put_u32(self, address: int, value: int) -> None:
        """Write a uint32."""
        self.poke(address, _U32.pack(value & 0xFFFFFFFF))

    def put_u64(self, address: int, value: int) -> None:
        """Write a uint64, size_t or pointer."""
        self.poke(address, _U64.pack(value & 0xFFFFFFFFFFFFFFFF))

    def unpack(self, layout: Struct, address: int) -> tuple[object, ...]:
        """Return the fields of a structure."""
        return layout.unpack(self.peek(address, layout.size))

    def put_text(self, address: int, text: str, size: int) -> bool:
        """Write a text into an array of `size` characters, cut so that a NUL follows. Returns False if it was cut.

        The array is filled up with NULs.
        """
        raw = to_bytes(text)
        self.poke(address, chars(text, size))
        return len(raw) < size


def chars(text: str, size: int) -> bytes:
    """Return a text as an array of `size` characters, cut so that a NUL follows, filled up with NULs."""
    return to_bytes(text)[: size - 1].ljust(size, b"\0")


_ROOM = 1 << 16
_ALIGNMENT = 16


class Constants:
    """Constant bytes in the arena; equal ones are stored once.

    Args:
        arena: memory for them.
    """

    def __init__(self, arena: Arena) -> None:
        self._arena = arena
        self._memory = CMemory()
        self._known: dict[bytes, int] = {}
        self._next = self._end = 0

    def text(self, text: str) -> int:
        """Return the address of a text, with its NUL."""
        return self.data(to_bytes(text) + b"\0")

    def texts(self, texts: Iterable[str]) -> int:
        """Return the address of an array of pointers to texts, with a NULL at its end, as argv is."""
        pointers = [self.text(text) for text in texts]
        return self.data(struct.pack(f"<{len(pointers) + 1}Q", *pointers, 0))

    def data(self, data: bytes) -> int:
        """Return the address of some bytes."""
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

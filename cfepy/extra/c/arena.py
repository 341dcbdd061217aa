"""The memory of C code: blocks at addresses that are the same in each run.

A processor has its own region of 8 GiB of address space: the lowest one that no other living processor of this process
has. The arena hands out whole pages of it, lowest first, with an inaccessible page after each block. Memory that only
the guard needs comes from the end of the region, so all other memory has the same addresses with and without the guard.
"""

from __future__ import annotations

import mmap
from bisect import insort

from cfepy.extra.c.engine import engine

PAGE = mmap.PAGESIZE
"""4096 bytes on x86-64; kernels for aarch64 may have 16 or 64 KiB."""
REGION = 8 << 30
_FIRST = PAGE
"""The first page of a region only holds its place."""


def pages(size: int) -> int:
    """Return the bytes of whole pages for a size, at least one page."""
    return max(-(-size // PAGE), 1) * PAGE


_left: dict[int, int] = {}
"""Address and bytes of memory that earlier processors left in place.

It belongs to the process and to no processor. Python may still read such memory through views that outlive the
processor, so it stays until another region needs the place. In a region's second half, it stays until another processor
has the region. If views owned the memory, addresses would depend on the time of garbage collection, and addresses must
be the same in each run.
"""


class Arena:
    """The region of one processor.

    Attributes:
        base: its lowest address.
    """

    def __init__(self) -> None:
        self._engine = engine()
        self.base = self._take_region()
        self._top = self.base + _FIRST + PAGE
        self._end = self.base + REGION
        self._free: list[tuple[int, int]] = []  # (address, bytes), in this order
        self._sizes: dict[int, int] = {}
        self._shared: set[int] = set()

    def _take_region(self) -> int:
        """Take a region by mapping its first page, and return its address."""
        low, high = self._engine.ARENA_LOW, self._engine.ARENA_HIGH
        for base in range(low, high, REGION):
            try:
                self._engine.map(base, _FIRST)
            except OSError:
                continue
            self._drop_left(base + REGION // 2, base + REGION)
            return base
        raise MemoryError(
            f"{(high - low) // REGION} is the limit of processors with compiled applications in one process"
        )

    def map(self, size: int, shares: bool = False, is_last: bool = False) -> int:
        """Map new memory of zeros, readable and writable.

        Args:
            size: bytes; rounded up to pages.
            shares: Python objects use it as well, perhaps after the processor has ended; it stays until another
                processor has this region.
            is_last: from the end of the region.

        Returns:
            Its address.
        """
        room = pages(size)
        address = None if is_last else self._reuse(room)
        if address is None:
            address = self._end - room - PAGE if is_last else self._top
            if self._top + room + PAGE > self._end:
                raise MemoryError(f"not enough memory for {size} more bytes of compiled applications")
            if is_last:
                self._end = address
            else:
                self._top += room + PAGE
        self._drop_left(address, address + room)
        self._engine.map(address, room)
        self._sizes[address] = room
        if shares:
            self._shared.add(address)
        return address

    def _drop_left(self, start: int, end: int) -> None:
        """Unmap memory of earlier processors in an address range."""
        for left in [each for each, size in _left.items() if each < end and start < each + size]:
            self._engine.unmap(left, _left.pop(left))

    def _reuse(self, room: int) -> int | None:
        for number, (address, size) in enumerate(self._free):
            if size == room:
                del self._free[number]
                return address
        return None

    def unmap(self, address: int) -> None:
        """Free memory from `map`."""
        room = self._sizes.pop(address)
        self._engine.unmap(address, room)
        insort(self._free, (address, room))

    def close(self) -> None:
        """Free all memory, and the region with it."""
        for address, room in self._sizes.items():
            if address in self._shared:
                _left[address] = room
            else:
                self._engine.unmap(address, room)
        self._sizes.clear()
        self._engine.unmap(self.base, _FIRST)

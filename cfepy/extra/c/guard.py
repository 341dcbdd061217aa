"""The guard: blocks of memory that end where a page does that nobody may touch, and what is found of them.

malloc and the messages have heaps of their own, which the engine fills. The third one is for what other functions give
to C code: blocks of memory pools, images of tables, areas of the PSP. An access behind a block is a fault. Where the
alignment of a block leaves a gap before that page, and in the page before the block, there are bytes that are looked at
when the block is given back, and at the end of its application and of the processor.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

from cfepy.extra.c.arena import PAGE, Arena
from cfepy.extra.c.crashes import CFault
from cfepy.extra.c.engine import engine
from cfepy.extra.c.memory import CMemory

POISON = b"\xa5"
"""What is in memory that was never written, where that is to be found out."""
ROOM = 2 << 30
"""Bytes of address space for blocks, which are not used twice."""
ALIGNMENT = 16
"""The strictest of a type in C."""


class BlockLabel(NamedTuple):
    """What a block is for a person, and the application whose it is; empty for nobody's."""

    what: str
    app: str = ""


class GuardedHeap(NamedTuple):
    """One of the engine's heaps.

    Attributes:
        heap: it.
        block_at: what the block at an address is, given the number of its owner.
        fate: what became of one that is in use no more.
    """

    heap: Any
    block_at: Callable[[int, int], BlockLabel]
    fate: str


class Guard:
    """The guard of one processor.

    Args:
        arena: where blocks are.
        malloc: the heap of malloc.
        messages: that of messages.
        name_of: the application that has an AppId; empty for none.
        on_overwrite: gets the application and a text for each block of which it is found that it was written past when
            no call can be told so.
    """

    def __init__(
        self,
        arena: Arena,
        malloc: Any,
        messages: Any,
        name_of: Callable[[int], str],
        on_overwrite: Callable[[str, str], object],
    ) -> None:
        self._own = engine().Heap(arena.map(ROOM, shares=True, is_last=True), ROOM, guarded=True, page=PAGE)
        self._known: dict[int, BlockLabel] = {}
        self._on_overwrite = on_overwrite
        self._heaps = (
            GuardedHeap(malloc, lambda address, owner: BlockLabel("a block", name_of(owner)), "freed"),
            GuardedHeap(messages, lambda address, owner: BlockLabel("a message buffer"), "given back"),
            GuardedHeap(self._own, lambda address, owner: self._known[address], "given back"),
        )

    # -- blocks ------------------------------------------------------------------------------------------------------

    def take(self, size: int, what: str, app: str = "", alignment: int = ALIGNMENT) -> int:
        """A block of zeros; its address.

        Args:
            size: bytes.
            what: it is, for a person.
            app: whose it is; empty for nobody's.
            alignment: a power of 2.

        Raises:
            MemoryError: the address space is used up.
        """
        address = int(self._own.take(size, alignment))
        if not address:
            raise MemoryError(f"not enough memory for {size} more bytes of guarded blocks")
        self._known[address] = BlockLabel(what, app)
        return address

    def give(self, address: int, is_kept: bool = False) -> None:
        """Give a block back: who uses it then has a fault.

        Args:
            address: of the block; another one does nothing.
            is_kept: it stays as it is, since Python may still look at it.
        """
        self._own.give(address, is_kept)

    def check(self, address: int, call: str) -> None:
        """Look at a block in a call of C code that gives it back.

        Args:
            address: of the block; another one is not looked at.
            call: what is done to it, such as a call of a function.

        Raises:
            CFault: it was written past; that is told once.
        """
        found = self._own.damage(address)
        if found is not None:
            block = f"{self._known[address].what} of {self._own.size_of(address)} bytes"
            raise CFault(f"{call} of 0x{address:x}, {block} that was written {found}")

    def near(self, address: int) -> tuple[int, int] | None:
        """The block in whose pages, or in the guard behind them, an address is: its own address and bytes; or None."""
        found = self._own.near(address)
        return None if found is None else found[:2]

    # -- what is found -----------------------------------------------------------------------------------------------

    def tell(self) -> None:
        """Tell of the blocks that were found to be written past when they were given back."""
        for heap, block_at, _ in self._heaps:
            for address, size, owner, found in heap.noted():
                what, app = block_at(address, owner)
                self._on_overwrite(app, f"{what} of {size} bytes at 0x{address:x} was written {found}")

    def check_all(self) -> None:
        """Look at all blocks, and tell."""
        for each in self._heaps:
            each.heap.check()
        self.tell()

    def about(self, address: int) -> str:
        """Which block an address is in, or next to, for the text of a fault; empty for none."""
        for heap, block_at, fate in self._heaps:
            found = heap.near(address)
            if found is not None:
                start, size, is_used = found
                after = "" if is_used else f" that was {fate}"
                return f"offset {address - start} of {block_at(start, 0).what} of {size} bytes{after}"
        return ""


class GuardedTables:
    """Where images of tables are; see `cfepy.tbl.BufferPlaces`. They end where a page does, and stay when given back.

    Args:
        guard: of the processor.
    """

    def __init__(self, guard: Guard) -> None:
        self._guard = guard
        self._memory = CMemory()
        self._addresses: set[int] = set()

    def take(self, size: int, name: str) -> memoryview:
        """Room for an image.

        Args:
            size: bytes.
            name: full name of the table; empty for a buffer that tables share.
        """
        what = f"table {name}" if name else "a load buffer"
        address = self._guard.take(size, what, name.partition(".")[0], alignment_of(size))
        self._addresses.add(address)
        view: memoryview = self._memory.view(address, size)
        return view

    def give(self, data: memoryview) -> None:
        """An image's room is not needed any more; Python may still look at it."""
        self._guard.give(self._memory.address_of(data), is_kept=True)

    def check(self, images: Iterable[memoryview], call: str) -> None:
        """Look at images in a call of C code that gives their addresses back.

        Raises:
            CFault: one was written past.
        """
        for image in images:
            if len(image):
                self._guard.check(self._memory.address_of(image), call)

    def judge(self, image: memoryview, name: str, function: Callable[[int], int]) -> int:
        """Call the validation function of a table with an image: with a copy of its size where it is part of a buffer.

        Args:
            image: as large as the table.
            name: of the table.
            function: gets its address.

        Raises:
            CFault: it failed, or wrote before the image.
        """
        address = self._memory.address_of(image)
        near = self._guard.near(address)
        if address not in self._addresses or near is None or near[1] == len(image):
            return function(address)
        copy = self._guard.take(len(image), f"an image of table {name}", alignment=alignment_of(len(image)))
        self._memory.poke(copy, image)
        try:
            result = function(copy)
            self._guard.check(copy, "the validation")
            return result
        finally:
            image[:] = self._memory.peek(copy, len(image))
            self._guard.give(copy)


def alignment_of(size: int) -> int:
    """The strictest alignment with which a type of so many bytes can be: none leaves a gap behind it."""
    return min(size & -size, ALIGNMENT) or ALIGNMENT

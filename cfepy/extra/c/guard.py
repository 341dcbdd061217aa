"""The guard: memory blocks that end at an inaccessible page, and reports of writes outside of them.

malloc and the messages have their own heaps, which the engine fills. The third heap has blocks from other functions:
blocks of memory pools, images of tables, areas of the PSP. An access behind a block is a fault. The gap that alignment
leaves before that page, and the page before the block, contain check bytes. cfepy checks them when the block is given
back, and at the end of its application and of the processor.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

from cfepy.extra.c.arena import PAGE, Arena
from cfepy.extra.c.crashes import CFault
from cfepy.extra.c.engine import engine
from cfepy.extra.c.memory import CMemory

POISON = b"\xa5"
"""Fills memory that was never written, so that a read of it shows."""
ROOM = 2 << 30
"""Bytes of address space for blocks; addresses are not used twice."""
ALIGNMENT = 16
"""The strictest alignment of a type in C."""


class BlockLabel(NamedTuple):
    """The description of a block, and the application that owns it; empty for none."""

    what: str
    app: str = ""


class GuardedHeap(NamedTuple):
    """One of the engine's heaps.

    Attributes:
        heap: the heap.
        block_at: returns the label of the block at an address, given the number of its owner.
        fate: the state of a block that is no longer in use.
    """

    heap: Any
    block_at: Callable[[int, int], BlockLabel]
    fate: str


class Guard:
    """The guard of one processor.

    Args:
        arena: memory for blocks.
        malloc: the heap of malloc.
        messages: the heap of messages.
        name_of: returns the application with an AppId; empty for none.
        on_overwrite: gets the application and a text for each overwritten block that is found outside of a call.
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
        """Return the address of a new block of zeros.

        Args:
            size: bytes.
            what: description of the block for the user.
            app: the application that owns it; empty for none.
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
        """Give a block back. Any later access to it is a fault.

        Args:
            address: of the block; another address does nothing.
            is_kept: it stays as it is, because Python may still read it.
        """
        self._own.give(address, is_kept)

    def check(self, address: int, call: str) -> None:
        """Check a block in a call of C code that gives it back.

        Args:
            address: of the block; another address is not checked.
            call: the operation on it, such as a call of a function.

        Raises:
            CFault: the code wrote past it; this is raised once.
        """
        found = self._own.damage(address)
        if found is not None:
            block = f"{self._known[address].what} of {self._own.size_of(address)} bytes"
            raise CFault(f"{call} of 0x{address:x}, {block} that was written {found}")

    def near(self, address: int) -> tuple[int, int] | None:
        """Return address and bytes of the block whose pages, or the guard behind them, contain an address; or None."""
        found = self._own.near(address)
        return None if found is None else found[:2]

    # -- findings ------------------------------------------------------------------------------------------------------

    def tell(self) -> None:
        """Report the blocks that were found to be overwritten when they were given back."""
        for heap, block_at, _ in self._heaps:
            for address, size, owner, found in heap.noted():
                what, app = block_at(address, owner)
                self._on_overwrite(app, f"{what} of {size} bytes at 0x{address:x} was written {found}")

    def check_all(self) -> None:
        """Check all blocks, and report."""
        for each in self._heaps:
            each.heap.check()
        self.tell()

    def about(self, address: int) -> str:
        """Return the block that contains an address, or is next to it, for the text of a fault; empty for none."""
        for heap, block_at, fate in self._heaps:
            found = heap.near(address)
            if found is not None:
                start, size, is_used = found
                after = "" if is_used else f" that was {fate}"
                return f"offset {address - start} of {block_at(start, 0).what} of {size} bytes{after}"
        return ""


class GuardedTables:
    """Places for images of tables; see `cfepy.tbl.BufferPlaces`. They end at a page's end, and stay when given back.

    Args:
        guard: of the processor.
    """

    def __init__(self, guard: Guard) -> None:
        self._guard = guard
        self._memory = CMemory()
        self._addresses: set[int] = set()

    def take(self, size: int, name: str) -> memoryview:
        """Return memory for an image.

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
        """Give an image's memory back. Python may still read it."""
        self._guard.give(self._memory.address_of(data), is_kept=True)

    def check(self, images: Iterable[memoryview], call: str) -> None:
        """Check images in a call of C code that gives their addresses back.

        Raises:
            CFault: the code wrote past an image.
        """
        for image in images:
            if len(image):
                self._guard.check(self._memory.address_of(image), call)

    def judge(self, image: memoryview, name: str, function: Callable[[int], int]) -> int:
        """Call a table's validation function with an image, or with a copy if the image is only part of a buffer.

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
    """Return the strictest alignment that a type of this size can have, so that no gap follows the type."""
    return min(size & -size, ALIGNMENT) or ALIGNMENT

"""The memory that table images live in: a table's own one or two buffers, and the load buffers that tables share.

Stands for cfe_tbl_loadbuff.c. All come out of one memory pool of Executive Services. Images never move; only which
buffer is active changes.
"""

from __future__ import annotations

from cfepy.fs import calculate_crc
from cfepy.ports import Block, Ports
from cfepy.status import CFE_TBL_ERR_NO_BUFFER_AVAIL, CfeError

_FIRST_ADDRESS = 0x10000
_ALIGNMENT = 8

Bytes = bytes | bytearray | memoryview


class Buffer:
    """One image.

    Attributes:
        data: the bytes; all of the buffer, of which a shared one uses only `content_size`.
        content_size: bytes that belong to the table now.
        address: a number for telemetry; nothing can be read through it.
        block: what it is in the pool; None for memory of an app.
        source: where the image came from, for LastFileLoaded.
        file_time: (seconds, subseconds) of the file it came from.
        crc: CRC-16 of the content at load time.
        is_valid: the image passed its validation.
        activate_requested: the owner may switch to it.
        place: what a registry dump calls it: a shared buffer's index, or -3 and -2 for a table's own two.
    """

    __slots__ = (
        "activate_requested",
        "address",
        "block",
        "content_size",
        "crc",
        "data",
        "file_time",
        "is_valid",
        "place",
        "source",
    )

    def __init__(self, data: memoryview, address: int, place: int, block: Block | None = None) -> None:
        self.data = data
        self.block = block
        self.address = address
        self.place = place
        self.content_size = len(data)
        self.source = ""
        self.file_time = (0, 0)
        self.crc = 0
        self.is_valid = False
        self.activate_requested = False

    @property
    def is_shared(self) -> bool:
        """Whether it belongs to all tables."""
        return self.place >= 0

    def view(self) -> memoryview:
        """The content, writable in place."""
        return self.data[: self.content_size]

    def copy(self, image: Bytes) -> None:
        """Replace the content."""
        self.data[: len(image)] = image
        self.content_size = len(image)

    def take_over(self, other: Buffer) -> None:
        """Become a copy of another buffer, content and what is known of it (the update of a single-buffered table)."""
        self.copy(other.view())
        self.source, self.file_time, self.crc = other.source, other.file_time, other.crc
        self.is_valid = other.is_valid

    def clear(self) -> None:
        """Overwrite the content with zeros."""
        self.data[: self.content_size] = bytes(self.content_size)

    def recompute_crc(self) -> None:
        """Note the CRC of the content as it is now."""
        self.crc = calculate_crc(self.view())

    def mark_unvalidated(self) -> None:
        """What every new image starts as."""
        self.is_valid = self.activate_requested = False


class BufferMemory:
    """The table buffer pool, and the shared buffers that are lent out of it.

    Args:
        ports: has Executive Services, and with them the pool.
        size: bytes of the pool (CFE_PLATFORM_TBL_BUF_MEMORY_BYTES).
        shared: how many load buffers the tables share (CFE_PLATFORM_TBL_MAX_SIMULTANEOUS_LOADS).
        shared_size: bytes of each.

    Attributes:
        pool_id: the pool's handle.
    """

    def __init__(self, ports: Ports, size: int, shared: int, shared_size: int) -> None:
        self._ports = ports
        self._size = size
        self._shared = shared
        self._shared_size = shared_size
        self._next_address = _FIRST_ADDRESS
        self._free: list[Buffer] = []
        self.pool_id = 0

    def early_init(self) -> None:
        """Make the pool and take the shared buffers out of it.

        Raises:
            CfeError: there is no room for them.
        """
        self.pool_id = self._ports.es.pool_create(self._size, "CFE_TBL")
        self._free = [self.allocate(self._shared_size, place) for place in range(self._shared)]

    @property
    def free_shared(self) -> int:
        """The number of shared buffers that are free."""
        return len(self._free)

    def allocate(self, size: int, place: int) -> Buffer:
        """A zeroed buffer of `size` bytes.

        Raises:
            CfeError: CFE_ES_ERR_MEM_BLOCK_SIZE when the pool has no room for it.
        """
        block = self._ports.es.get_pool_buf(self.pool_id, size)
        return Buffer(block.memory, self._address_for(size), place, block)

    def external(self, data: Bytes, place: int) -> Buffer:
        """A buffer over memory of an app, which stays the app's (CFE_TBL_OPT_USR_DEF_ADDR); it costs nothing here."""
        return Buffer(memoryview(data), self._address_for(len(data)), place)

    def free(self, buffer: Buffer) -> None:
        """Give a table's own buffer back."""
        if buffer.block is not None:
            self._ports.es.put_pool_buf(self.pool_id, buffer.block)

    def acquire_shared(self) -> Buffer:
        """Borrow the shared buffer with the lowest number.

        Raises:
            CfeError: CFE_TBL_ERR_NO_BUFFER_AVAIL when all are lent.
        """
        if not self._free:
            raise CfeError(CFE_TBL_ERR_NO_BUFFER_AVAIL, "all shared load buffers are in use")
        buffer = self._free.pop(0)
        buffer.mark_unvalidated()
        return buffer

    def release_shared(self, buffer: Buffer) -> None:
        """Give a shared buffer back."""
        self._free.append(buffer)
        self._free.sort(key=lambda each: each.place)

    def _address_for(self, size: int) -> int:
        address = self._next_address
        self._next_address += size + -size % _ALIGNMENT
        return address

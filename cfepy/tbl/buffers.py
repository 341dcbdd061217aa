"""The memory that table images live in: a table's own one or two buffers, and the load buffers that tables share.

Stands for cfe_tbl_loadbuff.c. Images never move; only which buffer is active changes. Imports only cfepy.fs and
cfepy.status.
"""

from __future__ import annotations

from cfepy.fs import calculate_crc
from cfepy.status import CFE_ES_ERR_MEM_BLOCK_SIZE, CFE_TBL_ERR_NO_BUFFER_AVAIL, CfeError

_FIRST_ADDRESS = 0x10000
_ALIGNMENT = 8

Bytes = bytes | bytearray | memoryview


class Buffer:
    """One image.

    Attributes:
        data: the bytes; all of the buffer, of which a shared one uses only `content_size`.
        content_size: bytes that belong to the table now.
        address: a number for telemetry; nothing can be read through it.
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
        "content_size",
        "crc",
        "data",
        "file_time",
        "is_valid",
        "place",
        "source",
    )

    def __init__(self, data: memoryview, address: int, place: int) -> None:
        self.data = data
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
    """The table buffer pool: counts what is taken of CFE_PLATFORM_TBL_BUF_MEMORY_BYTES and lends the shared buffers.

    Args:
        limit: bytes in all.
        shared: how many load buffers the tables share (CFE_PLATFORM_TBL_MAX_SIMULTANEOUS_LOADS).
        shared_size: bytes of each.
    """

    def __init__(self, limit: int, shared: int, shared_size: int) -> None:
        self.limit = limit
        self.used = 0
        self._next_address = _FIRST_ADDRESS
        self._free = [self.allocate(shared_size, place) for place in range(shared)]

    @property
    def free_shared(self) -> int:
        """Shared buffers that nobody has."""
        return len(self._free)

    def allocate(self, size: int, place: int) -> Buffer:
        """A zeroed buffer of `size` bytes.

        Raises:
            CfeError: CFE_ES_ERR_MEM_BLOCK_SIZE when the pool has no room for it.
        """
        if self.used + size > self.limit:
            text = f"a table buffer of {size} bytes, with {self.used} of {self.limit} taken; raise tbl_buf_memory_bytes"
            raise CfeError(CFE_ES_ERR_MEM_BLOCK_SIZE, text)
        self.used += size
        address = self._next_address
        self._next_address += size + -size % _ALIGNMENT
        return Buffer(memoryview(bytearray(size)), address, place)

    def external(self, data: Bytes, place: int) -> Buffer:
        """A buffer over memory of an app, which stays the app's (CFE_TBL_OPT_USR_DEF_ADDR); it costs nothing here."""
        address = self._next_address
        self._next_address += len(data) + -len(data) % _ALIGNMENT
        return Buffer(memoryview(data), address, place)

    def free(self, buffer: Buffer) -> None:
        """Give a table's own buffer back."""
        self.used -= len(buffer.data)

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

"""The memory of table images: each table's own one or two buffers, and the load buffers that tables share.

It replaces cfe_tbl_loadbuff.c. All buffers come from one memory pool of Executive Services. Images never move; only the
choice of the active buffer changes. A buffer in use has an id. cFE frees the id of a single-buffered table's buffer
with the first load, so the buffer is no longer protected by a lock and cannot be dumped.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Protocol

from cfepy.fs import calculate_crc
from cfepy.ids import SERIAL_MAX, TBL_LOADBUFFID_BASE, UNDEFINED, get_serial, make
from cfepy.ports import Block, Ports

_FIRST_ADDRESS = 0x10000
_ALIGNMENT = 8
_PER_TABLE = 2
SHARED = 0
"""The category of the ids of shared buffers; a table's own buffers have its slot in the registry plus 1."""

Bytes = bytes | bytearray | memoryview


class BufferPlaces(Protocol):
    """Provides images with memory outside the pool, which still accounts for them."""

    def take(self, size: int, name: str) -> memoryview:
        """Return zeroed memory for an image of `size` bytes; `name` is the table's full name, empty for a shared
        buffer.
        """

    def give(self, data: memoryview) -> None:
        """Take back the memory of a released buffer; it may still be referenced."""


class Buffer:
    """An image (CFE_TBL_LoadBuff_t).

    Attributes:
        data: all of its memory, which may be larger than the content; empty before an app has provided its own.
        is_external: whether it is memory of an app, which is not written to.
        content_size: number of bytes stored in it; a partial load ends with its last byte.
        address: a number for telemetry, not a real address.
        block: its block in the pool; None for memory of an app.
        load_id: its id; 0 if it is free.
        source: the source of the image, for LastFileLoaded.
        file_time: (seconds, subseconds) of its file.
        crc: CRC-16 of the content at load time.
        read: returns the content of compiled code's memory, which may disappear; None for other memory.
        is_valid: whether the image has passed its validation.
        activate_requested: whether the owner may switch to it.
    """

    __slots__ = (
        "activate_requested",
        "address",
        "block",
        "content_size",
        "crc",
        "data",
        "file_time",
        "is_external",
        "is_valid",
        "load_id",
        "read",
        "source",
    )

    def __init__(self, data: memoryview, address: int, block: Block | None = None) -> None:
        self.data = data
        self.block = block
        self.is_external = block is None
        self.address = address
        self.load_id = UNDEFINED
        self.read: Callable[[], bytes] | None = None
        self.content_size = 0
        self.source = ""
        self.file_time = (0, 0)
        self.crc = 0
        self.is_valid = False
        self.activate_requested = False

    def view(self) -> memoryview:
        """Return the content, writable in place."""
        return self.data[: self.content_size] if self.read is None else memoryview(self.read())

    def copy(self, image: Bytes) -> None:
        """Replace the content, unless it does not fit (CFE_TBL_LoadBuffCopyData)."""
        if self.is_external or len(image) > len(self.data):
            return
        self.data[: len(image)] = image
        self.content_size = len(image)
        self.crc = 0

    def refer_to(self, memory: memoryview, address: int, read: Callable[[], bytes] | None = None) -> None:
        """Refer to the memory of an app (CFE_TBL_LoadBuffSetExternalBlock)."""
        self.data, self.address, self.content_size, self.crc = memory, address, len(memory), 0
        self.read = read

    def leave(self) -> None:
        """Copy the memory, which is about to disappear."""
        self.data = memoryview(bytearray(self.data if self.read is None else self.read()))
        self.read = None

    def clear(self) -> None:
        """Overwrite the memory with zeros, without any content afterwards (CFE_TBL_LoadBuffClearData)."""
        if not self.is_external:
            self.data[:] = bytes(len(self.data))
        self.content_size = self.crc = 0

    def recompute_crc(self) -> None:
        """Update the CRC to the present content."""
        self.crc = calculate_crc(self.view())


class BufferIds:
    """The ids of buffers: serial numbers cycle through all shared buffers, then through two for each slot of the
    registry.

    Args:
        shared: number of load buffers shared by the tables.
        tables: number of slots in the registry.
    """

    def __init__(self, shared: int, tables: int) -> None:
        self._shared = shared
        self._total = shared + tables * _PER_TABLE

    def split(self, buffer_id: int) -> tuple[int, int]:
        """Return the category and number of the buffer with an id (CFE_TBL_LoadBuffSerialDecompose)."""
        return self._split(get_serial(buffer_id))

    def _split(self, serial: int) -> tuple[int, int]:
        number = serial % self._total
        if number < self._shared:
            return SHARED, number
        category, number = divmod(number - self._shared, _PER_TABLE)
        return category + 1, number

    def after(self, buffer_id: int, category: int) -> int:
        """Return the next id of a category after another id (CFE_TBL_LoadBuffIncrementSerial_Impl)."""
        serial = get_serial(buffer_id) + 1
        actual, number = self._split(serial)
        if actual != category:
            serial += -serial % self._total  # the next cycle
            serial += number if category == SHARED else self._shared + (category - 1) * _PER_TABLE + number
        return make(TBL_LOADBUFFID_BASE, serial % self._total if serial >= SERIAL_MAX else serial)

    def place(self, buffer_id: int) -> int:
        """Return the number of a buffer in a registry dump: -1 for none, the number of a shared one, -3 and -2 for a
        table's own.
        """
        if buffer_id == UNDEFINED:
            return -1
        category, number = self.split(buffer_id)
        return number if category == SHARED else number - 3


class BufferMemory:
    """The table buffer pool, and the shared buffers from it.

    Args:
        ports: provides Executive Services, which have the pool.
        size: bytes of the pool (CFE_PLATFORM_TBL_BUF_MEMORY_BYTES).
        shared: number of load buffers shared by the tables (CFE_PLATFORM_TBL_MAX_SIMULTANEOUS_LOADS).
        shared_size: bytes of each (CFE_PLATFORM_TBL_MAX_SNGL_TABLE_SIZE).
        tables: maximum number of tables.

    Attributes:
        pool_id: the pool's handle.
        ids: the ids of buffers.
        places: the provider of memory for new images; None for the pool's own memory.
    """

    def __init__(self, ports: Ports, size: int, shared: int, shared_size: int, tables: int) -> None:
        self._ports = ports
        self._size = size
        self._count = shared
        self._shared_size = shared_size
        self._next_address = _FIRST_ADDRESS
        self._shared: list[Buffer] = []
        self._last_id = make(TBL_LOADBUFFID_BASE, 0)
        self.ids = BufferIds(shared, tables)
        self.pool_id = 0
        self.places: BufferPlaces | None = None

    def early_init(self) -> None:
        """Create the pool and allocate the shared buffers from it.

        Raises:
            CfeError: if there is no room for them.
        """
        self.pool_id = self._ports.es.pool_create(self._size, "CFE_TBL")
        self._shared = [self.allocate(self._shared_size) for _ in range(self._count)]

    def __iter__(self) -> Iterator[Buffer]:
        """Iterate over the shared buffers."""
        return iter(self._shared)

    @property
    def free_shared(self) -> int:
        """The number of free shared buffers."""
        return sum(buffer.load_id == UNDEFINED for buffer in self._shared)

    def shared(self, number: int) -> Buffer:
        """Return a shared buffer by its number."""
        return self._shared[number]

    def allocate(self, size: int, name: str = "") -> Buffer:
        """Return a zeroed buffer of `size` bytes, for the table with a full name, or a shared one.

        Raises:
            CfeError: CFE_ES_ERR_MEM_BLOCK_SIZE if the pool has no room for it.
        """
        block = self._ports.es.get_pool_buf(self.pool_id, size)
        data = block.memory if self.places is None else self.places.take(size, name)
        return Buffer(data, self.address_for(size), block)

    def external(self) -> Buffer:
        """Return a buffer for memory that stays with an app (CFE_TBL_OPT_USR_DEF_ADDR); it uses no pool memory."""
        return Buffer(memoryview(b""), 0)

    def free(self, buffer: Buffer) -> None:
        """Release a table's own buffer."""
        buffer.load_id = UNDEFINED
        if buffer.block is not None:
            if self.places is not None:
                self.places.give(buffer.data)
            self._ports.es.put_pool_buf(self.pool_id, buffer.block)

    def acquire_shared(self) -> Buffer | None:
        """Acquire the next free shared buffer; return None if all are in use (CFE_TBL_AcquireGlobalLoadBuff)."""
        candidate = self._last_id
        for _ in self._shared:
            candidate = self.ids.after(candidate, SHARED)
            buffer = self._shared[self.ids.split(candidate)[1]]
            if buffer.load_id == UNDEFINED:
                buffer.load_id = self._last_id = candidate
                return buffer
        return None

    def address_for(self, size: int) -> int:
        """Return a unique number as the address for telemetry."""
        address = self._next_address
        self._next_address += size + -size % _ALIGNMENT
        return address

"""Pools (cfe_es_generic_pool.c): blocks of a few sizes from one block of memory, for memory pools and for the CDS.

A descriptor of 24 bytes with C's layout precedes each block in the same memory. A write past the end of a block is
detected when the next block is returned. Returned blocks are kept for reuse. They are never split or joined.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from mmap import ACCESS_COPY, mmap

from cfepy.status import (
    CFE_ES_BAD_ARGUMENT,
    CFE_ES_BUFFER_NOT_IN_POOL,
    CFE_ES_ERR_MEM_BLOCK_SIZE,
    CFE_ES_POOL_BLOCK_INVALID,
    CfeError,
)

BUCKETS = (8, 16, 32, 48, 64, 96, 128, 160, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768, 80000)
"""CFE_PLATFORM_ES_MEM_BLOCK_SIZE_01 to _17, which are the same for the CDS."""

MAX_BUCKETS = 17
ALIGNMENT = 16  # of CFE_ES_PoolAlign_t, which contains a long double
MIN_ALIGNMENT = 4
DESCRIPTOR = struct.Struct("<HH4xQQ")
"""CFE_ES_GenPoolBD_t: check pattern, state and bucket, requested size, next free block."""

_CHECK = 0x5A5A
_IN_USE = 0xAAAA
_FREE = 0xDDDD
_ULONG_MAX = (1 << 64) - 1

Read = Callable[[int, int], bytes]
Write = Callable[[int, bytes], object]
Log = Callable[[str], object]


@dataclass(frozen=True, slots=True)
class ForeignMemory:
    """Memory of compiled code. It may disappear while a pool is in it, so functions access it, and they fail then.

    Attributes:
        address: its address.
        view: its bytes, which are not read.
        read, write: the functions of a pool, with offsets.
    """

    address: int
    view: memoryview
    read: Read
    write: Write


PoolMemory = bytearray | memoryview | mmap | ForeignMemory
"""A writable buffer that a caller may pass as the bytes of a pool."""


class Bucket:
    """The blocks of one size, with the numbers of created, released and recycled blocks.

    `first` is the first free block. Descriptors store the bucket's `number`, which is 1 for the largest blocks.
    """

    __slots__ = ("created", "first", "number", "recycled", "released", "size")

    def __init__(self, size: int, number: int) -> None:
        self.size = size
        self.number = number
        self.first = self.created = self.released = self.recycled = 0


class GenericPool:
    """The arithmetic of a pool; offsets count from the start of the memory.

    Args:
        read: returns bytes of the memory: (offset, size).
        write: writes bytes to the memory: (offset, bytes).
        log: the system log.
        start: offset of the pool.
        size: its size in bytes.
        alignment: alignment of blocks, a power of 2.
        sizes: block sizes, in any order.

    Raises:
        CfeError: CFE_ES_BAD_ARGUMENT (no sizes, alignment), CFE_ES_ERR_MEM_BLOCK_SIZE (a size of 0).
    """

    def __init__(
        self, read: Read, write: Write, log: Log, *, start: int, size: int, alignment: int, sizes: Sequence[int]
    ) -> None:
        if not sizes:
            log("CFE_ES_GenPoolInitialize: cannot create pool with 0 block sizes")
            raise CfeError(CFE_ES_BAD_ARGUMENT, "a pool requires block sizes")
        if alignment < 1 or alignment & (alignment - 1):
            log(f"CFE_ES_GenPoolInitialize: invalid alignment for pool: {alignment}")
            raise CfeError(CFE_ES_BAD_ARGUMENT, f"the alignment of a pool must be a power of 2, not {alignment}")
        if min(sizes) <= 0:
            raise CfeError(CFE_ES_ERR_MEM_BLOCK_SIZE, f"invalid block size: {min(sizes)} bytes")
        self.size = size
        self.end = start + size
        self.tail = start
        self.created = 0
        self.check_errors = 0
        self.buckets = [Bucket(each, len(sizes) - index) for index, each in enumerate(sorted(sizes))]
        self._read, self._write, self._log = read, write, log
        self._mask = alignment - 1

    @property
    def alignment(self) -> int:
        """The alignment of blocks, in bytes."""
        return self._mask + 1

    @property
    def free_bytes(self) -> int:
        """The bytes that were never part of a block."""
        return self.end - self.tail

    def get(self, size: int) -> int:
        """Take a block; return the offset of its first byte (CFE_ES_GenPoolGetBlock).

        Size 0 gives one of the smallest blocks, which cannot be returned, as in NASA's code.

        Raises:
            CfeError: CFE_ES_ERR_MEM_BLOCK_SIZE if the size exceeds the largest block or no room is left.
        """
        bucket = self._bucket_for(size)
        if bucket is None:
            largest = self.buckets[-1].size
            self._log(f"CFE_ES_GenPoolGetBlock: Err:size({size}) > max({largest})")
            raise CfeError(
                CFE_ES_ERR_MEM_BLOCK_SIZE, f"a block of {size} bytes is larger than the largest block size, {largest}"
            )
        return self._recycle(bucket, size) or self._create(bucket, size)

    def room_of(self, size: int) -> int:
        """Return the bytes of memory for a block of `size` bytes, or 0 if there is no such block.

        These are the next larger block size, its descriptor and the alignment.
        """
        bucket = self._bucket_for(size)
        return 0 if bucket is None else bucket.size + DESCRIPTOR.size + self._mask & ~self._mask

    def put(self, offset: int) -> int:
        """Return a block to the pool; return its requested size (CFE_ES_GenPoolPutBlock).

        Raises:
            CfeError: CFE_ES_BUFFER_NOT_IN_POOL, CFE_ES_POOL_BLOCK_INVALID (already returned, or overwritten).
        """
        try:
            size = self.size_of(offset)
        except CfeError as error:
            self.check_errors += error.status == CFE_ES_POOL_BLOCK_INVALID
            raise
        self._release(offset, size)
        return size

    def size_of(self, offset: int) -> int:
        """Return the requested size of a block (CFE_ES_GenPoolGetBlockSize).

        Raises:
            CfeError: CFE_ES_BUFFER_NOT_IN_POOL, CFE_ES_POOL_BLOCK_INVALID.
        """
        if not DESCRIPTOR.size <= offset < self.tail:
            raise CfeError(CFE_ES_BUFFER_NOT_IN_POOL, f"offset {offset} is outside the pool's blocks")
        raw = self._read(offset - DESCRIPTOR.size, DESCRIPTOR.size)
        size: int = DESCRIPTOR.unpack(raw)[2]
        bucket = self._bucket_for(size)
        if not size or bucket is None or raw != self._describe(_IN_USE, bucket, size):
            raise CfeError(CFE_ES_POOL_BLOCK_INVALID, f"no block in use begins at offset {offset}")
        return size

    def rebuild(self) -> dict[int, int]:
        """Find the blocks in the memory from before a reset (CFE_ES_GenPoolRebuild).

        Returns:
            The sizes of the blocks in use, by offset. The search ends at the first bytes that are not a descriptor.
        """
        found: dict[int, int] = {}
        while (offset := self._next_block()) <= self.end:
            check, state, size, _ = DESCRIPTOR.unpack(self._read(offset - DESCRIPTOR.size, DESCRIPTOR.size))
            bucket = self._bucket_for(size)
            if check != _CHECK or bucket is None or state - bucket.number not in (_IN_USE, _FREE):
                break
            self._count_new(bucket, offset)
            if state - bucket.number == _FREE:
                self._release(offset, size)
            else:
                found[offset] = size
        return found

    def block_stats(self) -> list[dict[str, int]]:
        """Return the fields of CFE_ES_BlockStats_t, the smallest blocks first, with zeros up to 17 sizes."""
        rows = [
            {"BlockSize": each.size, "NumCreated": each.created, "NumFree": each.released - each.recycled}
            for each in self.buckets
        ]
        return rows + [dict.fromkeys(("BlockSize", "NumCreated", "NumFree"), 0)] * (MAX_BUCKETS - len(rows))

    def _bucket_for(self, size: int) -> Bucket | None:
        return next((bucket for bucket in self.buckets if 0 <= size <= bucket.size), None)

    def _describe(self, state: int, bucket: Bucket, size: int, following: int = 0) -> bytes:
        return DESCRIPTOR.pack(_CHECK, state + bucket.number, size, following)

    def _mark(self, offset: int, state: int, bucket: Bucket, size: int, following: int = 0) -> None:
        self._write(offset - DESCRIPTOR.size, self._describe(state, bucket, size, following))

    def _next_block(self) -> int:
        return self.tail + DESCRIPTOR.size + self._mask & ~self._mask

    def _count_new(self, bucket: Bucket, offset: int) -> None:
        self.tail = offset + bucket.size
        bucket.created += 1
        self.created += 1

    def _recycle(self, bucket: Bucket, size: int) -> int:
        """Return the first free block; 0 if there is none, or its descriptor was overwritten."""
        offset = bucket.first
        if offset == 0:
            return 0
        check, state, _, following = DESCRIPTOR.unpack(self._read(offset - DESCRIPTOR.size, DESCRIPTOR.size))
        if check != _CHECK or state != _FREE + bucket.number:
            return 0
        self._mark(offset, _IN_USE, bucket, size)
        bucket.first = following
        bucket.recycled += 1
        return offset

    def _create(self, bucket: Bucket, size: int) -> int:
        offset = self._next_block()
        if offset + bucket.size > self.end:
            text = f"{bucket.size} bytes and a descriptor are needed, {self.free_bytes} of {self.size} are left"
            raise CfeError(CFE_ES_ERR_MEM_BLOCK_SIZE, text)
        self._mark(offset, _IN_USE, bucket, size)
        self._count_new(bucket, offset)
        return offset

    def _release(self, offset: int, size: int) -> None:
        bucket = self._bucket_for(size)
        assert bucket is not None  # every caller took the size from a valid descriptor
        self._mark(offset, _FREE, bucket, size, bucket.first)
        bucket.first = offset
        bucket.released += 1


def min_size(sizes: Sequence[int], blocks: int) -> int:
    """Return the minimum bytes for a number of the smallest blocks (CFE_ES_GenPoolCalcMinSize)."""
    return blocks * (min(sizes, default=0) + DESCRIPTOR.size)


def fresh_memory(size: int) -> memoryview:
    """Return zeroed memory that takes no room in the computer before it is written; a pool may have 256 MiB."""
    return memoryview(mmap(-1, size, access=ACCESS_COPY))


def _writable(memory: bytearray | memoryview | mmap, size: int) -> memoryview:
    try:
        view = memoryview(memory).cast("B")
    except TypeError as error:  # not a buffer, or one with gaps
        raise CfeError(CFE_ES_BAD_ARGUMENT, f"the memory of a pool: {error}") from error
    if view.readonly or len(view) < size:
        text = f"a pool of {size} bytes cannot be in {len(view)} {'read-only ' if view.readonly else ''}bytes"
        raise CfeError(CFE_ES_BAD_ARGUMENT, text)
    return view[:size]


@dataclass(slots=True, eq=False)
class PoolBlock:
    """A block of a memory pool. `memory` has its bytes in the requested size, and `offset` is their place."""

    pool: MemPool
    memory: memoryview
    offset: int

    @property
    def address(self) -> int:
        """The address to show: an address of C, or otherwise the offset."""
        return self.pool.address + self.offset & _ULONG_MAX


class MemPool:
    """A memory pool of an application.

    Args:
        name: name for error texts.
        size: bytes.
        sizes: block sizes in bytes.
        alignment: alignment of blocks in bytes.
        log: the system log.
        memory: a buffer of the caller for the pool, as in C; its first `size` bytes are used unchanged. None allocates
            zeroed bytes.

    Attributes:
        memory: the bytes of the pool.
        address: their address in C; 0 for memory of Python.

    Raises:
        CfeError: see `GenericPool`; CFE_ES_BAD_ARGUMENT for memory that cannot be written or is too small.
    """

    def __init__(
        self,
        name: str,
        size: int,
        sizes: Sequence[int] = BUCKETS,
        alignment: int = ALIGNMENT,
        log: Log = lambda text: None,
        memory: PoolMemory | None = None,
    ) -> None:
        self.name = name
        self.mutex_id = 0
        if isinstance(memory, ForeignMemory):
            self.address, self.memory = memory.address, memory.view
            self._read, self._write = memory.read, memory.write
        else:
            self.address = 0
            self.memory = fresh_memory(size) if memory is None else _writable(memory, size)
            self._read, self._write = self._read_own, self._write_own
        self.blocks = GenericPool(
            self._read, self._write, log, start=0, size=size, alignment=max(alignment, MIN_ALIGNMENT), sizes=sizes
        )

    def _read_own(self, offset: int, size: int) -> bytes:
        return bytes(self.memory[offset : offset + size])

    def _write_own(self, offset: int, data: bytes) -> None:
        self.memory[offset : offset + len(data)] = data

    def get(self, size: int) -> PoolBlock:
        """Take a block. Its bytes are zero in Python's memory and unchanged in memory of C. See `GenericPool.get` for
        the errors.
        """
        offset = self.blocks.get(size)
        if not self.address:
            self._write(offset, bytes(size))
        return PoolBlock(self, self.memory[offset : offset + size], offset)

    def block_at(self, offset: int) -> PoolBlock:
        """Return a block at an offset given by the caller, because C identifies blocks by their addresses."""
        return PoolBlock(self, self.memory[:0], offset)

    def put(self, block: PoolBlock) -> int:
        """Return a block to the pool; return its size in bytes. See `GenericPool.put` for the errors."""
        return self.blocks.put(self._offset(block))

    def size_of(self, block: PoolBlock) -> int:
        """Return the size of a block in use, in bytes. See `GenericPool.size_of` for the errors."""
        return self.blocks.size_of(self._offset(block))

    def _offset(self, block: PoolBlock) -> int:
        if block.pool is not self:
            raise CfeError(CFE_ES_BUFFER_NOT_IN_POOL, f"the block at {block.offset} is not in pool {self.name}")
        return block.offset

    def statistics(self) -> dict[str, object]:
        """Return the fields of CFE_ES_MemPoolStats_t."""
        blocks = self.blocks
        return {
            "PoolSize": blocks.size,
            "NumBlocksRequested": blocks.created,
            "CheckErrCtr": blocks.check_errors,
            "NumFreeBytes": blocks.free_bytes,
            "BlockStats": blocks.block_stats(),
        }

"""Pools (cfe_es_generic_pool.c): blocks of a few sizes out of one stretch of memory, for memory pools and for the CDS.

In front of each block stands a descriptor of 24 bytes, with C's layout, in the same memory: a block that was written
past is found when the next one is given back. Blocks given back are kept for reuse, never split or joined.
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
"""CFE_PLATFORM_ES_MEM_BLOCK_SIZE_01 to _17; those of the CDS are the same."""

MAX_BUCKETS = 17
ALIGNMENT = 16  # of CFE_ES_PoolAlign_t, which has a long double in it
MIN_ALIGNMENT = 4
DESCRIPTOR = struct.Struct("<HH4xQQ")
"""CFE_ES_GenPoolBD_t: check pattern, state and bucket, size that was asked for, next free block."""

_CHECK = 0x5A5A
_IN_USE = 0xAAAA
_FREE = 0xDDDD
_ULONG_MAX = (1 << 64) - 1

Read = Callable[[int, int], bytes]
Write = Callable[[int, bytes], object]
Log = Callable[[str], object]


@dataclass(frozen=True, slots=True)
class ForeignMemory:
    """Memory of compiled code: it may go while there is a pool in it, so it is reached by functions that fail then.

    Attributes:
        address: where it is.
        view: its bytes, which are not looked at.
        read, write: as those of a pool, with offsets.
    """

    address: int
    view: memoryview
    read: Read
    write: Write


PoolMemory = bytearray | memoryview | mmap | ForeignMemory
"""What a caller may bring as the bytes of a pool: anything writable."""


class Bucket:
    """The blocks of one size: how many were made, given back and taken again.

    `first` is the free one on top; descriptors know the bucket by its `number`, 1 for the largest blocks.
    """

    __slots__ = ("created", "first", "number", "recycled", "released", "size")

    def __init__(self, size: int, number: int) -> None:
        self.size = size
        self.number = number
        self.first = self.created = self.released = self.recycled = 0


class GenericPool:
    """The arithmetic of a pool; offsets count from the start of the memory.

    Args:
        read: bytes of the memory: (offset, size).
        write: the reverse: (offset, bytes).
        log: the system log.
        start: where the pool begins.
        size: its bytes.
        alignment: of blocks, a power of 2.
        sizes: of blocks, in any order.

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
        """Of blocks, in bytes."""
        return self._mask + 1

    @property
    def free_bytes(self) -> int:
        """Bytes that were never part of a block."""
        return self.end - self.tail

    def get(self, size: int) -> int:
        """Take a block; the offset of its first byte (CFE_ES_GenPoolGetBlock).

        Of size 0 it is one of the smallest, and as in NASA's code it can never be given back.

        Raises:
            CfeError: CFE_ES_ERR_MEM_BLOCK_SIZE: larger than the largest block, or no room left.
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
        """Bytes of the memory that a block of `size` bytes takes: the next size that there is, its descriptor, and what
        the alignment takes; 0 if there is no such block."""
        bucket = self._bucket_for(size)
        return 0 if bucket is None else bucket.size + DESCRIPTOR.size + self._mask & ~self._mask

    def put(self, offset: int) -> int:
        """Give a block back; the size that was asked for (CFE_ES_GenPoolPutBlock).

        Raises:
            CfeError: CFE_ES_BUFFER_NOT_IN_POOL, CFE_ES_POOL_BLOCK_INVALID (given back already, or overwritten).
        """
        try:
            size = self.size_of(offset)
        except CfeError as error:
            self.check_errors += error.status == CFE_ES_POOL_BLOCK_INVALID
            raise
        self._release(offset, size)
        return size

    def size_of(self, offset: int) -> int:
        """The size that was asked for when a block was taken (CFE_ES_GenPoolGetBlockSize).

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
        """Find the blocks that the memory holds from before a reset (CFE_ES_GenPoolRebuild).

        Returns:
            Offset to size of those in use. The search ends at the first bytes that are no descriptor.
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
        """The fields of CFE_ES_BlockStats_t, smallest blocks first, zeros where there are fewer than 17 sizes."""
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
        """The block on top of those given back; 0 when there is none, or its descriptor was overwritten."""
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
        assert bucket is not None  # every caller took the size from a descriptor that was found good
        self._mark(offset, _FREE, bucket, size, bucket.first)
        bucket.first = offset
        bucket.released += 1


def min_size(sizes: Sequence[int], blocks: int) -> int:
    """The least bytes that a number of the smallest blocks take (CFE_ES_GenPoolCalcMinSize)."""
    return blocks * (min(sizes, default=0) + DESCRIPTOR.size)


def fresh_memory(size: int) -> memoryview:
    """Zeros that take no room in the computer's memory before they are written: a pool may be 256 MiB."""
    return memoryview(mmap(-1, size, access=ACCESS_COPY))


def _writable(memory: bytearray | memoryview | mmap, size: int) -> memoryview:
    try:
        view = memoryview(memory).cast("B")
    except TypeError as error:  # no buffer, or one with gaps
        raise CfeError(CFE_ES_BAD_ARGUMENT, f"the memory of a pool: {error}") from error
    if view.readonly or len(view) < size:
        text = f"a pool of {size} bytes cannot be in {len(view)} {'read-only ' if view.readonly else ''}bytes"
        raise CfeError(CFE_ES_BAD_ARGUMENT, text)
    return view[:size]


@dataclass(slots=True, eq=False)
class PoolBlock:
    """A block of a memory pool: `memory` is its bytes, as many as were asked for; `offset` is where they are."""

    pool: MemPool
    memory: memoryview
    offset: int

    @property
    def address(self) -> int:
        """Where it is for a person: an address of C's, or else the offset."""
        return self.pool.address + self.offset & _ULONG_MAX


class MemPool:
    """A memory pool of an application.

    Args:
        name: for error texts.
        size: bytes.
        sizes: of blocks.
        alignment: of blocks, in bytes.
        log: the system log.
        memory: the bytes of the pool, which the caller keeps and may look at, as in C; the first `size` of them are
            used, as they are. None makes new ones, of zeros.

    Attributes:
        memory: the bytes of the pool.
        address: where C has them; 0 for memory of Python.

    Raises:
        CfeError: as `GenericPool`; CFE_ES_BAD_ARGUMENT for memory that cannot be written or is too small.
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
        """Take a block; its bytes are zero, but as they were before in memory of C. Errors as `GenericPool.get`."""
        offset = self.blocks.get(size)
        if not self.address:
            self._write(offset, bytes(size))
        return PoolBlock(self, self.memory[offset : offset + size], offset)

    def block_at(self, offset: int) -> PoolBlock:
        """What somebody says is a block, to be given back or looked at: C knows blocks by their addresses."""
        return PoolBlock(self, self.memory[:0], offset)

    def put(self, block: PoolBlock) -> int:
        """Give a block back; its size in bytes. Errors as `GenericPool.put`."""
        return self.blocks.put(self._offset(block))

    def size_of(self, block: PoolBlock) -> int:
        """Size in bytes of a block in use. Errors as `GenericPool.size_of`."""
        return self.blocks.size_of(self._offset(block))

    def _offset(self, block: PoolBlock) -> int:
        if block.pool is not self:
            raise CfeError(CFE_ES_BUFFER_NOT_IN_POOL, f"the block at {block.offset} is not in pool {self.name}")
        return block.offset

    def statistics(self) -> dict[str, object]:
        """The fields of CFE_ES_MemPoolStats_t."""
        blocks = self.blocks
        return {
            "PoolSize": blocks.size,
            "NumBlocksRequested": blocks.created,
            "CheckErrCtr": blocks.check_errors,
            "NumFreeBytes": blocks.free_bytes,
            "BlockStats": blocks.block_stats(),
        }

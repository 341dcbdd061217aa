"""Memory pools (cfe_es_generic_pool.c, CFE_ES_Pool*): blocks of a few sizes out of a piece of memory of fixed size.

A block's bytes are a bytearray of their own; what is modelled is the arithmetic that makes a pool run out: bucket
sizes, the descriptor in front of each block, and blocks that are kept for reuse but never split or joined.
"""

from __future__ import annotations

from dataclasses import dataclass

from cfepy.status import (
    CFE_ES_BUFFER_NOT_IN_POOL,
    CFE_ES_ERR_MEM_BLOCK_SIZE,
    CFE_ES_POOL_BLOCK_INVALID,
    CfeError,
)

BUCKETS = (8, 16, 32, 48, 64, 96, 128, 160, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768, 80000)
DESCRIPTOR_BYTES = 24  # CFE_ES_GenPoolBD_t on a 64-bit build


@dataclass(slots=True, eq=False)
class PoolBlock:
    """A block of a pool; `memory` has the size that was asked for, `bucket` is what it takes, `offset` where it is."""

    memory: bytearray
    bucket: int
    offset: int
    in_use: bool = True


class MemPool:
    """A pool of `size` bytes."""

    def __init__(self, name: str, size: int) -> None:
        self.name = name
        self.size = size
        self.next_offset = 0
        self.requests = 0
        self.check_errors = 0
        self.blocks: dict[int, PoolBlock] = {}
        self._free: dict[int, list[PoolBlock]] = {bucket: [] for bucket in BUCKETS}

    def get(self, size: int) -> PoolBlock:
        """Take a block (CFE_ES_GetPoolBuf).

        Raises:
            CfeError: CFE_ES_ERR_MEM_BLOCK_SIZE: larger than the largest block, or the pool has no room left.
        """
        bucket = next((each for each in BUCKETS if each >= size), None)
        if bucket is None or size <= 0:
            raise CfeError(CFE_ES_ERR_MEM_BLOCK_SIZE, f"pool {self.name}: no block of {size} bytes, 1 to {BUCKETS[-1]}")
        self.requests += 1
        if self._free[bucket]:
            block = self._free[bucket].pop()
            block.memory = bytearray(size)
            block.in_use = True
            return block
        needed = bucket + DESCRIPTOR_BYTES
        if self.next_offset + needed > self.size:
            free = self.size - self.next_offset
            raise CfeError(
                CFE_ES_ERR_MEM_BLOCK_SIZE, f"pool {self.name}: {needed} bytes needed, {free} of {self.size} left"
            )
        block = PoolBlock(bytearray(size), bucket, self.next_offset + DESCRIPTOR_BYTES)
        self.next_offset += needed
        self.blocks[block.offset] = block
        return block

    def put(self, block: PoolBlock) -> int:
        """Give a block back (CFE_ES_PutPoolBuf); its size in bytes.

        Raises:
            CfeError: CFE_ES_BUFFER_NOT_IN_POOL (another pool's), CFE_ES_POOL_BLOCK_INVALID (given back already).
        """
        if self.blocks.get(block.offset) is not block:
            self.check_errors += 1
            raise CfeError(CFE_ES_BUFFER_NOT_IN_POOL, f"the block is not of pool {self.name}")
        if not block.in_use:
            self.check_errors += 1
            raise CfeError(CFE_ES_POOL_BLOCK_INVALID, f"the block of pool {self.name} was given back before")
        block.in_use = False
        self._free[block.bucket].append(block)
        return len(block.memory)

    def statistics(self) -> dict[str, object]:
        """The fields of CFE_ES_MemPoolStats_t."""
        free = {bucket: len(blocks) for bucket, blocks in self._free.items()}
        created = dict.fromkeys(BUCKETS, 0)
        for block in self.blocks.values():
            created[block.bucket] += 1
        return {
            "PoolSize": self.size,
            "NumBlocksRequested": self.requests,
            "CheckErrCtr": self.check_errors,
            "NumFreeBytes": self.size - self.next_offset,
            "BlockStats": [
                {"BlockSize": bucket, "NumCreated": created[bucket], "NumFree": free[bucket]}
                for bucket in reversed(BUCKETS)
            ],
        }

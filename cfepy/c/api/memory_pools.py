"""CFE_ES_Pool*, CFE_ES_*PoolBuf*: memory pools for C. The bytes of a pool are the caller's, as in C."""

from __future__ import annotations

import struct
from functools import partial
from typing import TYPE_CHECKING, Any

from cfepy.c.api.pointers import need
from cfepy.config import ES_MEM_BLOCK_SIZES
from cfepy.es import MAX_BUCKETS, ForeignMemory, MemPool, PoolBlock, min_size
from cfepy.status import CFE_ES_BAD_ARGUMENT, CFE_ES_NO_RESOURCE_IDS_AVAILABLE, CfeError

if TYPE_CHECKING:
    from cfepy.c.calls import Declarations
    from cfepy.c.runtime import CRuntime

BAD = CFE_ES_BAD_ARGUMENT
ALIGNMENT = 16
"""Of CFE_ES_PoolAlign_t, the largest of pointer, long long, double and long double, on x86-64 and aarch64."""
DEFAULT_SIZES = ES_MEM_BLOCK_SIZES[::-1]
"""As the configuration registry has them: the largest first."""
MOST = 1 << 40
"""Bytes of the view of a pool: no pool is larger, whatever somebody says."""
POOL_STATS = struct.Struct("<QIIQ")
"""The head of CFE_ES_MemPoolStats_t; then there are 17 of these: size, created, free."""
POOL_FIELDS = ("PoolSize", "NumBlocksRequested", "CheckErrCtr", "NumFreeBytes")
BLOCK_STATS = struct.Struct("<QII")


def declare(api: Declarations, c: CRuntime) -> None:
    """Add the functions; see `cfepy.c.api`."""
    _declare_pools(api, c)
    _declare_blocks(api, c)


def _declare_pools(api: Declarations, c: CRuntime) -> None:
    es, memory = c.handle.es, c.memory

    def create(
        pool: int, at: int, size: int, sizes: tuple[int, ...], use_mutex: bool, alignment: int = ALIGNMENT
    ) -> None:
        brought = ForeignMemory(
            at,
            memory.view(at, min(size, MOST)),
            lambda offset, count: memory.peek(at + offset, count),
            lambda offset, data: memory.poke(at + offset, data),
        )
        try:
            handle = es.pool_create_ex_with_alignment(size, sizes, use_mutex, alignment, memory=brought)
        except CfeError as error:
            is_late = len(sizes) <= MAX_BUCKETS and size >= min_size(sizes, 1)
            if is_late and error.status != CFE_ES_NO_RESOURCE_IDS_AVAILABLE:
                memory.put_u32(pool, 0)
            raise
        memory.put_u32(pool, handle)

    def sizes_at(at: int, count: int) -> tuple[int, ...]:
        if at:
            return struct.unpack(f"<{count}Q", memory.peek(at, 8 * count)) if count <= MAX_BUCKETS else (1,) * count
        count = count or len(DEFAULT_SIZES)
        return DEFAULT_SIZES[:count] if count <= len(DEFAULT_SIZES) else (1,) * count

    def create_ex(
        pool: int, at: int, size: int, count: int, sizes: int, use_mutex: bool, alignment: int = ALIGNMENT
    ) -> None:
        create(pool, at, size, sizes_at(sizes, count), use_mutex, alignment)

    for name, use_mutex in (("CFE_ES_PoolCreate", True), ("CFE_ES_PoolCreateNoSem", False)):
        api.add(name, "PPQ", partial(create, sizes=DEFAULT_SIZES, use_mutex=use_mutex), BAD)
    api.add("CFE_ES_PoolCreateEx", "PPQHpb", create_ex, BAD)
    api.add("CFE_ES_PoolCreateEx_WithAlignment", "PPQHpbQ", create_ex, BAD)
    api.add("CFE_ES_PoolDelete", "I", es.pool_delete)

    def get_stats(at: int, handle: int) -> None:
        stats: dict[str, Any] = es.get_mem_pool_stats(handle)
        raw = [POOL_STATS.pack(*(stats[name] for name in POOL_FIELDS))]
        raw += [BLOCK_STATS.pack(*row.values()) for row in stats["BlockStats"]]
        memory.poke(at, b"".join(raw))

    api.add("CFE_ES_GetMemPoolStats", "PI", get_stats, BAD)


def _declare_blocks(api: Declarations, c: CRuntime) -> None:
    es, pools, memory = c.handle.es, c.cfe.es.pools, c.memory
    no_pool = MemPool("", ALIGNMENT)

    def get_buf(handle: int, size: int) -> tuple[int, int]:
        block = es.get_pool_buf(handle, size)
        return size, memory.address_of(block.memory)

    def block_at(handle: int, at: int) -> PoolBlock:
        """The block that C means by its address; some block where there is no such pool, which is found out later."""
        need(BAD, at)
        pool = pools.find(handle) or no_pool
        return pool.block_at(at - memory.address_of(pool.memory))

    api.add("CFE_ES_GetPoolBuf", "=8IQ", get_buf, BAD)
    api.add("CFE_ES_GetPoolBufInfo", "Ip", lambda handle, at: es.get_pool_buf_info(handle, block_at(handle, at)))
    api.add("CFE_ES_PutPoolBuf", "Ip", lambda handle, at: es.put_pool_buf(handle, block_at(handle, at)))

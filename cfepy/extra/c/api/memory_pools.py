"""CFE_ES_Pool*, CFE_ES_*PoolBuf*: memory pools for C.

The bytes of a pool are the caller's, as in C. With the guard, the pool keeps its records in them, and its blocks are
elsewhere.
"""

from __future__ import annotations

import struct
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

from cfepy.config.platform import ES_MEM_BLOCK_SIZES
from cfepy.es import MAX_BUCKETS, ForeignMemory, MemPool, PoolBlock, min_size
from cfepy.extra.c.api.pointers import need
from cfepy.extra.c.crashes import CFault
from cfepy.extra.c.guard import POISON, Guard
from cfepy.status import CFE_ES_BAD_ARGUMENT, CFE_ES_NO_RESOURCE_IDS_AVAILABLE, CfeError

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

BAD = CFE_ES_BAD_ARGUMENT
ALIGNMENT = 16
"""Alignment of CFE_ES_PoolAlign_t: the largest of pointer, long long, double, long double (x86-64 and aarch64)."""
DEFAULT_SIZES = ES_MEM_BLOCK_SIZES[::-1]
"""In the order of the configuration registry: the largest first."""
MOST = 1 << 40
"""Bytes of the view of a pool: no pool is larger, whatever size the caller gives."""
POOL_STATS = struct.Struct("<QIIQ")
"""The head of CFE_ES_MemPoolStats_t; then there are 17 of these: size, created, free."""
POOL_FIELDS = ("PoolSize", "NumBlocksRequested", "CheckErrCtr", "NumFreeBytes")
BLOCK_STATS = struct.Struct("<QII")


class Lent(NamedTuple):
    """A block that a pool has lent: its offset in the pool, and the address that the application uses."""

    pool: MemPool
    offset: int
    address: int


class GuardedPools:
    """Blocks of pools in pages of their own.

    A pool lends its offsets as usual. Each time, the application gets another address for the block. Addresses are not
    used again, so an address that was given back still identifies its block.

    Args:
        c: the C side of the processor.
        guard: of the processor.
    """

    def __init__(self, c: CRuntime, guard: Guard) -> None:
        self._c = c
        self._guard = guard
        self._lent: dict[tuple[MemPool, int], Lent] = {}
        self._all: dict[int, Lent] = {}
        c.at_app_end.append(self._sweep)

    def lend(self, block: PoolBlock, size: int) -> int:
        """Return an address for a block of `size` bytes that a pool has just lent."""
        owner = self._c.kernel.current.owner
        pool, app = block.pool, "" if owner is None else owner.name
        address = self._guard.take(size, "a pool block", app, pool.blocks.alignment)
        self._c.memory.poke(address, POISON * size)
        self._lent[pool, block.offset] = self._all[address] = Lent(pool, block.offset, address)
        return address

    def in_pool(self, address: int) -> int:
        """Translate an application's address to the address in the pool."""
        near = self._guard.near(address)
        lent = None if near is None else self._all.get(near[0])
        if lent is None:
            return address
        start: int = self._c.memory.address_of(lent.pool.memory)
        return start + lent.offset + address - lent.address

    def refuse_old(self, address: int, function: str) -> None:
        """Refuse the address of a returned block if its place in the pool was lent again.

        Raises:
            CFault: it is such an address; the pool would take it for the new block.
        """
        lent = self._all.get(address)
        now = None if lent is None else self._lent.get((lent.pool, lent.offset))
        if now is not None and now is not lent:
            raise CFault(f"{function}() of 0x{address:x}, a pool block that was already returned and reused")

    def leave(self, block: PoolBlock) -> Lent | None:
        """Begin to give back a block. Pass the result to `gone` or `stay`."""
        return self._lent.pop((block.pool, block.offset), None)

    def stay(self, lent: Lent | None) -> None:
        """Keep a block that the pool did not take back."""
        if lent is not None:
            self._lent[lent.pool, lent.offset] = lent

    def gone(self, lent: Lent | None) -> None:
        """Release a block that the pool has taken back.

        Raises:
            CFault: the application wrote past the block.
        """
        if lent is not None:
            try:
                self._guard.check(lent.address, "CFE_ES_PutPoolBuf()")
            finally:
                self._guard.give(lent.address)

    def forget(self, pool: MemPool | None) -> None:
        """Forget a deleted pool. Its blocks are still the application's memory, which it may use.

        Raises:
            CFault: the application wrote past a block.
        """
        mine = [self._lent.pop(key) for key in list(self._lent) if key[0] is pool]
        for lent in mine:
            self._guard.check(lent.address, "CFE_ES_PoolDelete()")

    def _sweep(self) -> None:
        """Release the blocks of pools that ended with their application."""
        pools = list(self._c.cfe.es.pools)
        for key in [each for each in self._lent if each[0] not in pools]:
            self._guard.give(self._lent.pop(key).address)


def declare(api: Declarations, c: CRuntime) -> None:
    guarded = None if c.guard is None else GuardedPools(c, c.guard)
    _declare_pools(api, c, guarded)
    _declare_blocks(api, c, guarded)


def _declare_pools(api: Declarations, c: CRuntime, guarded: GuardedPools | None) -> None:
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

    def delete(handle: int) -> None:
        pool = c.cfe.es.pools.find(handle)
        es.pool_delete(handle)
        if guarded is not None:
            guarded.forget(pool)

    api.add("CFE_ES_PoolDelete", "I", delete)

    def get_stats(at: int, handle: int) -> None:
        stats: dict[str, Any] = es.get_mem_pool_stats(handle)
        raw = [POOL_STATS.pack(*(stats[name] for name in POOL_FIELDS))]
        raw += [BLOCK_STATS.pack(*row.values()) for row in stats["BlockStats"]]
        memory.poke(at, b"".join(raw))

    api.add("CFE_ES_GetMemPoolStats", "PI", get_stats, BAD)


def _declare_blocks(api: Declarations, c: CRuntime, guarded: GuardedPools | None) -> None:
    es, pools, memory = c.handle.es, c.cfe.es.pools, c.memory
    no_pool = MemPool("", ALIGNMENT)

    def get_buf(handle: int, size: int) -> tuple[int, int]:
        block = es.get_pool_buf(handle, size)
        return size, memory.address_of(block.memory) if guarded is None else guarded.lend(block, size)

    def block_at(handle: int, at: int) -> PoolBlock:
        """Return the block at C's address. Without such a pool, return any block, because a later check refuses it."""
        need(BAD, at)
        pool = pools.find(handle) or no_pool
        place = at if guarded is None else guarded.in_pool(at)
        return pool.block_at(place - memory.address_of(pool.memory))

    def get_info(handle: int, at: int) -> int:
        if guarded is not None:
            guarded.refuse_old(at, "CFE_ES_GetPoolBufInfo")
        return es.get_pool_buf_info(handle, block_at(handle, at))

    def put(handle: int, at: int) -> int:
        block = block_at(handle, at)
        if guarded is None:
            return es.put_pool_buf(handle, block)
        guarded.refuse_old(at, "CFE_ES_PutPoolBuf")
        lent = guarded.leave(block)
        try:
            size = es.put_pool_buf(handle, block)
        except BaseException:
            guarded.stay(lent)
            raise
        guarded.gone(lent)
        return size

    api.add("CFE_ES_GetPoolBuf", "=8IQ", get_buf, BAD)
    api.add("CFE_ES_GetPoolBufInfo", "Ip", get_info)
    api.add("CFE_ES_PutPoolBuf", "Ip", put)

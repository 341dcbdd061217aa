"""Memory pools: NASA's functional tests of them (es_mempool_test.c) and the arithmetic behind."""

from __future__ import annotations

import tracemalloc

import pytest

from cfepy.es.pools import BUCKETS, DESCRIPTOR, ForeignMemory, MemPool
from cfepy.status import (
    CFE_ES_BAD_ARGUMENT,
    CFE_ES_BUFFER_NOT_IN_POOL,
    CFE_ES_ERR_MEM_BLOCK_SIZE,
    CFE_ES_POOL_BLOCK_INVALID,
)
from tests.statuses import status_of


def test_blocks_come_out_until_the_pool_is_full() -> None:
    pool = MemPool("P", 1024)
    block = pool.get(512)
    assert (len(block.memory), block.offset) == (512, 32)
    assert status_of(lambda: pool.get(512)) == CFE_ES_ERR_MEM_BLOCK_SIZE
    assert pool.put(block) == 512
    assert status_of(lambda: pool.get(2048)) == CFE_ES_ERR_MEM_BLOCK_SIZE
    assert pool.get(300).offset == block.offset


def test_statistics_match_c() -> None:
    pool = MemPool("P", 1024)
    first, _ = pool.get(100), pool.get(8)
    pool.put(first)
    pool.get(120)
    pool.put(pool.get(10))
    stats = pool.statistics()
    tail = 32 + 128 + 32 + 8  # descriptors are put so that blocks begin at multiples of 16
    tail = (tail + DESCRIPTOR.size + 15) // 16 * 16 + 16
    assert (stats["PoolSize"], stats["NumFreeBytes"]) == (1024, 1024 - tail)
    assert (stats["NumBlocksRequested"], stats["CheckErrCtr"]) == (3, 0)
    rows = pool.blocks.block_stats()
    assert [row["BlockSize"] for row in rows] == list(BUCKETS)
    assert {row["BlockSize"]: (row["NumCreated"], row["NumFree"]) for row in rows if row["NumCreated"]} == {
        8: (1, 0),
        16: (1, 1),
        128: (1, 0),
    }


def test_sizes_of_ones_own() -> None:
    pool = MemPool("P", 400, sizes=(100, 20), alignment=4)
    assert [pool.get(size).offset for size in (15, 50)] == [24, 68]
    rows = pool.blocks.block_stats()
    assert len(rows) == 17
    assert [row["BlockSize"] for row in rows[:3]] == [20, 100, 0]
    assert status_of(lambda: pool.get(101)) == CFE_ES_ERR_MEM_BLOCK_SIZE


def test_block_of_no_bytes_cannot_be_returned() -> None:
    pool = MemPool("P", 1024)
    block = pool.get(0)
    assert len(block.memory) == 0
    assert status_of(lambda: pool.size_of(block)) == CFE_ES_POOL_BLOCK_INVALID
    assert status_of(lambda: pool.put(block)) == CFE_ES_POOL_BLOCK_INVALID
    assert pool.statistics()["CheckErrCtr"] == 1
    assert pool.blocks.block_stats()[0] == {"BlockSize": 8, "NumCreated": 1, "NumFree": 0}
    assert status_of(lambda: pool.get(-1)) == CFE_ES_ERR_MEM_BLOCK_SIZE


def test_invalid_pool_arguments_are_refused() -> None:
    assert status_of(lambda: MemPool("P", 400, alignment=12)) == CFE_ES_BAD_ARGUMENT
    assert status_of(lambda: MemPool("P", 400, sizes=())) == CFE_ES_BAD_ARGUMENT
    assert status_of(lambda: MemPool("P", 400, sizes=(8, 0))) == CFE_ES_ERR_MEM_BLOCK_SIZE


def test_block_that_is_not_in_use_is_refused() -> None:
    pool, other = MemPool("P", 1024), MemPool("Q", 1024)
    block = pool.get(100)
    assert pool.size_of(block) == 100
    assert status_of(lambda: other.put(block)) == CFE_ES_BUFFER_NOT_IN_POOL
    pool.put(block)
    assert status_of(lambda: pool.put(block)) == CFE_ES_POOL_BLOCK_INVALID
    assert status_of(lambda: pool.size_of(block)) == CFE_ES_POOL_BLOCK_INVALID
    assert pool.statistics()["CheckErrCtr"] == 1


def test_flip_of_a_bit_in_a_descriptor_is_found_outside_its_size() -> None:
    for bit in [*range(8 * 8), *range(16 * 8, DESCRIPTOR.size * 8)]:
        pool = MemPool("P", 1024)
        block = pool.get(100)
        at = block.offset - DESCRIPTOR.size + bit // 8
        damaged = bytes([pool._read(at, 1)[0] ^ 1 << bit % 8])
        pool._write(at, damaged)
        assert status_of(lambda: pool.put(block)) == CFE_ES_POOL_BLOCK_INVALID, f"bit {bit}"  # noqa: B023


def test_a_block_used_again_is_clean() -> None:
    pool = MemPool("P", 1024)
    block = pool.get(8)
    block.memory[:] = b"leftover"
    pool.put(block)
    assert bytes(pool.get(8).memory) == bytes(8)


def test_a_large_pool_takes_no_memory_before_it_is_used() -> None:
    tracemalloc.start()
    try:
        pool = MemPool("P", 64 << 20)
        _, most = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert most < 1 << 20
    block = pool.get(80_000)
    assert bytes(block.memory) == bytes(80_000)


def test_a_pool_on_memory_that_the_caller_brings() -> None:
    memory = bytearray(b"\xaa" * 1100)
    pool = MemPool("P", 1024, memory=memory)
    block = pool.get(100)
    block.memory[:5] = b"hello"
    assert memory[block.offset : block.offset + 5] == b"hello"
    memory[block.offset] = ord("j")
    assert bytes(block.memory[:5]) == b"jello"
    check, _, size, _ = DESCRIPTOR.unpack_from(memory, block.offset - DESCRIPTOR.size)
    assert (check, size) == (0x5A5A, 100)
    assert memory[1024:] == b"\xaa" * 76  # memory behind the pool is not touched
    assert pool.put(block) == 100
    assert pool.get(110).offset == block.offset


def test_views_of_any_item_size_are_counted_in_bytes() -> None:
    memory = memoryview(bytearray(1024)).cast("I")
    pool = MemPool("P", 1024, memory=memory)
    pool.get(4).memory[:] = b"\1\0\0\0"
    assert 1 in memory.tolist()


@pytest.mark.parametrize("memory", [bytes(1024), bytearray(1023), memoryview(bytearray(4096))[::2], "text"])
def test_memory_that_cannot_hold_the_pool(memory: object) -> None:
    assert status_of(lambda: MemPool("P", 1024, memory=memory)) == CFE_ES_BAD_ARGUMENT  # type: ignore[arg-type]


def test_memory_of_c_is_not_cleared_and_blocks_are_found_by_address() -> None:
    memory = bytearray(b"\xaa" * 1024)

    def read(offset: int, size: int) -> bytes:
        return bytes(memory[offset : offset + size])

    def write(offset: int, data: bytes) -> None:
        memory[offset : offset + len(data)] = data

    foreign = ForeignMemory(0x10_8000_0000, memoryview(memory), read, write)
    pool = MemPool("P", 1024, memory=foreign)
    block = pool.get(20)
    assert bytes(block.memory) == b"\xaa" * 20
    assert block.address == 0x10_8000_0000 + block.offset
    assert pool.put(pool.block_at(block.offset)) == 20
    assert status_of(lambda: pool.put(pool.block_at(-8))) == CFE_ES_BUFFER_NOT_IN_POOL

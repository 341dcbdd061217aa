"""Pools and generic counters as applications of a mission use them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from cfepy.app import Cfe
from cfepy.status import (
    CFE_ES_BAD_ARGUMENT,
    CFE_ES_BUFFER_NOT_IN_POOL,
    CFE_ES_ERR_DUPLICATE_NAME,
    CFE_ES_ERR_MEM_BLOCK_SIZE,
    CFE_ES_ERR_NAME_NOT_FOUND,
    CFE_ES_ERR_RESOURCEID_NOT_VALID,
    CFE_ES_NO_RESOURCE_IDS_AVAILABLE,
    CFE_ES_POOL_BLOCK_INVALID,
    OS_ERR_NAME_NOT_FOUND,
)
from tests.es.harness import Lab
from tests.statuses import status_of


@pytest.fixture
def in_app(tmp_path: Path) -> Iterator[Callable[[Callable[[Cfe], Any]], Lab]]:
    """Runs a function as the main function of an application, and fails when it does."""
    labs: list[Lab] = []

    def run(main: Callable[[Cfe], Any]) -> Lab:
        done: list[bool] = []

        def app(cfe: Cfe) -> None:
            main(cfe)
            done.append(True)
            cfe.os.task_delay(10**6)

        labs.append(Lab(tmp_path, one=app))
        labs[0].start("one")
        labs[0].mission.run_for(1)
        assert done, labs[0].log()
        return labs[0]

    yield run
    for lab in labs:
        lab.mission.close()


def test_pool_that_fails_for_its_block_sizes_uses_up_an_id(in_app: Callable[[Callable[[Cfe], Any]], Lab]) -> None:
    """As on NASA's cFE 7.0.1. A pool that is refused before that uses up no id."""

    def main(cfe: Cfe) -> None:
        es = cfe.es
        first = es.pool_create(1024)
        assert status_of(lambda: es.pool_create(0)) == CFE_ES_BAD_ARGUMENT
        assert status_of(lambda: es.pool_create_ex(1024, [16, 0])) == CFE_ES_ERR_MEM_BLOCK_SIZE
        assert es.pool_create(1024) == first + 2

    in_app(main)


def test_pools_of_all_kinds_are_created_or_refused(in_app: Callable[[Callable[[Cfe], Any]], Lab]) -> None:
    def main(cfe: Cfe) -> None:
        es = cfe.es
        for create in (es.pool_create, es.pool_create_no_sem, es.pool_create_ex, es.pool_create_ex_with_alignment):
            pool = create(1024)
            assert len(es.get_pool_buf(pool, 512).memory) == 512
            es.pool_delete(pool)
            assert status_of(lambda: create(0)) == CFE_ES_BAD_ARGUMENT  # noqa: B023
            assert status_of(lambda: es.pool_delete(pool)) == CFE_ES_ERR_RESOURCEID_NOT_VALID  # noqa: B023
        assert status_of(lambda: es.pool_create_ex(1024, range(1, 19))) == CFE_ES_BAD_ARGUMENT
        before = es.pool_create(1024)
        assert status_of(lambda: es.pool_create_ex_with_alignment(1024, alignment=6)) == CFE_ES_BAD_ARGUMENT
        assert status_of(lambda: es.pool_create_ex(1024, ())) == CFE_ES_BAD_ARGUMENT
        assert es.pool_create(1024) == before + 3  # a call that failed late has used up its id

    lab = in_app(main)
    assert "CFE_ES_PoolCreateEx_WithAlignment: Pool size(0) too small, need >=32 bytes" in lab.log()
    assert "CFE_ES_PoolCreateEx_WithAlignment: Num Block Sizes (18) greater than max (17)" in lab.log()


def test_pools_on_memory_of_the_application(in_app: Callable[[Callable[[Cfe], Any]], Lab]) -> None:
    def main(cfe: Cfe) -> None:
        es, booked = cfe.es, cfe.es.ports.memory
        for create in (es.pool_create, es.pool_create_no_sem, es.pool_create_ex, es.pool_create_ex_with_alignment):
            memory = bytearray(1024)
            before = booked.used
            pool = create(1024, memory=memory)
            assert not any(kind == "memory pool" and owner == "ONE" for owner, kind in booked.totals())
            block = es.get_pool_buf(pool, 8)
            block.memory[:] = b"in place"
            assert memory[block.offset : block.offset + 8] == b"in place"
            assert es.get_mem_pool_stats(pool)["PoolSize"] == 1024
            es.pool_delete(pool)
            assert booked.used == before
            assert status_of(lambda: create(2048, memory=memory)) == CFE_ES_BAD_ARGUMENT  # noqa: B023

    in_app(main)


def test_mutex_protects_pools_that_were_created_with_one(in_app: Callable[[Callable[[Cfe], Any]], Lab]) -> None:
    def main(cfe: Cfe) -> None:
        pool, bare = cfe.es.pool_create(1024), cfe.es.pool_create_no_sem(1024)
        cfe.os.mut_sem_get_id_by_name(f"Pool{pool:08X}")
        assert status_of(lambda: cfe.os.mut_sem_get_id_by_name(f"Pool{bare:08X}")) == OS_ERR_NAME_NOT_FOUND
        cfe.es.pool_delete(pool)
        assert status_of(lambda: cfe.os.mut_sem_get_id_by_name(f"Pool{pool:08X}")) == OS_ERR_NAME_NOT_FOUND

    in_app(main)


def test_number_of_pools_is_limited_by_the_configuration(in_app: Callable[[Callable[[Cfe], Any]], Lab]) -> None:
    def main(cfe: Cfe) -> None:
        free = cfe.es.pools.capacity - len(cfe.es.pools)
        pools = [cfe.es.pool_create_ex(64, use_mutex=False) for _ in range(free)]
        assert status_of(lambda: cfe.es.pool_create(64)) == CFE_ES_NO_RESOURCE_IDS_AVAILABLE
        for pool in pools:
            cfe.es.pool_delete(pool)

    in_app(main)


def test_blocks_and_their_errors(in_app: Callable[[Callable[[Cfe], Any]], Lab]) -> None:
    def main(cfe: Cfe) -> None:
        es = cfe.es
        pool, other = es.pool_create(1024), es.pool_create(1024)
        block = es.get_pool_buf(pool, 512)
        assert es.get_pool_buf_info(pool, block) == 512
        assert status_of(lambda: es.get_pool_buf(pool, 512)) == CFE_ES_ERR_MEM_BLOCK_SIZE
        assert status_of(lambda: es.get_pool_buf(0, 512)) == CFE_ES_ERR_RESOURCEID_NOT_VALID
        assert status_of(lambda: es.get_pool_buf_info(0, block)) == CFE_ES_ERR_RESOURCEID_NOT_VALID
        assert status_of(lambda: es.get_pool_buf_info(other, block)) == CFE_ES_BUFFER_NOT_IN_POOL
        assert status_of(lambda: es.put_pool_buf(0, block)) == CFE_ES_ERR_RESOURCEID_NOT_VALID
        assert status_of(lambda: es.put_pool_buf(other, block)) == CFE_ES_BUFFER_NOT_IN_POOL
        assert es.put_pool_buf(pool, block) == 512
        assert status_of(lambda: es.put_pool_buf(pool, block)) == CFE_ES_POOL_BLOCK_INVALID
        stats = es.get_mem_pool_stats(other)
        assert (stats["PoolSize"], stats["NumBlocksRequested"], stats["NumFreeBytes"]) == (1024, 0, 1024)
        assert status_of(lambda: es.get_mem_pool_stats(0)) == CFE_ES_ERR_RESOURCEID_NOT_VALID

    log = in_app(main).log()
    assert "CFE_ES_GetPoolBuf: Err:Bad handle(0x00000000) AppId=" in log
    assert "CFE_ES_PutPoolBuf: Err:Invalid Memory Handle (0x00000000)." in log
    assert "CFE_ES_PutPoolBuf: Err:Bad offset(32) outside pool boundary" in log
    assert "CFE_ES_PutPoolBuf: Err:Deallocating invalid or corrupt memory block @ 0x00000020" in log


def test_counters_are_made_found_and_deleted(in_app: Callable[[Callable[[Cfe], Any]], Lab]) -> None:
    def main(cfe: Cfe) -> None:
        es = cfe.es
        ids = [es.register_gen_counter(f"C{number}") for number in range(es.config.es_max_gen_counters)]
        assert status_of(lambda: es.register_gen_counter("more")) == CFE_ES_NO_RESOURCE_IDS_AVAILABLE
        assert sorted(es.counter_id_to_index(each) for each in ids) == list(range(len(ids)))
        assert es.get_gen_counter_id_by_name("C3") == ids[3]
        assert es.get_gen_counter_name(ids[3]) == "C3"
        assert status_of(lambda: es.get_gen_counter_id_by_name("na")) == CFE_ES_ERR_NAME_NOT_FOUND
        assert status_of(lambda: es.get_gen_counter_name(0)) == CFE_ES_ERR_RESOURCEID_NOT_VALID
        assert status_of(lambda: es.counter_id_to_index(0)) == CFE_ES_ERR_RESOURCEID_NOT_VALID
        es.delete_gen_counter(ids[0])
        assert status_of(lambda: es.register_gen_counter("C1")) == CFE_ES_ERR_DUPLICATE_NAME
        assert status_of(lambda: es.register_gen_counter("x" * 20)) == CFE_ES_BAD_ARGUMENT
        for call in (es.delete_gen_counter, es.increment_gen_counter, es.get_gen_count):
            assert status_of(lambda: call(ids[0])) == CFE_ES_BAD_ARGUMENT  # noqa: B023
        assert status_of(lambda: es.set_gen_count(ids[0], 1)) == CFE_ES_BAD_ARGUMENT

    log = in_app(main).log()
    assert "CFE_ES_RegisterGenCounter: No free Counter slots available" in log
    assert "CFE_ES_RegisterGenCounter: Duplicate Counter name 'C1'" in log


def test_counters_count(in_app: Callable[[Callable[[Cfe], Any]], Lab]) -> None:
    def main(cfe: Cfe) -> None:
        es = cfe.es
        counter = es.register_gen_counter("ut")
        assert es.get_gen_count(counter) == 0
        es.set_gen_count(counter, 5)
        es.increment_gen_counter(counter)
        assert es.get_gen_count(counter) == 6
        es.set_gen_count(counter, 0xFFFFFFFF)
        es.increment_gen_counter(counter)
        assert es.get_gen_count(counter) == 0

    in_app(main)

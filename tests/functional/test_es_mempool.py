"""Memory pools and their blocks (es_mempool_test.c)."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from cfepy.app import Cfe
from cfepy.ids import UNDEFINED
from cfepy.mission import Mission
from cfepy.status import (
    CFE_ES_BAD_ARGUMENT,
    CFE_ES_BUFFER_NOT_IN_POOL,
    CFE_ES_ERR_MEM_BLOCK_SIZE,
    CFE_ES_ERR_RESOURCEID_NOT_VALID,
    CFE_ES_NO_RESOURCE_IDS_AVAILABLE,
    CFE_ES_POOL_BLOCK_INVALID,
    CFE_SUCCESS,
)
from tests.functional.harness import status_of

POOL_SIZE, BLOCK_SIZE = 1024, 512


def test_mem_pool_create(cfe: Cfe) -> None:
    es = cfe.es
    ways: list[Callable[[int], int]] = [
        es.pool_create_no_sem,
        es.pool_create,
        lambda size: es.pool_create_ex(size, None, use_mutex=False),
    ]
    for create in ways:
        es.pool_delete(create(POOL_SIZE))
        assert status_of(create, 0) == CFE_ES_BAD_ARGUMENT


def test_mem_pool_create_maximum(cfe: Cfe, mission: Mission) -> None:
    es, pools = cfe.es, []
    while (status := status_of(lambda: pools.append(es.pool_create_ex(512, None, use_mutex=False)))) == CFE_SUCCESS:
        assert len(pools) <= mission.config.es_max_memory_pools
    assert status == CFE_ES_NO_RESOURCE_IDS_AVAILABLE
    assert pools, "the core does not need all of them"
    assert {status_of(es.pool_delete, pool) for pool in pools} == {CFE_SUCCESS}


def test_mem_pool_get_buf(cfe: Cfe) -> None:
    es = cfe.es
    pool = es.pool_create(POOL_SIZE)
    block = es.get_pool_buf(pool, BLOCK_SIZE)
    assert len(block.memory) == BLOCK_SIZE
    assert status_of(es.get_pool_buf, UNDEFINED, BLOCK_SIZE) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert status_of(es.get_pool_buf, pool, BLOCK_SIZE) == CFE_ES_ERR_MEM_BLOCK_SIZE, "no room for a second one"
    assert es.put_pool_buf(pool, block) == BLOCK_SIZE
    assert status_of(es.get_pool_buf, pool, 2 * POOL_SIZE) == CFE_ES_ERR_MEM_BLOCK_SIZE
    es.pool_delete(pool)


def test_mem_pool_buf_info(cfe: Cfe) -> None:
    es = cfe.es
    pool, other = es.pool_create(POOL_SIZE), es.pool_create(POOL_SIZE)
    block, foreign = es.get_pool_buf(pool, BLOCK_SIZE), es.get_pool_buf(other, BLOCK_SIZE)
    assert es.get_pool_buf_info(pool, block) == BLOCK_SIZE
    assert status_of(es.get_pool_buf_info, UNDEFINED, block) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert status_of(es.get_pool_buf_info, pool, foreign) == CFE_ES_BUFFER_NOT_IN_POOL
    es.pool_delete(pool)
    assert status_of(es.get_pool_buf_info, pool, block) == CFE_ES_ERR_RESOURCEID_NOT_VALID


def test_mem_pool_put_buf(cfe: Cfe) -> None:
    es = cfe.es
    pool = es.pool_create(POOL_SIZE)
    block = es.get_pool_buf(pool, BLOCK_SIZE)
    assert es.put_pool_buf(pool, block) == BLOCK_SIZE
    assert status_of(es.put_pool_buf, pool, block) == CFE_ES_POOL_BLOCK_INVALID
    assert status_of(es.put_pool_buf, UNDEFINED, block) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert es.get_pool_buf(pool, BLOCK_SIZE).offset == block.offset, "a block given back is taken again"
    es.pool_delete(pool)


@pytest.mark.parametrize("use_mutex", [False, True])
def test_mem_pool_delete(cfe: Cfe, use_mutex: bool) -> None:
    es = cfe.es
    pool = es.pool_create_ex(POOL_SIZE, None, use_mutex)
    found = es.get_mem_pool_stats(pool)
    assert (found["PoolSize"], found["NumFreeBytes"]) == (POOL_SIZE, POOL_SIZE)
    assert (found["NumBlocksRequested"], found["CheckErrCtr"]) == (0, 0)
    assert status_of(es.get_mem_pool_stats, UNDEFINED) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    es.pool_delete(pool)
    assert status_of(es.get_mem_pool_stats, pool) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert status_of(es.pool_delete, pool) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert status_of(es.pool_delete, UNDEFINED) == CFE_ES_ERR_RESOURCEID_NOT_VALID

"""Requirements of Executive Services about memory pools."""

from __future__ import annotations

from collections.abc import Callable

from cfepy.es import packets as pk
from cfepy.ports import ERROR
from cfepy.status import (
    CFE_ES_BAD_ARGUMENT,
    CFE_ES_ERR_MEM_BLOCK_SIZE,
    CFE_ES_ERR_RESOURCEID_NOT_VALID,
    CFE_ES_POOL_BLOCK_INVALID,
    OS_ERR_NAME_NOT_FOUND,
)
from tests.requirements.covers import covers
from tests.requirements.flight import Flight
from tests.statuses import status_of

Fly = Callable[..., Flight]


def logged(flight: Flight, text: str) -> bool:
    """Return whether the system log has a line with a text."""
    return any(text in line for line in flight.mission.console.lines)


@covers("cES1033", "cES1330")
def test_cES1033_statistics_in_telemetry(fly: Fly) -> None:
    flight = fly(pk.MEMSTATS_TLM_MID)
    es = flight.cfe.es
    pool = flight.call(lambda: es.pool_create(1024))
    block = es.get_pool_buf(pool, 100)
    es.put_pool_buf(pool, block)
    assert status_of(lambda: es.put_pool_buf(pool, block)) == CFE_ES_POOL_BLOCK_INVALID
    es.get_pool_buf(pool, 20)
    flight.send(pk.SEND_MEM_POOL_STATS, Application="PROBE", PoolHandle=pool)
    (values,) = flight.all(pk.MEMSTATS_TLM)
    stats = values["PoolStats"]
    assert (values["PoolHandle"], stats) == (pool, es.get_mem_pool_stats(pool))
    assert (stats["PoolSize"], stats["NumBlocksRequested"], stats["CheckErrCtr"]) == (1024, 2, 1)
    assert 1024 - 128 - 32 - 100 < stats["NumFreeBytes"] < 1024 - 128 - 32
    assert stats["BlockStats"][2] == {"BlockSize": 32, "NumCreated": 1, "NumFree": 0}
    assert stats["BlockStats"][6] == {"BlockSize": 128, "NumCreated": 1, "NumFree": 1}
    (event,) = flight.send(pk.SEND_MEM_POOL_STATS, PoolHandle=0)
    text = "Cannot telemeter memory pool stats. Illegal Handle (0x00000000)"
    assert (event.event_id, event.event_type, event.text) == (82, ERROR, text)


@covers("cES1320", "cES1320.1")
def test_cES1320_prepare(fly: Fly) -> None:
    es = (flight := fly()).cfe.es
    for create in (es.pool_create, es.pool_create_no_sem, es.pool_create_ex, es.pool_create_ex_with_alignment):
        pool = flight.call(lambda: create(4096))  # noqa: B023
        assert es.get_mem_pool_stats(pool)["NumFreeBytes"] == 4096
        assert status_of(lambda: flight.call(lambda: create(31))) == CFE_ES_BAD_ARGUMENT  # noqa: B023
    assert logged(flight, "Pool size(31) too small, need >=32 bytes")


@covers("cES1321", "cES1321.2", "cES1321.3", "cES1331")
def test_cES1321_allocate_under_a_mutex(fly: Fly) -> None:
    flight = fly()
    es, os = flight.cfe.es, flight.cfe.os
    pool = flight.call(lambda: es.pool_create(1024))
    mutex = os.mut_sem_get_id_by_name(f"Pool{pool:08X}")
    waited: list[int] = []
    sizes: list[int] = []

    def hold() -> None:
        os.mut_sem_take(mutex)
        os.task_delay(100)
        os.mut_sem_give(mutex)

    def allocate() -> None:
        begin = flight.mission.kernel.now
        block = es.get_pool_buf(pool, 500)
        waited.append(flight.mission.kernel.now - begin)
        sizes.extend((len(block.memory), es.get_pool_buf_info(pool, block)))

    for name, function in (("holder", hold), ("user", allocate)):
        flight.mission.kernel.spawn(name, function, 100)
    flight.run_for(1)
    assert waited == [100_000_000]
    assert sizes == [500, 500]
    assert status_of(lambda: es.get_pool_buf(0, 8)) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert logged(flight, "CFE_ES_GetPoolBuf: Err:Bad handle(0x00000000) AppId=")
    assert status_of(lambda: es.get_pool_buf(pool, 80_001)) == CFE_ES_ERR_MEM_BLOCK_SIZE
    assert logged(flight, "CFE_ES_GenPoolGetBlock: Err:size(80001) > max(80000)")


@covers("cES1322", "cES1322.1")
def test_cES1322_a_block_is_returned(fly: Fly) -> None:
    es = (flight := fly()).cfe.es
    pool = flight.call(lambda: es.pool_create(600))
    block = es.get_pool_buf(pool, 512)
    assert status_of(lambda: es.get_pool_buf(pool, 512)) == CFE_ES_ERR_MEM_BLOCK_SIZE
    assert es.put_pool_buf(pool, block) == 512
    assert status_of(lambda: es.put_pool_buf(pool, block)) == CFE_ES_POOL_BLOCK_INVALID
    assert status_of(lambda: es.put_pool_buf(0, block)) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert logged(flight, "CFE_ES_PutPoolBuf: Err:Invalid Memory Handle (0x00000000).")
    assert es.get_pool_buf(pool, 512).offset == block.offset


def test_cES1329_allocate_without_mutex(fly: Fly) -> None:
    flight = fly()
    es, os = flight.cfe.es, flight.cfe.os
    pool = flight.call(lambda: es.pool_create_no_sem(1024))
    assert status_of(lambda: os.mut_sem_get_id_by_name(f"Pool{pool:08X}")) == OS_ERR_NAME_NOT_FOUND
    assert len(es.get_pool_buf(pool, 100).memory) == 100


def test_cES1345_delete(fly: Fly) -> None:
    es = (flight := fly()).cfe.es
    booked = flight.mission.memory.used
    pool = flight.call(lambda: es.pool_create(1024))
    assert flight.mission.memory.used >= booked + 1024
    es.pool_delete(pool)
    assert flight.mission.memory.used == booked
    assert status_of(lambda: es.get_mem_pool_stats(pool)) == CFE_ES_ERR_RESOURCEID_NOT_VALID

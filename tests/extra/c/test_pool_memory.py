"""Memory pools of compiled applications: the owner of the bytes, and the pool after the owner's end."""

from __future__ import annotations

from pathlib import Path

from cfepy.mission import Mission
from cfepy.writing.console import Console
from tests.extra.c.building import compile_c, console_of, digest_of, needs_compiler, said, write_mission

pytestmark = needs_compiler

DECLARED = """
    int32_t CFE_ES_PoolCreate(uint32_t *, void *, size_t);
    int32_t CFE_ES_GetPoolBuf(void *, uint32_t, size_t);
    int32_t OS_TaskCreate(uint32_t *, const char *, void (*)(void), void *, size_t, uint8_t, uint32_t);
"""

OWNER = (
    DECLARED
    + """
    static union { long double alignment; unsigned char bytes[1024]; } memory;
    static uint32_t pool;
    static void nobody(void) { CFE_ES_PoolCreate(&pool, memory.bytes, sizeof memory); }
    void OWNER_Main(void)
    {
        uint32_t task;
        void *block = NULL;
        OS_TaskCreate(&task, "NOBODY", nobody, NULL, 16384, 60, 0);
        OS_TaskDelay(100);
        int32_t size = CFE_ES_GetPoolBuf(&block, pool, 8);
        SAY("taken %d, in it %d", size,
            (unsigned char *)block > memory.bytes && (unsigned char *)block < memory.bytes + 1024);
        SAY("pool %x", pool);
        CFE_ES_ExitApp(EXIT);
    }
"""
)

USER = (
    DECLARED
    + """
    void USER_Main(void)
    {
        void *block;
        OS_TaskDelay(8000);
        SAY("taken %d", CFE_ES_GetPoolBuf(&block, POOL, 8));
    }
"""
)


def test_pool_of_an_ended_application_is_a_fault_of_its_user(tmp_path: Path) -> None:
    compile_c(tmp_path, "OWNER", OWNER)
    compile_c(tmp_path, "USER", USER, "-DPOOL=0x140003")
    folder = write_mission(tmp_path, "OWNER", "USER")
    with Mission(folder, console=Console(quiet=True)) as mission:
        mission.run_for(9)
        console = console_of(mission)
        assert said(console) == ["taken 8, in it 1", "pool 140003"]
        assert "Exit Application OWNER Completed" in console
        assert "bad address" in str(mission.cfe.es.history["USER"].last_error)
    assert digest_of(folder, "thread", 9) == digest_of(folder, "greenlet", 9)

"""Stack use of compiled tasks."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.extra.c.building import compile_c, fly, needs_compiler, write_mission

pytestmark = needs_compiler

SOURCE = """
static int deep(volatile char *above)
{
    volatile char block[%d];
    for (unsigned i = 0; i < sizeof block; i++) block[i] = (char)(i | 1);
    return block[0] + above[0];
}
void TEST_Main(void)
{
    uint32_t run = RUN;
    volatile char mine = (char)deep(&mine);
    while (CFE_ES_RunLoop(&run)) OS_TaskDelay(100);
    CFE_ES_ExitApp(EXIT);
}
"""


@pytest.mark.slow
def test_stack_depth_is_the_deepest_written_byte(tmp_path: Path) -> None:
    used = {}
    for size in (512, 5120):
        folder = tmp_path / str(size)
        folder.mkdir()
        compile_c(folder, "TEST", SOURCE % size)
        mission = fly(write_mission(folder, "TEST"), 1)
        used[size] = mission.record.stack_use["TEST", "TEST"].used
    assert 512 < used[512] < 1536
    assert used[5120] - used[512] == pytest.approx(5120 - 512, abs=64)

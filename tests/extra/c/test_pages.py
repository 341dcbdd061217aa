"""Kernels with larger pages than here, such as some for aarch64: maps and guards cover whole pages."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.extra.c.building import compile_c, needs_compiler, write_mission

pytestmark = needs_compiler

SOURCE = """
    static char zeros[5000];
    void TEST_Main(void)
    {
        uint32_t run = RUN;
        volatile char *block = malloc(100), *message = CFE_SB_AllocateMessageBuffer(40);
        int16_t table;
        void *image;
        CFE_TBL_Register(&table, "T", 40, 0, NULL);
        CFE_TBL_Load(table, 1, zeros);
        CFE_TBL_GetAddress(&image, table);
        CFE_ES_RunLoop(&run);
        message[39] = block[99] = ((volatile char *)image)[39] = zeros[4999]++;
        SAY("%d", zeros[4999]);
        free((char *)block);
        OS_TaskDelay(100);
        MISTAKE
    }
"""
FLIGHT = """
import mmap, sys
mmap.PAGESIZE = int(sys.argv[2])
from cfepy.extra.c.engine import engine
made, odd = engine(), []
def checked(function):
    def call(address, *others):
        odd.extend([address] if address % mmap.PAGESIZE else [])
        return function(address, *others)
    return call
for name in ("map", "unmap", "protect", "clear"):
    setattr(made, name, checked(getattr(made, name)))
from tests.extra.c.building import console_of, fly, said
mission = fly(sys.argv[1], 1)
print(said(console_of(mission)), odd, mission.cfe.es.history["TEST"].last_error)
"""


MISTAKES = {
    "block[0] = 1;": "offset 0 of a block of 100 bytes that was freed",
    "((volatile char *)image)[40] = 1;": "offset 40 of table TEST.T of 40 bytes",
}


@pytest.mark.slow
@pytest.mark.parametrize("mistake", MISTAKES)
@pytest.mark.parametrize("page", [4096, 16384, 65536])
def test_an_application_flies_guarded(tmp_path: Path, page: int, mistake: str) -> None:
    compile_c(tmp_path, "TEST", SOURCE.replace("MISTAKE", mistake), "-w", f"-Wl,-z,max-page-size={page}")
    folder = write_mission(tmp_path, "TEST")
    (tmp_path / "mission.yaml").write_text("compiled: {guard: true}\n", encoding="utf-8")
    command = [sys.executable, "-c", FLIGHT, folder, str(page)]
    done = subprocess.run(command, cwd=Path(__file__).parents[3], capture_output=True, text=True)
    assert done.stdout.startswith("['1'] [] SIGSEGV"), done.stdout + done.stderr
    assert "TEST_Main (TEST.c:16), address 0x" in done.stdout
    assert MISTAKES[mistake] in done.stdout

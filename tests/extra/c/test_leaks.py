"""Restarts and missions in one process leak nothing: no memory map, no file, no block."""

from __future__ import annotations

import gc
import os
from pathlib import Path

import pytest

from cfepy.extra.c.engine import engine
from cfepy.mission import Mission
from cfepy.writing.console import Console
from tests.extra.c.building import compile_c, needs_compiler, write_mission

pytestmark = needs_compiler

SOURCE = """
    static unsigned char message[64];
    void TEST_Main(void)
    {
        uint32_t pipe, run = RUN;
        void *got;
        CFE_EVS_Register(NULL, 0, 0);
        CFE_SB_CreatePipe(&pipe, 5, "TEST");
        CFE_SB_Subscribe(0x1899, pipe);
        CFE_MSG_Init(message, 0x1899, sizeof message);
        malloc(5000);
        for (int i = 0; i < 3; i++) {
            CFE_SB_TransmitMsg(message, true);
            CFE_SB_ReceiveBuffer(&got, pipe, 0);
        }
        CFE_SB_AllocateMessageBuffer(100);
        while (CFE_ES_RunLoop(&run))
            OS_TaskDelay(200);
        CFE_ES_ExitApp(run);
    }
"""


def held() -> set[tuple[str, str]]:
    """Return the memory maps of C code and the open files of this process. Python's own memory varies."""
    low, high = engine().ARENA_LOW, engine().ARENA_HIGH
    starts = (line.partition("-")[0] for line in Path("/proc/self/maps").read_text(encoding="utf-8").splitlines())
    maps = {("map", start) for start in starts if low <= int(start, 16) < high}
    return maps | {("file", name) for name in os.listdir("/proc/self/fd")}


class Held:
    """Resources of the process, except for earlier ones, which earlier tests may release at any time."""

    def __init__(self) -> None:
        gc.collect()
        self._before = held()

    def now(self) -> tuple[int, int]:
        """Count the memory maps and the files that have come since."""
        gc.collect()
        now = held()
        self._before &= now
        kinds = [kind for kind, _ in now - self._before]
        return kinds.count("map"), kinds.count("file")


def restart(mission: Mission, times: int) -> None:
    es = mission.cfe.es
    for _ in range(times):
        es.restart_app(es.get_app_id_by_name("TEST"))
        mission.run_for(8)


@pytest.mark.parametrize("restarts", [30, pytest.param(1000, marks=pytest.mark.slow)])
def test_restarts_leak_no_memory_maps_files_or_blocks(tmp_path: Path, restarts: int) -> None:
    compile_c(tmp_path, "TEST", SOURCE)
    ours = Held()
    with Mission(write_mission(tmp_path, "TEST"), console=Console(quiet=True), tasks="greenlet") as mission:
        mission.run_for(2)
        restart(mission, 5)
        before = ours.now()
        restart(mission, restarts)
        assert mission.cfe.es.history["TEST"].restarts == restarts + 5
        assert ours.now() == before


@pytest.mark.parametrize("missions", [3, pytest.param(100, marks=pytest.mark.slow)])
def test_missions_leak_no_memory_maps_files_or_blocks(tmp_path: Path, missions: int) -> None:
    compile_c(tmp_path, "TEST", SOURCE)
    folder = write_mission(tmp_path, "TEST")
    ours = Held()
    seen = []
    for number in range(missions + 3):
        with Mission(folder, console=Console(quiet=True), tasks="greenlet") as mission:
            mission.run_for(2)
        del mission
        if number >= 2:
            seen.append(ours.now())
    assert len(set(seen)) == 1
    assert seen[0][0] <= 2  # the two pools of the core, which objects of Python may still look at


def test_two_missions_at_once_have_separate_memory(tmp_path: Path) -> None:
    compile_c(
        tmp_path,
        "TEST",
        """
        static int turns;
        void TEST_Main(void)
        {
            for (;;) {
                SAY("turn %d", turns++);
                OS_TaskDelay(100);
            }
        }
        """,
    )
    folder = write_mission(tmp_path, "TEST")
    with Mission(folder, console=Console(quiet=True)) as one, Mission(folder, console=Console(quiet=True)) as other:
        for _ in range(5):
            one.run_for(0.3)
            other.run_for(0.3)
        assert one.console.lines == other.console.lines

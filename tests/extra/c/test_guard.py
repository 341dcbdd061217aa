"""The guard mode: writes past a buffer, uses after free, and reads before the first write."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.mission import read_mission
from tests.extra.c.building import compile_c, console_of, fly, needs_compiler, said, write_mission

pytestmark = needs_compiler

MISTAKES = {
    "overrun of a block": ('char *p = malloc(100); memset(p, 0, 113); SAY("%d", p[0]);', "SIGSEGV"),
    "overrun by a byte": (
        "char *p = malloc(99); p[99] = 1; free(p);",
        "a block of 99 bytes that was written past its end",
    ),
    "use after free": ("volatile char *p = malloc(64); free((char *)p); p[0] = 1;", "SIGSEGV"),
    "double free": ("char *p = malloc(64); free(p); free(p);", "which malloc did not give, or which was freed"),
    "overrun of a message": ("char *p = CFE_SB_AllocateMessageBuffer(64); p[64] = 1;", "SIGSEGV"),
    "message after release": (
        "volatile char *p = CFE_SB_AllocateMessageBuffer(64); CFE_SB_ReleaseMessageBuffer((char *)p); p[8] = 1;",
        "SIGSEGV",
    ),
}
SOURCE = """
void TEST_Main(void)
{
    uint32_t run = RUN;
    CFE_ES_RunLoop(&run);
    @
    OS_TaskDelay(100);
    SAY("not noticed");
}
"""


def fly_guarded(folder: str, is_on: bool) -> object:
    Path(folder, "mission.yaml").write_text(f"compiled: {{guard: {str(is_on).lower()}}}\n", encoding="utf-8")
    return fly(folder, 1)


@pytest.mark.parametrize("name", MISTAKES)
def test_mistake_is_a_fault_at_its_own_line(tmp_path: Path, name: str) -> None:
    code, what = MISTAKES[name]
    compile_c(tmp_path, "TEST", SOURCE.replace("@", code), "-O0", "-w")
    folder = write_mission(tmp_path, "TEST")
    mission = fly_guarded(folder, True)
    assert what in str(mission.cfe.es.history["TEST"].last_error)  # type: ignore[attr-defined]
    assert said(console_of(mission)) == []  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "name", ["overrun by a byte", "use after free", "overrun of a message", "message after release"]
)
def test_mistake_is_not_noticed_without_the_guard(tmp_path: Path, name: str) -> None:
    compile_c(tmp_path, "TEST", SOURCE.replace("@", MISTAKES[name][0]), "-O0", "-w")
    mission = fly_guarded(write_mission(tmp_path, "TEST"), False)
    assert said(console_of(mission)) == ["not noticed"]  # type: ignore[arg-type]


def test_unwritten_memory_is_not_zero_under_the_guard(tmp_path: Path) -> None:
    code = 'unsigned char local[32]; volatile unsigned char *p = malloc(4); SAY("%x %x", p[3], local[5]);'
    compile_c(tmp_path, "TEST", SOURCE.replace("@", code), "-O0", "-w")
    folder = write_mission(tmp_path, "TEST")
    assert said(console_of(fly_guarded(folder, True)))[0] == "a5 a5"  # type: ignore[arg-type]
    assert said(console_of(fly_guarded(folder, False)))[0] == "0 0"  # type: ignore[arg-type]


def test_guard_is_set_by_the_mission_file_and_the_option(tmp_path: Path) -> None:
    from cfepy.pilot import RunPlan

    folder = write_mission(tmp_path, "TEST")
    assert not read_mission(folder).compiled.guard
    assert RunPlan((folder,), guard=True).spec().compiled.guard
    assert "--guard" in RunPlan((folder,), guard=True).command_line()

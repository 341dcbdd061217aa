"""`cfepy replay --gdb APP`: gdb on the process, with symbols of compiled code."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.extra.c.building import compile_c, needs_compiler, write_mission

pytestmark = [needs_compiler, pytest.mark.skipif(shutil.which("gdb") is None, reason="there is no gdb")]

SOURCE = """
    static int twice(int number)
    {
        int result = 2 * number;
        return result;
    }
    void TEST_Main(void)
    {
        uint32_t run = RUN;
        for (int i = 20; CFE_ES_RunLoop(&run) && i < 23; i++) {
            SAY("%d", twice(i));
            OS_TaskDelay(100);
        }
        CFE_ES_ExitApp(EXIT);
    }
"""


def cfepy(folder: Path, *words: str, typed: str = "") -> str:
    done = subprocess.run(
        [sys.executable, "-m", "cfepy", *words], cwd=folder, input=typed, capture_output=True, text=True, timeout=240
    )
    return done.stdout + done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("tasks", [pytest.param("thread", marks=pytest.mark.slow), "greenlet"])
def test_gdb_stops_at_the_main_function_and_sees_lines_and_variables(tmp_path: Path, tasks: str) -> None:
    compile_c(tmp_path, "TEST", SOURCE, "-O0")
    folder = write_mission(tmp_path, "TEST")
    cfepy(tmp_path, "run", folder, "--for", "2", "--record", "run.cfepy", "--tasks", tasks)
    typed = "break twice\ncontinue\nnext\nprint number\nbacktrace\ndelete\ncontinue\nquit\n"
    shown = cfepy(tmp_path, "replay", "run.cfepy", "--gdb", "TEST", typed=typed)
    if "ptrace: Operation not permitted" in shown:
        pytest.skip("this computer lets nobody trace a process")
    assert "hit Temporary breakpoint 1, TEST_Main () at " in shown
    assert "twice (number=20) at" in shown
    assert "$1 = 20" in shown
    assert "in TEST_Main () at" in shown
    assert "the same run as run.cfepy" in shown


@pytest.mark.slow
def test_gdb_accepts_breakpoints_at_a_time(tmp_path: Path) -> None:
    compile_c(tmp_path, "TEST", SOURCE, "-O0")
    cfepy(tmp_path, "run", write_mission(tmp_path, "TEST"), "--for", "2", "--record", "run.cfepy")
    typed = "break twice\ncontinue\ndelete\ncontinue\nquit\n"
    shown = cfepy(tmp_path, "replay", "run.cfepy", "--gdb", "TEST", "--until", "0.6", typed=typed)
    if "ptrace: Operation not permitted" in shown:
        pytest.skip("this computer lets nobody trace a process")
    assert "The run waits: set breakpoints, then continue" in shown
    assert "twice (number=21) at" in shown
    assert "the same run as run.cfepy" in shown


@pytest.mark.slow
def test_second_debugger_and_unknown_application_are_refused(tmp_path: Path) -> None:
    compile_c(tmp_path, "TEST", SOURCE)
    folder = write_mission(tmp_path, "TEST")
    cfepy(tmp_path, "run", folder, "--for", "1", "--record", "run.cfepy")
    assert "cannot be combined with --pdb" in cfepy(tmp_path, "replay", "run.cfepy", "--gdb", "TEST", "--pdb", "TEST")
    assert "unknown application 'TETS'" in cfepy(tmp_path, "replay", "run.cfepy", "--gdb", "TETS")

"""Compiled applications on an emulated aarch64: the tests of this folder there, and the same runs as here."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from dev.c.emulated.computer import VARIABLE, Computer, lacking
from tests.extra.c.building import compile_c, digest_of, needs_compiler, write_mission

REPOSITORY = Path(__file__).parents[3]
NOT_THERE = {"test_aarch64.py", "test_gdb.py"}
"""This one, and what traces a process, which qemu's user emulation does not have."""
MODULES = sorted(each.name for each in Path(__file__).parent.glob("test_*.py") if each.name not in NOT_THERE)

pytestmark = [pytest.mark.slow, needs_compiler, pytest.mark.skipif(lacking() is not None, reason=str(lacking()))]


@pytest.fixture(scope="module")
def computer(tmp_path_factory: pytest.TempPathFactory) -> Computer:
    return Computer(Path(os.environ[VARIABLE]), tmp_path_factory.mktemp("aarch64"))


@pytest.mark.parametrize("module", MODULES)
def test_tests_of_this_folder_pass_on_aarch64(computer: Computer, tmp_path: Path, module: str) -> None:
    options = ("-p", "no:cacheprovider", "--basetemp", str(tmp_path / "there"))
    done = computer.run("-m", "pytest", *options, f"tests/extra/c/{module}", cwd=REPOSITORY)
    assert done.returncode == 0, done.stdout


SOURCE = """
    static uint8_t message[32];
    static void child(void)
    {
        for (int i = 0; i < 20; i++) {
            message[20] += i;
            OS_TaskDelay(7);
        }
    }
    void TEST_Main(void)
    {
        uint32_t id, run = RUN;
        double x = 1;
        CFE_EVS_Register(NULL, 0, 0);
        CFE_MSG_Init(message, 0x0891, sizeof message);
        CFE_ES_CreateChildTask(&id, "CHILD", child, NULL, 16384, 60, 0);
        while (CFE_ES_RunLoop(&run)) {
            x = x * 1.25 + 0.5;
            memcpy(message + 24, &x, sizeof x);
            CFE_SB_TransmitMsg(message, true);
            CFE_EVS_SendEvent(1, 2, "%d is %.3f", message[20], x);
            OS_TaskDelay(50);
        }
        CFE_ES_ExitApp(run);
    }
"""
FLIGHT = """
import sys
from pathlib import Path
from tests.extra.c.building import compile_c, digest_of
folder, tasks, source = sys.argv[1:]
compile_c(Path(folder), "TEST", source)
print(digest_of(folder, tasks))
"""


@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_run_on_aarch64_has_the_digest_of_a_run_here(computer: Computer, tmp_path: Path, tasks: str) -> None:
    here, there = tmp_path / "here" / "mission", tmp_path / "there" / "mission"  # the name is in an event
    for folder in (here, there):
        folder.mkdir(parents=True)
        write_mission(folder, "TEST")
    compile_c(here, "TEST", SOURCE)
    flown = computer.run("-c", FLIGHT, str(there), tasks, SOURCE, cwd=REPOSITORY)
    assert flown.stdout.strip() == digest_of(str(here), tasks)
